"""`cytodisk compare-windows`, from files to tables, figures and words."""

import inspect
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from command_line import Run, assert_refused, write

import cytodisk as cd
from cytodisk.cli.compare_windows_command import compare_windows_command

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
    command = ("compare-windows", masks, "-o", out, "--methods", "newton,edge", *GRID)
    code, said, error = run(*command)
    assert code == 0
    table = [line.split() for line in said.splitlines()]
    assert said.startswith("masks: a stack of masks, TYX (3, 45, 93) uint8\npixel size: unknown")
    assert ["method", "newton", "edge"] in [line[:3] for line in table]
    assert ["mapped", "2/2", "2/2"] in [line[:3] for line in table]
    assert ["completeness", "100.0%"] in [line[:2] for line in table]
    assert ["flipped", "0", "triangles"] in [line[:3] for line in table]  # none where there is no map
    assert "worse than edge-based" in said
    assert "figures/comparison.png: filled windows" in said
    assert "comparison_columns.csv says what their columns are" in said
    assert error.count("1 refused: cell 2 of masks.tif: mask of shape") == 1  # once for both methods
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
    code, said, _ = run(
        *command, "--overwrite", "--quiet", "--cells", "1", "--depth-um", "1.5", "--pixel-size", "0.5"
    )
    assert (code, said) == (0, "")
    assert cd.open_comparison(out).provenance["parameters"]["depth_px"] == 3.0
    assert_refused(
        run("report", out), "holds a run of cytodisk compare-windows: look at comparison.csv and the figures"
    )


@pytest.mark.slow
def test_a_movie_is_compared_through_time(run: Run, tmp_path: Path) -> None:
    shown = cd.simulate.movie("translating", 2, frames=3, radius_px=12.0)
    assert shown.signal is not None
    masks = write(tmp_path / "masks.tif", shown.masks.astype(np.uint8), metadata={"axes": "TYX"})
    names = {"axes": "TCYX", "Channel": {"Name": ["material", "edge"]}}
    signal = write(tmp_path / "signal.ome.tif", shown.signal.to_numpy(), metadata=names)
    command = (
        "compare-windows",
        masks,
        "--movie",
        "--signal",
        signal,
        "-o",
        tmp_path / "out",
        "--depth-px",
        "3",
    )
    code, said, _ = run(*command, "--methods", "newton,edge", *GRID, "--frame-interval", "5")
    assert code == 0
    assert "edge-based" in said
    assert said.startswith("masks: masks of one cell, 3 frames of 47 × 50 pixels")
    assert "frame interval: 5 s" in said
    assert "movie_cell_00000_edge.png: activity maps of edge" in said
    assert "comparison_movie.csv through time" in said
    found = cd.open_comparison(tmp_path / "out")
    in_all = found.through_time[found.through_time["layer"].isna()].set_index(["channel", "method"])
    rows = {" ".join(line[:26].split()): line[26:].split()[:2] for line in said.splitlines()}
    for name in ("correlation", "centroid_displacement"):
        shown = f"{name}, material" if name == "correlation" else name
        expected = [in_all.loc[("material", method), name] for method in ("newton", "edge")]
        assert [float(value) for value in rows[shown]] == pytest.approx(expected, rel=0.01)
    assert set(found.consistency["channel"]) == {"material", "edge"}
    assert found.cells["depth_px"].tolist()[1] == 3.0
    assert found.provenance["frame_interval_s"] == 5.0


