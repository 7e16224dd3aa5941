"""`cytodisk correlate` and `cytodisk report`, from files to tables, figures and the page."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from command_line import Run, assert_refused, content, write

import cytodisk as cd
from cytodisk.simulate import movie

GRID = ("--layers", "3", "--sectors", "12", "--figures", "0", "--quiet")
FEW = ("--surrogates", "99", "--max-lag", "8")


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study with two channels, without a scale."""
    folder = tmp_path_factory.mktemp("study")
    shown = movie("fluctuating", 5, frames=30, radius_px=18, lag_frames=-3)
    assert shown.signal is not None
    masks = write(folder / "masks.tif", shown.masks.astype(np.uint8), metadata={"axes": "TYX"})
    names = {"axes": "TCYX", "Channel": {"Name": ["material", "edge"]}}
    signal = write(folder / "signal.ome.tif", shown.signal.to_numpy(), metadata=names)
    import sys
    from unittest import mock

    from cytodisk import cli

    arguments = ["cytodisk", "movie", str(masks), "--signal", str(signal), "-o", str(folder / "out"), *GRID]
    with mock.patch.object(sys, "argv", arguments), pytest.raises(SystemExit) as stop:
        cli.main()
    assert not stop.value.code
    return folder / "out"


def test_a_signal_with_velocity(run: Run, study: Path) -> None:
    code, said, _ = run(
        "correlate", study, "--signal", "edge", "--with", "velocity", *FEW, "--format", "svg,pdf"
    )
    assert code == 0
    assert "Positive lag: the edge moves after the signal" in said
    assert "layer 0: mean of the layer +0." in said
    assert "at lag +3 frames, q = " in said
    assert "; single windows significant: " in said
    assert "cell 0, clusters of neighbouring windows, p ≤ 0.05" in said
    assert "lag +3 frames: the edge moves after the signal, mean r +0." in said
    verdict, finding = said.splitlines()[-2:]
    assert verdict.startswith("cell 0. Nothing speaks against: layer 0 (lag +3 frames)")
    assert finding.startswith("Finding, cell 0: Signal 'edge' in layer 0 (outermost) rises 3 frames before")
    found = cd.open_study(study).correlation("edge", "velocity")
    assert found.layers.set_index("layer").loc[0, "lag"] == 3  # the signal leads by three frames
    assert np.isnan(found.windows["lag_s"]).all()  # the interval is not known
    suffixes = {path.suffix for path in (found.path / "figures").iterdir()}
    assert suffixes == {".svg", ".pdf"}


def test_two_signals_and_pairs(run: Run, study: Path) -> None:
    command = ("correlate", study, "--signal", "material", "--with", "edge", "--pairs", "--detrend", "linear")
    code, said, _ = run(*command, "--surrogates", "19", "--max-lag", "5", "--figures", "1")
    assert code == 0
    assert "1 cell correlated" in said
    found = cd.open_study(study).correlation("material", "edge")
    assert found.settings["detrend"] == "linear"
    assert found.pairs is not None
    assert any("pairs" in path.name for path in (found.path / "figures").iterdir())


def test_controls_that_cannot_be_taken_out_are_told(run: Run, study: Path) -> None:
    command = (
        "correlate",
        study,
        "--signal",
        "edge",
        "--control",
        "material",
        "--no-geometry",
        "--name",
        "short",
    )
    few = ("--frames", "0:17", "--max-lag", "4", "--surrogates", "19", "--figures", "0")
    code, said, _ = run(*command, *few)
    assert code == 0
    assert "; without material not known: too few frames" in said


def test_lags_may_be_left_out(run: Run, study: Path) -> None:
    code, _, _ = run("correlate", study, "--signal", "edge", *FEW, "--skip-lags=-1,0", "--figures", "0", "-q")
    assert code == 0
    curves = cd.open_study(study).correlation("edge").curves.set_index("lag")["correlation"]
    assert curves.loc[[-1, 0]].isna().all()
    assert curves.loc[[-2, 1]].notna().all()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((), "signal is not given: pass --signal with one of 'material', 'edge'"),
        (("--signal", "VASP"), "signal 'VASP' is not in the study: it has 'material', 'edge'"),
        (("--signal", "edge", "--with", "speed"), "with 'speed' is not in the study"),
        (("--signal", "edge", "--max-lag", "25"), "max_lag 25 leaves 5 pairs of 30 frames"),
        (("--signal", "edge", "--format", "jpg"), "format must be png, pdf, svg"),
        (("--signal", "edge", "--skip-lags", "a"), "--skip-lags must be whole numbers"),
        (("--signal", "edge", "--skip-lags", "90"), "skip_lags has 90"),
        (("--signal", "edge", "--cell", "4"), "has no cell 4"),
        (("--signal", "edge", "--rule", "first"), "--rule must be one of nearest, largest"),
    ],
)
def test_faults_end_in_words(run: Run, study: Path, arguments: tuple[str, ...], words: str) -> None:
    assert_refused(run("correlate", study, *arguments), words)


