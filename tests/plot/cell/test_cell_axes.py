import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cytodisk.arrays import FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import ParameterError, SignalError, WindowError
from cytodisk.plot.cell.area_distortion import distortion_limit, draw_area_distortion
from cytodisk.plot.cell.cell_axes import draw_cell, draw_mesh, draw_outline
from cytodisk.plot.cell.window_polygons import draw_window_means, draw_windows
from cytodisk.scale import Scale
from cytodisk.windows.polar_windows import CellWindows


def _polygon_area(vertices: FloatArray) -> float:
    x, y = vertices.T
    return 0.5 * abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1)))


def test_cell_is_framed_with_y_downwards(ax: Axes, image: FloatArray, disk: DiskMap) -> None:
    drawn = draw_cell(ax, image, disk, scale=Scale(0.25))
    left, right = ax.get_xlim()
    bottom, top = ax.get_ylim()
    assert left < disk.outline_yx[:, 1].min() < disk.outline_yx[:, 1].max() < right
    assert bottom > disk.outline_yx[:, 0].max() > disk.outline_yx[:, 0].min() > top
    assert ax.get_aspect() == 1.0
    assert not ax.axison
    assert [text.get_text() for text in ax.texts] == ["2 µm"]
    assert list(drawn.get_extent()) == [-0.5, 89.5, 49.5, -0.5]


def test_cell_colours_are_limited_by_what_is_inside(ax: Axes, image: FloatArray, disk: DiskMap) -> None:
    spoiled = np.where(disk.mask, image, 1e9)
    low, high = draw_cell(ax, spoiled, disk).get_clim()
    inside = image[disk.mask]
    assert inside.min() <= low < high <= inside.max()


def test_cell_refuses_an_image_of_another_shape(ax: Axes, image: FloatArray, disk: DiskMap) -> None:
    with pytest.raises(SignalError, match=r"image.*\(2, 50, 90\).*\(50, 90\)"):
        draw_cell(ax, np.stack([image, image]), disk)


def test_outline_is_the_cells(ax: Axes, disk: DiskMap) -> None:
    assert np.array_equal(draw_outline(ax, disk).get_xy()[:-1], disk.outline_yx[:, ::-1])


@pytest.mark.parametrize("by_layer", [False, True])
def test_windows_are_one_polygon_each(ax: Axes, windows: CellWindows, by_layer: bool) -> None:
    drawn = draw_windows(ax, windows, by_layer=by_layer)
    paths = drawn.get_paths()
    assert len(paths) == 24
    total = sum(_polygon_area(np.asarray(path.vertices)[:-1]) for path in paths)
    assert total == pytest.approx(_polygon_area(windows.disk.outline_yx))
    if by_layer:
        assert np.array_equal(np.asarray(drawn.get_array()), np.repeat([0, 1, 2], 8))


def test_means_keep_their_window(ax: Axes, windows: CellWindows) -> None:
    values = np.arange(24.0).reshape(3, 8)
    drawn = draw_window_means(ax, windows, values)
    assert np.array_equal(np.asarray(drawn.get_array()), values.ravel())
    centre = np.asarray(drawn.get_paths()[9].vertices).mean(axis=0)
    assert np.abs(centre[::-1] - windows.centroids_yx[1, 1]).max() < 3


def test_means_take_a_data_array_by_its_dims(ax: Axes, windows: CellWindows) -> None:
    values = xr.DataArray(np.arange(24.0).reshape(3, 8), dims=("layer", "sector"))
    drawn = draw_window_means(ax, windows, values.transpose("sector", "layer"))
    assert np.array_equal(np.asarray(drawn.get_array()), np.arange(24.0))


def test_means_that_are_missing_are_masked(ax: Axes, windows: CellWindows) -> None:
    values = np.ones((3, 8))
    values[2, 5] = np.nan
    array = draw_window_means(ax, windows, values).get_array()
    assert np.flatnonzero(np.ma.getmaskarray(array)).tolist() == [21]


def test_means_may_all_be_missing(ax: Axes, windows: CellWindows) -> None:
    drawn = draw_window_means(ax, windows, np.full((3, 8), np.nan))
    assert drawn.get_clim() == (0.0, 1.0)


def test_means_refuse_another_shape(ax: Axes, windows: CellWindows) -> None:
    with pytest.raises(WindowError, match=r"values.*\(8, 3\).*\(3, 8\)"):
        draw_window_means(ax, windows, np.ones((8, 3)))
    with pytest.raises(WindowError, match="values must be numbers"):
        draw_window_means(ax, windows, np.full((3, 8), "a"))


def test_mesh_has_every_edge_once(ax: Axes, disk: DiskMap) -> None:
    lines = draw_mesh(ax, disk.vertices_yx, disk.triangles)
    assert len(lines.get_segments()) == len(disk.vertices_yx) + len(disk.triangles) - 1  # Euler
    with pytest.raises(ParameterError, match=r"triangles must have shape \(N, 3\)"):
        draw_mesh(ax, disk.vertices_yx, disk.triangles[:, :2])


def test_distortion_is_centred_on_zero(ax: Axes, disk: DiskMap) -> None:
    drawn = draw_area_distortion(ax, disk)
    low, high = drawn.get_clim()
    assert low == -high
    assert high == distortion_limit(disk.distortion)
    assert len(drawn.get_paths()) == len(disk.triangles)
    assert np.allclose(2.0 ** np.asarray(drawn.get_array()), disk.distortion.triangle_area_ratio)
    assert drawn.get_label() == "disk area / cell area, log2"


def test_distortion_takes_a_limit(disk: DiskMap) -> None:
    assert draw_area_distortion(Figure().add_subplot(), disk, limit=2.0).get_clim() == (-2.0, 2.0)
    with pytest.raises(ParameterError, match=r"limit.*0"):
        draw_area_distortion(Figure().add_subplot(), disk, limit=0)
