"""What the benchmarks say follows from their numbers, and what they time is there."""

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile

import cytodisk as cd
from cytodisk.disk import cell_mesh
from cytodisk.geometry import outline
from cytodisk.geometry.mask import FilledMask
from cytodisk.runs.movie.movie_inputs import open_movie
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.movie.movie_study import movie_study

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def load() -> Iterator[Any]:
    sys.path.insert(0, str(ROOT / "benchmarks"))
    try:
        yield __import__
    finally:
        sys.path.remove(str(ROOT / "benchmarks"))


def test_benchmarks_that_are_named_exist() -> None:
    folders = [(ROOT / "src", "*.py"), (ROOT / "docs", "*.py"), (ROOT / "docs" / "source", "*.rst")]
    pages = [page for folder, names in folders for page in folder.rglob(names)]
    named = {
        (name, page.name)
        for page in [*pages, ROOT / "README.md", ROOT / "CHANGELOG.md", ROOT / "CONTRIBUTING.md"]
        for name in re.findall(r"\bbenchmarks/\w+\.py", page.read_text(encoding="utf-8"))
    }
    assert len(named) > 20
    assert [one for one in sorted(named) if not (ROOT / one[0]).exists()] == []


@pytest.fixture(scope="module")
def clock(load: Any, tmp_path_factory: pytest.TempPathFactory) -> Any:
    """All stages of a small movie."""
    folder = tmp_path_factory.mktemp("movie")
    truth = cd.simulate.movie("bulging", frames=5, radius_px=12.0)
    assert truth.signal is not None
    tifffile.imwrite(folder / "masks.tif", truth.masks.astype(np.uint8), metadata={"axes": "TYX"})
    tifffile.imwrite(folder / "signal.tif", truth.signal.to_numpy(), metadata={"axes": "TCYX"})
    clock = load("stages").StageClock(load("profile_frame").FRAME_STAGES)
    inputs = open_movie(folder / "masks.tif", folder / "signal.tif", MovieParameters(layers=2, sectors=6))
    with clock.watching():
        movie_study(inputs, folder / "study", progress=lambda done, total: clock.lap())
    return clock


def test_every_stage_that_is_timed_is_in_the_package_and_runs(clock: Any) -> None:
    """If not, a function was renamed or is not used any more: change the stages in profile_frame.py."""
    assert clock.missing == []
    assert [s.key for s in clock.stages if not any(lap.calls[s.key] for lap in clock.laps)] == []


def test_stages_and_the_rest_add_up_and_functions_are_put_back(clock: Any) -> None:
    assert not hasattr(outline.trace_outline, "__wrapped__")
    assert not hasattr(cell_mesh.trace_outline, "__wrapped__")
    for lap in clock.laps:
        assert 0.0 <= lap.rest <= lap.seconds
        assert all(seconds >= 0.0 for seconds in lap.by_stage.values())


