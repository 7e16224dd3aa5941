"""A cell with its nucleus, in cell and disk."""

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.patches import Circle, Polygon

from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.mapping import map_to_disk
from cytodisk.errors import ParameterError
from cytodisk.plot.cell.cell_axes import draw_cell, draw_nucleus, draw_outline
from cytodisk.plot.cell.disk_axes import draw_disk_image, draw_disk_means, draw_disk_mesh, draw_disk_windows
from cytodisk.plot.cell.mesh_curves import mesh_curves
from cytodisk.plot.cell.sector_marks import draw_sectors, nucleus_arcs, sector_colours
from cytodisk.plot.cell.window_polygons import draw_windows
from cytodisk.plot.layer_looks import NUCLEUS_LINE, layer_fills
from cytodisk.simulate.cells import disk as round_cell
from cytodisk.windows.polar_windows import CellWindows


def test_both_outlines_are_drawn(ax: Axes, nucleus_disk: DiskMap) -> None:
    cell = draw_outline(ax, nucleus_disk)
    loops = [artist for artist in ax.get_children() if isinstance(artist, Polygon)]
    assert len(loops) == 2
    assert len(cell.get_xy()) == len(nucleus_disk.outline_yx) + 1  # the first point again
    draw_cell(ax, np.ones(nucleus_disk.mask.shape), nucleus_disk)
    assert sum(isinstance(artist, Polygon) for artist in ax.get_children()) == 4


def test_a_nucleus_that_is_not_there(ax: Axes) -> None:
    with pytest.raises(ParameterError, match="pass nucleus to map_to_disk"):
        draw_nucleus(ax, map_to_disk(round_cell(8)))


def test_windows_of_the_nucleus_have_another_hue(ax: Axes, nucleus_windows: CellWindows) -> None:
    grid = nucleus_windows.grid
    lines = draw_windows(ax, nucleus_windows).get_edgecolor()
    assert (lines[: 4 * 12] == to_rgba("white")).all()
    assert (lines[4 * 12 :] == to_rgba(NUCLEUS_LINE)).all()
    filled = draw_windows(ax, nucleus_windows, by_layer=True)
    shown = filled.to_rgba(np.arange(grid.layers))
    assert shown == pytest.approx(layer_fills(6, 2), abs=1e-6)
    red, blue = shown[:, 0], shown[:, 2]
    assert (red[:4] > blue[:4]).all()
    assert (red[4:] < blue[4:]).all()


def _radii(ax: Axes) -> list[float]:
    return sorted({float(patch.get_radius()) for patch in ax.patches if isinstance(patch, Circle)})


def test_the_disk_has_the_nuclear_circle(
    ax: Axes, nucleus_disk: DiskMap, nucleus_windows: CellWindows
) -> None:
    for draw in (
        lambda: draw_disk_windows(ax, nucleus_windows.grid),
        lambda: draw_disk_means(ax, nucleus_windows.grid, nucleus_windows.areas),
        lambda: draw_disk_mesh(ax, nucleus_disk),
        lambda: draw_disk_image(ax, nucleus_disk, np.ones(nucleus_disk.mask.shape)),
    ):
        ax.clear()
        draw()
        assert _radii(ax) == [0.5, 1.0]


def test_edges_of_the_mesh_lie_where_the_map_puts_them(nucleus_disk: DiskMap) -> None:
    """Straight edges of the cell, carried to the disk point by point, are the curves that are drawn."""
    nucleus = nucleus_disk.nucleus
    assert nucleus is not None
    curves = mesh_curves(nucleus_disk, nucleus)
    triangles = nucleus_disk.triangles
    sides = np.sort(
        np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1
    )
    assert len(curves) == len(np.unique(sides, axis=0))
    bent = [curve for curve in curves if len(curve) > 6]
    assert bent
    for curve in [*bent, *curves[::50]]:
        inner = curve[1:-1]
        there = nucleus_disk.to_cell(0.999999 * curve if len(inner) == 0 else inner)
        ends = there[0], there[-1]
        along = np.linspace(0.0, 1.0, len(there))[:, None]
        straight = ends[0] + along * (ends[1] - ends[0])
        assert np.abs(there - straight).max() < 1e-5


def test_sectors_are_marked_on_the_nucleus(ax: Axes, nucleus_windows: CellWindows) -> None:
    faces = draw_sectors(ax, nucleus_windows).get_facecolor()
    colours = sector_colours(12)
    assert np.asarray(faces[:12]) == pytest.approx(colours)
    assert np.asarray(faces[48:60]) == pytest.approx(colours)
    assert (np.asarray(faces)[12:48, 3] == 0).all()
    arcs = nucleus_arcs(nucleus_windows)
    assert len(arcs) == 12
    angles = [np.arctan2(*nucleus_windows.disk.to_disk(arc[1:-1]).T[::-1]) % (2 * np.pi) for arc in arcs]
    for sector, found in enumerate(angles):
        assert (found * 12 / (2 * np.pi) > sector - 1e-6).all()
        assert (found * 12 / (2 * np.pi) < sector + 1 + 1e-6).all()