def test_what_is_no_movie(run: Run, study: Path, tmp_path: Path) -> None:
    assert_refused(run("correlate", tmp_path), "is no study")
    assert_refused(run("report", tmp_path / "nothing"), "does not exist")
    mask = write(tmp_path / "mask.tif", cd.simulate.random_smooth(0, radius=14).astype(np.uint8))
    run("map", mask, "-o", tmp_path / "maps", *GRID)
    assert_refused(run("correlate", tmp_path / "maps"), "is not that of a movie", "cytodisk movie")
    assert run("report", tmp_path / "maps")[0] == 0


def test_a_report_of_it(run: Run, study: Path, tmp_path: Path) -> None:
    run("correlate", study, "--signal", "edge", *FEW, "--figures", "0", "-q")
    code, said, _ = run("report", study)
    assert code == 0
    page = study / "report.html"
    assert f"report: {page} (" in said
    assert "<script" in page.read_text(encoding="utf-8")
    code, _, _ = run("report", study, "-o", tmp_path / "mine.html", "-q")
    assert code == 0
    assert (tmp_path / "mine.html").stat().st_size == pytest.approx(page.stat().st_size, rel=0.01)
    before = content(study)
    assert_refused(run("report", study, "--cell", "7"), "got 7")
    assert_refused(run("report", study, "--signal", study / "nothing.tif"), "nothing.tif")
    assert content(study) == before


@pytest.mark.slow
def test_a_movie_run_again_takes_old_correlations_away(run: Run, study: Path, tmp_path: Path) -> None:
    """What was correlated belongs to the results that are replaced."""
    folder = study.parent
    movie_command = (
        "movie",
        folder / "masks.tif",
        "--signal",
        folder / "signal.ome.tif",
        "-o",
        tmp_path / "out",
    )
    run(*movie_command, *GRID)
    run("correlate", tmp_path / "out", "--signal", "edge", *FEW, "--figures", "0", "-q")
    assert cd.open_study(tmp_path / "out").correlations == [("edge", "velocity")]
    code, _, _ = run(*movie_command, *GRID, "--overwrite")
    assert code == 0
    assert cd.open_study(tmp_path / "out").correlations == []


def test_what_is_replaced_is_told_and_a_name_keeps_both(run: Run, study: Path) -> None:
    command = ("correlate", study, "--signal", "edge", *FEW, "--figures", "0")
    run(*command, "--name", "raw")
    code, said, _ = run(*command, "--name", "raw", "--detrend", "linear", "--sectors", "3:8")
    assert code == 0
    replaced = said.splitlines()[0]
    assert replaced.startswith("The earlier correlation (--detrend none, with all sectors) will be replaced.")
    assert "A patch of fewer than 4 windows cannot reach q < 0.05. To find one, use --surrogates 999" in said
    names = cd.open_study(study).correlations
    assert ("edge", "velocity", "raw") in names
    for arguments, words in (
        (("--frames", "5"), "--frames must be the first and the last, such as 10:80, got '5'"),
        (("--without-frames", "3:4"), "--without-frames must be whole numbers, such as 17,24, got '3:4'"),
    ):
        assert_refused(run(*command, *arguments), words)
    assert_refused(run("correlate", study, "--signal", "edge", "--surrogates", "5"), "at least 19")


@pytest.mark.slow
def test_maps_of_an_earlier_version_are_told_once(run: Run, study: Path, tmp_path: Path) -> None:
    old = shutil.copytree(study, tmp_path / "old")
    found = json.loads((old / "provenance.json").read_text())
    del found["fingerprint"]["maps version"]
    found["versions"]["cytodisk"] = "0.1.0"
    (old / "provenance.json").write_text(json.dumps(found))
    (old / "parameters.toml").write_text('method = "newton"\nedge_length = 0.9\n')
    line = (
        "Maps by cytodisk 0.1.0: their windows lie at other places than those of this version. "
        "Do not compare window by window with studies made now."
    )
    few = ("--signal", "edge", "--surrogates", "19", "--max-lag", "4", "--figures", "0", "--no-geometry")
    code, said, error = run("correlate", old, *few)
    assert (code, said.splitlines().count(line), "Maps by" in error) == (0, 1, False)
    code, said, _ = run("correlate", study, *few, "--name", "now")
    assert (code, "Maps by" in said) == (0, False)
    again = ("--parameters", old / "parameters.toml", *GRID, "-o", tmp_path / "again")
    code, _, error = run("movie", study.parent / "masks.tif", *again)
    assert (code, error.count("Warning: parameters file")) == (0, 1)
    assert 'method "newton" meant areas by triangle then' in error
    pytest.importorskip("jinja2")
    code, said, error = run("report", old)
    assert (code, said.splitlines().count(line), "Maps by" in error) == (0, 1, False)
    assert "QC flag earlier maps" not in said  # the line says it
    assert "the maps were made by cytodisk 0.1.0" in (old / "report.html").read_text(encoding="utf-8")
