import numpy as np
import pytest
from matplotlib.axes import Axes

from cytodisk.arrays import FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import SignalError, WindowError
from cytodisk.plot.cell.disk_axes import (
    disk_polygons,
    draw_disk_image,
    draw_disk_means,
    draw_disk_mesh,
    draw_disk_windows,
)
from cytodisk.windows.polar_windows import PolarGrid, polar_windows


def test_image_is_not_mirrored(ax: Axes, image: FloatArray, disk: DiskMap) -> None:
    """Signal grows along x, so it grows along u; u goes right and v down."""
    drawn = draw_disk_image(ax, disk, image, size=64)
    values = np.ma.filled(np.ma.asarray(drawn.get_array()).astype(float), np.nan)
    assert np.nanmean(values[:, 40:]) > np.nanmean(values[:, :24])
    assert list(drawn.get_extent()) == [-1, 1, 1, -1]
    assert ax.get_xlim()[0] < ax.get_xlim()[1]
    assert ax.get_ylim()[0] > ax.get_ylim()[1]
    assert ax.get_aspect() == 1.0


def test_image_refuses_another_shape(ax: Axes, disk: DiskMap) -> None:
    with pytest.raises(SignalError, match="signal has shape"):
        draw_disk_image(ax, disk, np.ones((3, 3)))


def test_angles_go_clockwise_on_the_page(ax: Axes) -> None:
    draw_disk_windows(ax, polar_windows(2, 4))
    places = {text.get_text(): text.get_position() for text in ax.texts}
    assert set(places) == {"0°", "90°", "180°", "270°"}
    assert places["0°"][0] > 1
    assert places["90°"][1] > 1


@pytest.mark.parametrize("grid", [polar_windows(3, 8), polar_windows(1, 1), polar_windows(4, 100, "radius")])
def test_polygons_hold_their_windows_centre(grid: PolarGrid) -> None:
    polygons = disk_polygons(grid)
    assert len(polygons) == grid.n_windows
    area = sum(0.5 * abs(p[:, 0] @ np.roll(p[:, 1], -1) - p[:, 1] @ np.roll(p[:, 0], -1)) for p in polygons)
    assert area == pytest.approx(np.pi, rel=1e-3)
    if grid.sectors > 1:
        centres = np.stack([polygon.mean(axis=0) for polygon in polygons])
        assert np.array_equal(
            grid.window_of(centres) % grid.sectors, np.arange(grid.n_windows) % grid.sectors
        )


def test_means_keep_their_window(ax: Axes) -> None:
    values = np.arange(24.0).reshape(3, 8)
    drawn = draw_disk_means(ax, polar_windows(3, 8), values)
    assert np.array_equal(np.asarray(drawn.get_array()), values.ravel())
    with pytest.raises(WindowError, match=r"values.*\(24,\).*\(3, 8\)"):
        draw_disk_means(ax, polar_windows(3, 8), values.ravel())


def test_layers_have_their_colours(ax: Axes) -> None:
    drawn = draw_disk_windows(ax, polar_windows(3, 8), by_layer=True)
    assert np.array_equal(np.asarray(drawn.get_array()), np.repeat([0, 1, 2], 8))


def test_mesh_lies_as_u_right_v_down(ax: Axes, disk: DiskMap) -> None:
    points = np.concatenate(draw_disk_mesh(ax, disk).get_segments())
    assert np.array_equal(np.unique(points, axis=0), np.unique(disk.vertices_uv, axis=0))