def test_a_stage_leaves_out_those_inside_it(load: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    stages = load("stages")
    now = iter(range(100))
    monkeypatch.setattr(stages.time, "process_time", lambda: float(next(now)))
    clock = stages.StageClock([stages.Stage("a", "outer", ("x:y",)), stages.Stage("a", "inner", ("x:z",))])
    inner = clock.timed("a: inner", lambda: None)
    clock.timed("a: outer", inner)()
    clock.lap()
    # The clock is read at 0 (start), 1 (outer), 2 and 3 (inner), 4 (outer), 5 (lap).
    assert clock.laps[0].by_stage == {"a: outer": 2.0, "a: inner": 1.0}
    assert clock.laps[0].rest == 2.0


def test_methods_of_a_class_are_timed_and_put_back(load: Any) -> None:
    stages = load("stages")
    clock = stages.StageClock([stages.Stage("a", "of", ("cytodisk.geometry.mask:FilledMask.of",))])
    before = vars(FilledMask)["of"]
    with clock.watching():
        FilledMask.of(cd.simulate.disk(5))
        clock.lap()
    assert clock.laps[0].calls == {"a: of": 1}
    assert vars(FilledMask)["of"] is before


def test_exponents_of_exact_powers(load: Any) -> None:
    scaling, series = load("scaling"), load("scaling_series")
    sizes = 10.0 ** np.arange(1, 7)
    points = [{"n": n, "seconds": 1e-5 * n**1.5, "memory (MB)": 1e-3 * n} for n in sizes]
    steep = scaling.fit("s", series.Growth("seconds", "n", 1.2, ""), points)
    assert steep.exponent == pytest.approx(1.5)
    assert steep.verdict == "NO"
    memory = scaling.fit("s", series.Growth("memory (MB)", "n", 1.05, ""), points)
    assert memory.first >= scaling.LEAST_MB / 1e-3
    assert memory.verdict == "yes"


def test_a_figure_is_met_between_its_ends_only(load: Any) -> None:
    figure = load("figure").Figure
    assert figure("share", 0.05, least=0.03, most=0.07).met
    assert figure("share", 0.08, least=0.03, most=0.07).met is False
    assert figure("speed", 49.0, "×", least=50).met is False
    assert figure("rate", 3.0).met is None
    assert figure("time", 0.04, "s", most=0.06).yardstick == "≤ 0.06 s"


def test_a_block_that_was_not_measured_is_no_success(load: Any, tmp_path: Path) -> None:
    suite = load("suite")
    found = suite.measure_here("area", tmp_path)
    assert "FileNotFoundError" in found["missing"]
    assert suite.table_of({"area": ([], found["missing"])})[1][3] == "NO"


def test_a_comparison_tells_ratios_and_what_is_missing(load: Any) -> None:
    revisions, figure = load("revisions"), load("figure").Figure
    before, after = ([figure("t", value, "s") for value in values] for values in ((2.0, 4.0), (1.0, 3.0)))
    assert revisions.change_in_words(before, after) == ["3 s", "2 s", "0.667", "0.500 – 0.750"]
    assert revisions.change_in_words([], after)[0] == "missing"


@pytest.mark.parametrize(
    ("unit", "before", "after", "words"),
    [
        ("s", (1.0, 2.0), (1.2, 2.2), "WORSE"),
        ("s", (1.0, 2.0), (1.2, 2.0), ""),
        ("MB", (100.0, 100.0), (90.0, 80.0), "better"),
        ("cells/s", (10.0, 10.0), (9.0, 8.0), "WORSE"),
        ("", (1.0, 1.0), (2.0, 2.0), ""),
        ("s", (), (1.0,), ""),
    ],
)
def test_worse_is_what_is_worse_in_every_round(
    load: Any, unit: str, before: tuple[float, ...], after: tuple[float, ...], words: str
) -> None:
    figure = load("figure").Figure
    sides = [[figure("what", value, unit) for value in values] for values in (before, after)]
    assert load("revisions").verdict(*sides) == words


def test_a_command_is_watched_for_its_memory() -> None:
    """In a process of its own: the peak of a child begins with what its parent holds."""
    code = (
        "import os, sys, suite\n"
        "command = [sys.executable, '-c', 'print(len(bytes(60_000_000)))']\n"
        "run, peak_mb = suite.run_watched(command, os.environ)\n"
        "print(run.returncode, run.stdout.strip(), peak_mb)"
    )
    command = [sys.executable, "-c", code]
    watched = subprocess.run(command, cwd=ROOT / "benchmarks", capture_output=True, text=True, timeout=120)
    returncode, said, peak_mb = watched.stdout.split()
    assert (returncode, said) == ("0", "60000000")
    assert 60.0 < float(peak_mb) < 1000.0


@pytest.mark.parametrize("name", sorted(path.stem for path in (ROOT / "benchmarks").glob("*.py")))
def test_every_benchmark_finds_what_it_imports(load: Any, name: str) -> None:
    assert vars(load(name))["__doc__"]


def test_the_older_package_is_that_of_its_revision(load: Any, tmp_path: Path) -> None:
    with pytest.raises(SystemExit, match="no-such-revision"):
        load("revisions").files_of("no-such-revision", tmp_path)


@pytest.mark.parametrize("page", ["where_time_goes", "scaling"])
def test_pages_of_speed_have_their_files(page: str) -> None:
    folder = ROOT / "docs" / "source" / "speed"
    text = (folder / f"{page}.rst").read_text(encoding="utf-8")
    named = [word for word in text.split() if word.startswith(f"{page}/")]
    assert len(named) >= 3
    assert [name for name in named if not (folder / name).exists()] == []


@pytest.mark.parametrize("apart", [-90, 0, 60, 180])
def test_poles_apart_are_found_wherever_they_are(load: Any, apart: int) -> None:
    rng = np.random.default_rng(0)
    place, pole = np.arange(36) * 10.0, rng.uniform(0, 360, 40).reshape(40, 1)
    first = np.cos(np.radians(place - pole)) + 0.5 * rng.normal(size=(40, 36))
    second = 7.0 + np.cos(np.radians(place - pole - apart)) + 0.5 * rng.normal(size=(40, 36))
    second[3] = np.nan
    degrees, agreement, p = load("rac1_dgap1").poles_apart(first, second)
    assert abs((degrees - apart + 180.0) % 360.0 - 180.0) < 10.0
    assert agreement > 0.9
    assert p == 0.001
    assert load("rac1_dgap1").poles_apart(first, rng.normal(size=(40, 36)))[1] < 0.5


def test_the_mask_of_the_brightest_cell_is_followed(load: Any) -> None:
    rng = np.random.default_rng(0)
    y, x = np.mgrid[:60, :70]
    cell = [np.hypot(y - 25, x - 22 - step) < 12 for step in range(10)]
    other = np.hypot(y - 48, x - 60) < 6
    images = np.array([[80.0 * mask + 30.0 * other, 40.0 * mask + 15.0 * other] for mask in cell])
    masks, thresholds = load("rac1_dgap1").cell_masks(rng.poisson(images + 2.0).astype(float))
    assert thresholds.shape == (10,)
    overlap = [(mask & true).sum() / (mask | true).sum() for mask, true in zip(masks, cell, strict=True)]
    assert min(overlap) > 0.9
