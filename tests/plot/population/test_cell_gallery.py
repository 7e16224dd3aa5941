import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.mapping import map_to_disk
from cytodisk.errors import ParameterError
from cytodisk.plot.population.cell_gallery import BEYOND_NAME, draw_gallery, draw_window_gallery
from cytodisk.simulate.cells import disk as round_cell
from cytodisk.windows.polar_windows import polar_windows


@pytest.fixture(scope="module")
def disks() -> list[DiskMap]:
    return [map_to_disk(round_cell(8)), map_to_disk(round_cell(14))]


def test_cells_have_one_scale_and_the_same_colours(disks: list[DiskMap]) -> None:
    axes = Figure().subplots(1, 2)
    images = [np.full(disk.mask.shape, value) for disk, value in zip(disks, (1.0, 3.0), strict=True)]
    drawn = draw_gallery(axes, disks, images, names=["a", "b $"])
    assert drawn[0].get_clim() == drawn[1].get_clim()
    fields = [float(np.ptp(ax.get_xlim())) for ax in axes]
    assert fields[0] == pytest.approx(fields[1])
    assert fields[0] > 28.0
    assert [ax.get_title() for ax in axes] == ["a", "b $"]
    assert [sum("px" in text.get_text() for text in ax.texts) for ax in axes] == [1, 0]  # one bar for all
    assert any(isinstance(patch, Rectangle) and patch.get_gid() == BEYOND_NAME for patch in axes[0].patches)


def test_pixel_sizes_may_differ() -> None:
    disks = [map_to_disk(round_cell(10), pixel_size_um=size) for size in (0.2, 0.4)]
    axes = Figure().subplots(1, 2)
    draw_gallery(axes, disks, [np.ones(disk.mask.shape) for disk in disks])
    fields = [float(np.ptp(ax.get_xlim())) * size for ax, size in zip(axes, (0.2, 0.4), strict=True)]
    assert fields[0] == pytest.approx(fields[1])


def test_windows_in_the_place_of_images(disks: list[DiskMap]) -> None:
    windows = [polar_windows(2, 6).on(disk) for disk in disks]
    axes = Figure().subplots(1, 2)
    drawn = draw_window_gallery(axes, windows, [np.zeros((2, 6)), np.ones((2, 6))])
    assert drawn[0].get_clim() == drawn[1].get_clim()
    with pytest.raises(ParameterError, match="2 axes, 2 cells and 1 values"):
        draw_window_gallery(axes, windows, [np.zeros((2, 6))])
