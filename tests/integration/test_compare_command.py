"""`cytodisk compare`, from files to tables, figures and words."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from command_line import Run, assert_refused, write

import cytodisk as cd

GRID = ("--layers", "4", "--sectors", "40")


@pytest.fixture(scope="module")
def masks(tmp_path_factory: pytest.TempPathFactory) -> Path:
    stack = np.zeros((3, 45, 93), dtype=np.uint8)
    stack[0, :, :45] = cd.simulate.disk(14)
    stack[1] = cd.simulate.dumbbell(14, neck_width=3)
    path = tmp_path_factory.mktemp("masks") / "masks.tif"
    return write(path, stack, metadata={"axes": "TYX"})


def test_masks_become_tables_figures_and_words(run: Run, masks: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    command = ("compare", masks, "-o", out, "--methods", "newton,edge", *GRID)
    code, said, error = run(*command)
    assert code == 0
    assert "cytodisk (default)" in said
    assert "2/2" in said
    assert "100.0%" in said
    assert "worse than edge-based" in said
    assert "figures/comparison.png: share of windows that hold signal" in said
    assert "cell 2, newton (refused): mask of shape" in error
    for name in ("comparison.png", "cells.png"):
        assert (out / "figures" / name).exists()
    by_layer = pd.read_csv(out / "comparison.csv").set_index(["method", "layer"])["completeness"]
    assert (by_layer["newton"] == 1.0).all()
    assert by_layer["edge"][3] < by_layer["edge"][0] == 1.0
    assert set(pd.read_csv(out / "comparison_methods.csv")["method"]) == {"newton", "edge"}

    assert_refused(run(*command), "holds a study: pass --resume to go on, --overwrite to replace it")
    code, again, error = run(*command, "--resume")
    assert code == 0
    assert "complete already" in error
    assert again == said
    code, _, _ = run(*command, "--overwrite", "--quiet")
    assert code == 0


def test_a_movie_is_compared_through_time(run: Run, tmp_path: Path) -> None:
    shown = cd.simulate.movie("translating", 2, frames=3, radius_px=12.0)
    assert shown.signal is not None
    masks = write(tmp_path / "masks.tif", shown.masks.astype(np.uint8), metadata={"axes": "TYX"})
    names = {"axes": "TCYX", "Channel": {"Name": ["material", "edge"]}}
    signal = write(tmp_path / "signal.ome.tif", shown.signal.to_numpy(), metadata=names)
    command = ("compare", masks, "--movie", "--signal", signal, "-o", tmp_path / "out", "--depth-px", "3")
    code, said, _ = run(*command, "--methods", "newton,edge", *GRID, "--frame-interval", "5")
    assert code == 0
    assert "edge-based" in said
    assert "movie_cell_00000_1.png: activity maps" in said
    found = cd.open_comparison(tmp_path / "out")
    assert set(found.consistency["channel"]) == {"material", "edge"}
    assert found.cells["depth_px"].tolist()[1] == 3.0
    assert found.provenance["frame_interval_s"] == 5.0


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--signal", "signal.tif"), "signal is sampled in movies only: pass --movie too"),
        (("--frame-interval", "5"), "frame_interval is that of a movie: pass --movie too"),
        (("--methods", "edge,voronoi"), "methods: Input should be 'newton'"),
        (("--layers", "0"), "layers"),
        (("--depth-px", "-1"), "depth_px"),
    ],
)
def test_what_makes_no_sense_is_refused(
    run: Run, masks: Path, tmp_path: Path, options: tuple[str, ...], words: str
) -> None:
    assert_refused(run("compare", masks, "-o", tmp_path / "out", *options), words)


def test_masks_without_any_cell_end_in_an_error(run: Run, tmp_path: Path) -> None:
    masks = write(tmp_path / "masks.tif", np.zeros((2, 20, 20), dtype=np.uint8), metadata={"axes": "TYX"})
    result = run("compare", masks, "-o", tmp_path / "out", "--methods", "edge,newton")
    assert_refused(result, "no cell could be used: mask of shape (20, 20) is empty")
