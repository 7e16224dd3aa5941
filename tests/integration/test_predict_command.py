"""`cytodisk predict`, from files to tables, figures and what is printed."""

import json
from pathlib import Path

import numpy as np
import pytest
from command_line import Run, assert_refused, write

import cytodisk as cd
from cytodisk.simulate import movie

GRID = ("--layers", "2", "--sectors", "8", "--figures", "0", "--quiet")
FEW = ("--surrogates", "99", "--max-order", "4")


@pytest.mark.slow
def test_from_a_movie_to_a_finding(run: Run, tmp_path: Path) -> None:
    """The signal "edge" follows velocity two frames later; "material" has nothing to do with it."""
    shown = movie("fluctuating", 3, frames=50, radius_px=14, lag_frames=2)
    assert shown.signal is not None
    masks = write(tmp_path / "masks.tif", shown.masks.astype(np.uint8), metadata={"axes": "TYX"})
    names = {"axes": "TCYX", "Channel": {"Name": ["material", "edge"]}}
    signal = write(tmp_path / "signal.ome.tif", shown.signal.to_numpy(), metadata=names)
    out = tmp_path / "out"
    arguments = ("movie", masks, "--signal", signal, "-o", out, *GRID, "--frame-interval", "5")
    assert run(*arguments)[0] == 0

    code, said, _ = run("predict", out, "--source", "edge", *FEW, "--format", "svg", "--csv")
    assert code == 0
    first = said.splitlines()[0]
    assert first.startswith("Finding, cell 0: ")
    assert "The other way round, edge velocity predicts signal 'edge' in layer 0 (outermost)" in first
    assert "without geometry, q = " in first
    assert "a common driver that was not given, such as signal 'material', can do the same." in first
    assert "QC flag common driver" in said
    found = cd.open_study(out).prediction("edge", "velocity")
    back = found.links.query("source == 'velocity' and layer == 0").iloc[0]
    assert back["q"] < 0.05
    assert back["q_partial"] < 0.05
    assert not back["geometry"]
    assert found.cells["partial_frames"].item() >= 20
    folder = out / "prediction" / "edge~velocity"
    assert {path.name for path in (folder / "figures").iterdir()} == {
        f"cell_00000_{what}.svg" for what in ("network", "profile", "lags")
    }
    assert (folder / "links.csv").exists()

    code, said, _ = run("predict", out, *FEW, "--figures", "0", "--no-geometry")
    assert code == 0
    assert said.startswith(
        "Finding, cell 0: Of 6 links among signal 'material', signal 'edge' and edge velocity"
    )
    assert "geometry was not tested (--no-geometry)" in said
    few = ("--surrogates", "19", "--no-geometry", "--figures", "0")
    code, said, _ = run("predict", out, "--source", "edge", *few, "--given", "material")
    assert said.startswith("The earlier prediction (--max-order 4, --surrogates 99, --geometry, no --given)")
    assert "Given: signal 'material'" in said
    assert not (folder / "figures").exists()  # they were those of the earlier one

    (folder / "notes.txt").write_text("mine")
    assert run(*arguments, "--overwrite")[0] == 0
    assert [path.name for path in (out / "prediction").rglob("*") if path.is_file()] == ["notes.txt"]
    files = json.loads((out / "provenance.json").read_text(encoding="utf-8"))["files"]
    assert not any(name.startswith("prediction/") for name in files)


def test_what_is_no_study_is_refused(run: Run, tmp_path: Path) -> None:
    assert_refused(run("predict", tmp_path), "is no study")
    assert_refused(run("predict", tmp_path, "--surrogates", "5"), "surrogates must be 0, or at least 19")
    assert_refused(run("predict", tmp_path, "--figures", "0", "--format", "pdf"), "leave one out")
