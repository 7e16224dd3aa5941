from pathlib import Path
from typing import Any, get_args

import numpy as np
import pandas as pd
import pytest
import tifffile
from matplotlib.figure import Figure

import cytodisk as cd
from cytodisk.errors import ParameterError
from cytodisk.pages.compared_cells import chosen_cells
from cytodisk.pages.compared_layers import METHOD_STYLES, draw_measure_by_layer, spread_over
from cytodisk.pages.compared_movie import consistency_by_layer, draw_displacement
from cytodisk.plot.cell.window_labels import draw_label_image
from cytodisk.runs.compare_windows.compare_parameters import TITLES, MovieMethod, NucleusMethod

METHODS = ("newton", "edge")


def axes() -> Any:
    return Figure().add_subplot()


@pytest.fixture(scope="module")
def comparison(tmp_path_factory: pytest.TempPathFactory) -> cd.Comparison:
    folder = tmp_path_factory.mktemp("comparison")
    stack = np.zeros((2, 45, 93), dtype=np.uint8)
    stack[0, :, :45] = cd.simulate.disk(14)
    stack[1] = cd.simulate.dumbbell(14, neck_width=3)
    tifffile.imwrite(folder / "masks.tif", stack, photometric="minisblack", metadata={"axes": "TYX"})
    grid = cd.CompareWindowsParameters(methods=METHODS, layers=3, sectors=8)
    return cd.run_compare_windows(folder / "masks.tif", folder / "out", parameters=grid)


def test_every_method_has_a_name_a_colour_and_a_mark_of_its_own() -> None:
    assert set(TITLES) == set(METHOD_STYLES)
    for together in (get_args(MovieMethod), get_args(NucleusMethod)):
        for key in ("color", "marker"):
            assert len({METHOD_STYLES[method][key] for method in together}) == len(together)


def test_lines_are_the_measure_by_layer_and_bands_its_quartiles(comparison: cd.Comparison) -> None:
    ax = axes()
    table = comparison.by_layer
    lines = draw_measure_by_layer(ax, table, "area_cv", "spread", METHODS)
    for line, band, method in zip(lines, ax.collections, METHODS, strict=True):
        rows = table[table["method"] == method]
        np.testing.assert_array_equal(line.get_xdata(), rows["layer"])
        np.testing.assert_array_equal(line.get_ydata(), rows["area_cv"])
        assert line.get_color() == METHOD_STYLES[method]["color"]
        (path,) = band.get_paths()
        assert path.vertices[:, 1].min() == rows["area_cv_q25"].min()
        assert path.vertices[:, 1].max() == rows["area_cv_q75"].max()
    assert ax.get_ylabel() == "spread"
    assert ax.get_ylim()[0] == 0.0


def test_negative_values_are_not_cut_off() -> None:
    table = pd.DataFrame({"method": "edge", "layer": [0, 1], "r": [0.5, -0.5], "r_q25": -0.7, "r_q75": 0.7})
    ax = axes()
    draw_measure_by_layer(ax, table, "r", "correlation", ("edge",))
    assert ax.get_ylim()[0] < -0.7


def test_lines_on_each_other_are_all_seen() -> None:
    """The default is solid and the widest, behind the others."""
    others = [style for name, style in METHOD_STYLES.items() if name != "newton"]
    for key in ("linewidth", "markersize"):
        assert METHOD_STYLES["newton"][key] > max(style[key] for style in others)
    assert METHOD_STYLES["newton"]["zorder"] < min(style["zorder"] for style in others)


def test_values_are_spread_by_rank() -> None:
    assert spread_over([3.0, 1.0, np.nan, 2.0], 5) == [1, 3, 0]
    assert spread_over(np.arange(9.0)[::-1], 3) == [8, 4, 0]
    assert spread_over([], 5) == []


def test_cells_are_chosen_from_simple_to_complex(comparison: cd.Comparison) -> None:
    assert chosen_cells(comparison) == [0, 1]


def test_cells_that_cannot_be_drawn_are_refused(comparison: cd.Comparison) -> None:
    with pytest.raises(ParameterError, match=r"7 has no windows.*0 to 1"):
        cd.pages.write_compared_cells(comparison, [0, 7])
    with pytest.raises(ParameterError, match="cells: got 6: name one to 5"):
        cd.pages.write_compared_cells(comparison, range(6))


def test_what_lies_in_no_window_is_white(comparison: cd.Comparison) -> None:
    labels = comparison.labels(0)
    ax = axes()
    drawn = draw_label_image(ax, labels["edge"], labels["mask"], (3, 8))
    white = (np.asarray(drawn.get_array()) == 1.0).all(axis=-1)
    np.testing.assert_array_equal(white, labels["edge"] < 0)
    nothing = draw_label_image(axes(), None, labels["mask"], (3, 8))
    assert (np.asarray(nothing.get_array()) == 1.0).all()


def test_displacement_is_the_mean_over_layers_through_time() -> None:
    rows = pd.DataFrame(
        {
            "method": ["edge"] * 4 + ["newton"] * 4,
            "frame": [0, 0, 2, 2] * 2,
            "layer": [0, 1] * 4,
            "centroid_displacement": [1.0, 3.0, 5.0, np.nan, 0.5, 0.5, 1.0, 2.0],
        }
    )
    edge, newton = draw_displacement(axes(), rows, ("edge", "newton"), cd.Scale())
    assert edge.axes.get_ylabel() == "movement of windows (px)"
    np.testing.assert_array_equal(edge.get_xdata(), [0.0, 1.0, 2.0])
    np.testing.assert_array_equal(edge.get_ydata(), [2.0, np.nan, 5.0])
    np.testing.assert_array_equal(newton.get_ydata(), [0.5, np.nan, 1.5])
    table = consistency_by_layer(rows, "centroid_displacement").set_index(["method", "layer"])
    assert table.loc[("edge", 0), "centroid_displacement"] == 3.0
    assert table.loc[("edge", 0), "centroid_displacement_q25"] == 2.0


@pytest.mark.slow
def test_pages_stand_in_the_folder(comparison: cd.Comparison, tmp_path: Path) -> None:
    assert cd.pages.write_comparison(comparison) == comparison.path / "figures" / "comparison.png"
    assert cd.pages.write_compared_cells(comparison) == comparison.path / "figures" / "cells.png"
    shown = cd.simulate.movie("translating", 2, frames=3, radius_px=12.0)
    assert shown.signal is not None
    options: Any = {"photometric": "minisblack"}
    tifffile.imwrite(tmp_path / "m.tif", shown.masks.astype(np.uint8), metadata={"axes": "TYX"}, **options)
    names = {"axes": "TCYX", "Channel": {"Name": ["material", "edge"]}}
    tifffile.imwrite(tmp_path / "s.ome.tif", shown.signal.to_numpy(), metadata=names, **options)
    grid = cd.CompareMovieParameters(methods=METHODS, layers=3, sectors=8)
    movie = cd.run_compare_windows(
        tmp_path / "m.tif", tmp_path / "out", parameters=grid, signal=tmp_path / "s.ome.tif"
    )
    first = cd.pages.write_compared_movie(movie, 0, "material")
    second = cd.pages.write_compared_movie(movie, 0, "edge")
    assert (first.name, second.name) == ("movie_cell_00000_material.png", "movie_cell_00000_edge.png")
    silent = cd.run_compare_windows(tmp_path / "m.tif", tmp_path / "silent", parameters=grid)
    assert cd.pages.write_compared_movie(silent, 0).name == "movie_cell_00000.png"
    for path in (first, second, comparison.path / "figures" / "cells.png"):
        assert path.read_bytes().startswith(b"\x89PNG")
