from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

import cytodisk as cd
from cytodisk.errors import WindowError
from cytodisk.plot.cell.window_labels import window_colours


def axes() -> Any:
    return Figure().add_subplot()


def test_edge_windows_are_drawn_in_the_frame_of_the_image() -> None:
    mask = np.pad(cd.simulate.disk(10), ((3, 0), (0, 6)))
    windows = cd.edge_windows(mask, layers=2, sectors=4, depth_px=3.0)
    drawn = cd.plot.draw_window_labels(axes(), windows)
    height, width = mask.shape
    assert drawn.get_extent() == [-0.5, width - 0.5, height - 0.5, -0.5]  # pixel centres at whole numbers
    colours = np.asarray(drawn.get_array())
    assert (colours[windows.labels == -1] == 1.0).all()  # deeper than the layers, and outside
    assert len(np.unique(colours[windows.labels >= 0], axis=0)) == 4  # two layers, sectors in turn paler


@pytest.mark.parametrize("name", ["draw_windows", "draw_window_means"])
def test_windows_without_outlines_are_told_what_draws_them(name: str) -> None:
    values = [np.ones((2, 4))] if name == "draw_window_means" else []
    with pytest.raises(WindowError, match="use draw_window_labels"):
        getattr(cd.plot, name)(axes(), cd.edge_windows(cd.simulate.disk(10), 2, 4), *values)


def test_a_grid_without_a_cell_is_refused() -> None:
    with pytest.raises(WindowError, match="use grid"):
        cd.plot.draw_window_labels(axes(), cd.polar_windows(2, 4))
    with pytest.raises(WindowError, match="pass map_to_disk"):
        cd.polar_windows(2, 4).on(cd.simulate.disk(10))


def test_layers_have_colours_and_every_other_sector_is_paler() -> None:
    labels = np.array([[0, 1, 2, 3, 8, -1]])
    colours = window_colours(labels, (3, 4))[0]
    np.testing.assert_array_equal(colours[0], colours[2])
    np.testing.assert_array_equal(colours[1], colours[3])
    assert (colours[1] > colours[0]).all()
    assert colours[4].sum() > colours[0].sum()  # the centre is lighter than the edge
    np.testing.assert_array_equal(colours[5], [1.0, 1.0, 1.0])