def test_cells_with_nuclei_are_compared_with_rings(run: Run, tmp_path: Path) -> None:
    found = cd.simulate.cell_with_nucleus("off centre", seed=2, shape="spiky", radius_px=20)
    cells = write(tmp_path / "cells.tif", found.mask.astype(np.uint8))
    nuclei = write(tmp_path / "nuclei.tif", found.nucleus.astype(np.uint8))
    out = tmp_path / "out"
    code, said, _ = run(
        "compare-windows", cells, "--nuclei", nuclei, "-o", out, "--nucleus-layers", "2", *GRID
    )
    assert code == 0
    table = {line.split()[0]: line.split()[1:] for line in said.splitlines() if line.strip()}
    assert table["method"][:3] == ["newton", "nucleus-rings", "interpolated-rings"]
    assert table["flipped"][0] == "0" != table["flipped"][1]
    assert float(table["outer_fifth"][0].rstrip("%")) == pytest.approx(20.0, abs=2.5)
    assert "interpolated rings: rings cross each other in 1 of 1 cells" in said
    assert "by layer of cytoplasm and nucleus" in said
    for name in ("comparison.png", "cells.png"):
        assert (out / "figures" / name).exists()
    assert cd.open_comparison(out).has_nuclei


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--nuclei", "nuclei.tif", "--movie"), "leave --movie or --nuclei out"),
        (("--nuclei", "nuclei.tif", "--depth-px", "3"), "--depth-px: not with --nuclei; leave it out"),
        (("--nuclei", "nuclei.tif", "--signal", "s.tif"), "--signal: not with --nuclei; leave it out"),
        (
            ("--nuclei", "nuclei.tif", "--methods", "edge"),
            "--methods must be several of newton, nucleus-rings",
        ),
        (("--nucleus-layers", "2"), "--nucleus-layers: only with --nuclei; pass that too, or leave it out"),
        (("--harmonics", "9", "--movie"), "--harmonics: not with --movie; leave it out"),
        (("--signal", "signal.tif"), "--signal: only with --movie"),
        (("--frame-interval", "5"), "--frame-interval: only with --movie"),
        (("--line-tension", "1"), "--line-tension: only with --movie"),
        (("--evenness", "-1"), "--evenness must be a number"),
        (("--channels", "VASP", "--nan", "omit"), "--channels, --nan: only with --movie"),
        (("--methods", "edge,voronoi"), "--methods must be several of newton"),
        (("--layers", "0"), "--layers must be"),
        (("--depth-px", "-1"), "--depth-px must be a number above 0"),
        (("--depth-um", "1"), "depth_um needs a pixel size: pass it as --pixel-size, or pass --depth-px"),
        (
            ("--depth-um", "0", "--pixel-size", "1"),
            "--depth-um must be a number above 0 and at most 1000000, got 0",
        ),
        (("--depth-um", "1", "--depth-px", "2"), "--depth-px and --depth-um exclude each other"),
        (("--cells", "1,two"), "cells must be numbers of cells as 3,17,20, got '1,two'"),
        (("--cells", "1,2,3,4,5,6"), "cells: got 6: name one to 5"),
        (("--cells", "1", "--movie"), "cells chooses what cells.png shows"),
    ],
)
def test_what_makes_no_sense_is_refused(
    run: Run, masks: Path, tmp_path: Path, options: tuple[str, ...], words: str
) -> None:
    assert_refused(run("compare-windows", masks, "-o", tmp_path / "out", *options), words)


def test_the_help_says_what_needs_a_movie() -> None:
    shown = inspect.signature(compare_windows_command).parameters
    helps = {name: one.annotation.__metadata__[0].help for name, one in shown.items()}
    of_movies = {name for name, words in helps.items() if "only with --movie" in words}
    both = cd.CompareWindowsParameters.model_fields.keys() | cd.RunOptions.model_fields.keys()
    assert of_movies == {"signal", *(cd.CompareMovieParameters.model_fields.keys() - both)}
    assert {"channels", "nan", "tracker", "frame_interval_s"} <= of_movies
    ours = "(default newton,harmonic,advection,edge; with --movie newton,harmonic,edge; with --nuclei "
    assert helps["methods"].endswith(ours + "newton,nucleus-rings,interpolated-rings)")
    assert "only with --nuclei" in helps["nucleus_layers"]
    assert not any("depth_px" in words for words in helps.values())


def test_masks_without_any_cell_end_in_an_error(run: Run, tmp_path: Path) -> None:
    masks = write(tmp_path / "masks.tif", np.zeros((2, 20, 20), dtype=np.uint8), metadata={"axes": "TYX"})
    result = run("compare-windows", masks, "-o", tmp_path / "out", "--methods", "edge,newton")
    assert_refused(result, "no cell could be used: mask of shape (20, 20) is empty")


def test_a_damaged_file_of_a_folder_is_told_once_and_ends_in_2(run: Run, tmp_path: Path) -> None:
    folder = tmp_path / "masks"
    folder.mkdir()
    write(folder / "a_masks.tif", cd.simulate.disk(12).astype(np.uint8))
    (folder / "b_masks.tif").write_bytes(b"no image")
    code, said, error = run(
        "compare-windows", folder, "-o", tmp_path / "out", "--methods", "newton,edge", *GRID
    )
    assert code == 2
    assert ["mapped", "1/1", "1/1"] in [line.split()[:3] for line in said.splitlines()]
    assert error.count("b_masks.tif") == 1
    assert "damaged files or frames of the input: 1" in error
