"""`cytodisk population`, from masks and a table of groups to words and tables."""

import os
import shutil
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import pandas as pd
import pytest
from command_line import Run, assert_refused

import cytodisk as cd
from cytodisk.cli.population.power_words import plan_lines, power_lines
from cytodisk.runs.population.power.population_power import plan_of


@pytest.fixture(scope="module")
def cells(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("cells")
    made = cd.simulate.population_images(folder / "images", experiments=4, cells=2, seed=2)
    cd.run_map(made.masks, folder / "maps", signal=made.images, layers=3, sectors=8, maps=False)
    table = pd.read_csv(made.groups)
    table.to_csv(folder / "groups.csv", index=False)
    table.drop(columns="experiment").to_csv(folder / "unknown.csv", index=False)
    return folder


def test_what_can_be_reached_is_the_first_line(run: Run, cells: Path, tmp_path: Path) -> None:
    out = tmp_path / "atlas"
    command = ("population", cells / "maps", "--groups", cells / "groups.csv", "--channel", "Rac1", "-o", out)
    code, said, _ = run(*command)
    lines = said.splitlines()
    assert code == 0
    assert lines[0].startswith("4 + 4 experiments can give p = 0.029 at best")
    assert "the design is unpaired" in lines[1]
    assert lines[2].startswith("'control' is taken as the control, by its name: pass --compare control,drug")
    assert "Rac1, drug against control: " in said
    assert "16 cells: control 8 in 4 experiments; drug 8 in 4 experiments" in lines
    assert f"results: {out}" in lines
    assert any(line.startswith(f"figures: {out / 'figures'} (atlas_Rac1, profiles, ") for line in lines)
    drawn = {file: file.stat().st_mtime_ns for file in (out / "figures").iterdir()}
    code, said, error = run(*command, "--resume")
    assert (code, said.splitlines()[0]) == (0, lines[0])
    assert "this study is complete already" in error
    assert {file: file.stat().st_mtime_ns for file in (out / "figures").iterdir()} == drawn


@pytest.mark.slow
def test_figures_that_were_not_all_drawn_are_drawn_again(
    run: Run, cells: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from cytodisk.pages.population import write_population_figures as pages

    out = tmp_path / "atlas"
    command = ("population", cells / "maps", "--groups", cells / "groups.csv", "--channel", "Rac1", "-o", out)

    def stopped(*_: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(pages, "profiles_page", stopped)
        code, said, error = run(*command)
    assert code != 0
    assert f"Stopped while drawing; the tables are in {out}." in error
    assert f"results: {out}" in said
    assert (out / "figures" / "atlas_Rac1.png").exists()
    assert run(*command, "--resume")[0] == 0
    assert (out / "figures" / "profiles.png").exists()


def test_cells_of_unknown_experiments_are_told(run: Run, cells: Path, tmp_path: Path) -> None:
    command = ("population", cells / "maps", "--no-figures", "--groups", cells / "unknown.csv", "-o")
    code, said, _ = run(*command, tmp_path / "a")
    lines = said.splitlines()
    assert code == 0
    assert lines[0].startswith("Nothing can be tested: of the cells (8 of control, 8 of drug) no experiment")
    assert any(line.startswith("Warning experiments unknown: ") for line in lines)
    code, said, _ = run(*command, tmp_path / "b", "--unit", "cell", "--permutations", "99")
    assert "Warning cells as units" in said
    assert not (tmp_path / "b" / "figures").exists()


def test_parameters_of_one_run_are_those_of_the_next(run: Run, cells: Path, tmp_path: Path) -> None:
    command = ("population", cells / "maps", "--groups", cells / "groups.csv", "-q", "--no-figures", "-o")
    assert run(*command, tmp_path / "a", "--channel", "Rac1", "--normalise", "cell mean")[0] == 0
    assert run(*command, tmp_path / "b", "--parameters", tmp_path / "a" / "parameters.toml")[0] == 0
    found = cd.open_population_study(tmp_path / "b")
    assert found.channels == ("Rac1",)
    assert found.atlas.attrs["units"]["mean"] == "× cell mean"


def test_faults_are_one_line_with_the_remedy(run: Run, cells: Path, tmp_path: Path) -> None:
    maps, groups, out = cells / "maps", ("--groups", cells / "groups.csv"), ("-o", tmp_path / "out")
    assert_refused(run("population"), "PATH is missing: pass")
    assert_refused(run("population", maps, "--seed", "1", "--seed=2", *out), "--seed is given 2 times: keep")
    assert_refused(run("population", maps), "--out is missing", "-o atlas/")
    assert_refused(run("population", tmp_path / "none", *out), "does not exist")
    assert_refused(run("population", maps, "--h5ad", "all.h5ad", *out), "takes no name", "leave all.h5ad out")
    assert_refused(run("population", maps, *out, "--effects", "1"), "--effects: only with --power")
    assert_refused(
        run("population", maps, *groups, *out, "--compare", "drug"), "--compare must name two conditions"
    )
    assert_refused(run("population", maps, *groups, *out, "--align", "nucleus"), "--nuclei")
    assert_refused(run("population", maps, *groups, *out, "--format", "bmp"), "format must be png, pdf, svg")
    assert_refused(run("population", "--power", "--channel", "a"), "--channel: not with --power", "pass PATH")
    assert not (tmp_path / "out").exists() or not list((tmp_path / "out").iterdir())


def test_power_is_a_table_to_plan_with(run: Run) -> None:
    few = ("--experiments", "3,4", "--studies", "20")
    code, said, _ = run("population", "--power", "--effects", "1,4", *few)
    lines = [line.strip() for line in said.splitlines()]
    assert code == 0
    assert lines[0].startswith("assumed, not measured: 10% of the variance of cells between experiments")
    assert "3 + 3        nothing: p = 0.1 at best" in lines
    assert sum(line.startswith("4 pairs      nothing: p = 0.12 at best") for line in lines) == 2
    row = next(line for line in lines if line.startswith("4 + 4"))
    assert row.split()[3].endswith("%")


def test_a_plan_can_be_kept(run: Run, tmp_path: Path) -> None:
    command = ("population", "--power", "--effects", "1", "--experiments", "4", "--studies", "20", "-q", "-o")
    assert run(*command, tmp_path / "plan")[0] == 0
    table = pd.read_csv(tmp_path / "plan" / "power.csv")
    assert table["design"].tolist() == ["unpaired", "paired"]
    assert (tmp_path / "plan" / "power.png").exists()
    assert_refused(run(*command, tmp_path / "plan"), "power.csv is there", "--overwrite")
    assert run(*command, tmp_path / "plan", "--overwrite")[0] == 0


def test_power_takes_the_variance_of_cells_at_hand(run: Run, cells: Path) -> None:
    command = ("population", cells / "maps", "--groups", cells / "groups.csv", "--power")
    few = ("--effects", "2", "--experiments", "4", "--studies", "20")
    code, said, _ = run(*command, "--channel", "Rac1", *few)
    assert code == 0
    assert said.startswith("measured in your 8 experiments, 2 conditions: ")
    assert "2 cells of each condition in each experiment" in said
    assert "each experiment holds one condition" in said


def test_a_plan_says_what_was_assumed_and_what_given() -> None:
    given = cd.PowerParameters(cells=5, between_experiments=0.2, between_dishes=0.0)
    assert plan_lines(plan_of(given), given)[0].startswith("as given: 20% of the variance")
    some = cd.PowerParameters(cells=5)
    assert plan_lines(plan_of(some), some)[0].startswith("assumed, not measured")
    table = cd.population_power(effects=(2.0,), experiments=(2,), studies=20)
    assert any("2 pairs" in line for line in power_lines(table))


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "killpg"), reason="process groups are POSIX")
def test_a_killed_command_is_done_by_the_next(run: Run, cells: Path, tmp_path: Path) -> None:
    out = tmp_path / "atlas"
    files = [str(cells / "maps"), "--groups", str(cells / "groups.csv"), "-o", str(out), "-q", "--no-figures"]
    command = [sys.executable, "-m", "cytodisk", "population", *files]
    assert run("population", *files)[0] == 0
    whole = {file.name: file.read_bytes() for file in out.glob("*.parquet")}
    for file in ("provenance.json", "windows.parquet"):  # the first that is written, and one of the tables
        shutil.rmtree(out)
        process = subprocess.Popen(command, start_new_session=True)
        while not (out / file).exists() and process.poll() is None:
            time.sleep(0.001)
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        assert run("population", *files, "--resume")[0] == 0
        assert {file.name: file.read_bytes() for file in out.glob("*.parquet")} == whole
