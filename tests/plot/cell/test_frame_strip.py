import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError, SignalError
from cytodisk.plot.cell.frame_strip import draw_strip
from cytodisk.plot.cell.sector_marks import sector_arcs, sector_colours
from cytodisk.plot.field_of_view import field_of_view
from cytodisk.scale import Scale
from cytodisk.windows.polar_windows import CellWindows


@pytest.fixture
def axes() -> list[Axes]:
    return list(Figure().subplots(1, 3))


def test_outermost_windows_have_the_colours_of_their_sectors(axes: list[Axes], windows: CellWindows) -> None:
    drawn = draw_strip(axes, [windows] * 3, ["0 s", "5 s", "10 s"], scale=Scale(0.5))
    assert [ax.get_title() for ax in axes] == ["0 s", "5 s", "10 s"]
    for polygons in drawn:
        faces = np.asarray(polygons.get_facecolors())
        assert np.allclose(faces[:8], sector_colours(8))
        assert not faces[8:, 3].any()
    words = [{text.get_text() for text in ax.texts} for ax in axes]
    assert words == [{"5 µm"}, set(), {"○ sector 0"}]


def test_frames_have_one_field_of_view(axes: list[Axes], windows: CellWindows) -> None:
    draw_strip(axes, [windows] * 3, [""] * 3, extent_yx=(1.0, 49.0, -5.0, 91.0))
    assert {ax.get_xlim() for ax in axes} == {(-5.0, 91.0)}
    assert {ax.get_ylim() for ax in axes} == {(49.0, 1.0)}
    assert {ax.get_aspect() for ax in axes} == {1.0}


def test_over_a_signal_the_edge_has_the_colours(
    axes: list[Axes], windows: CellWindows, image: FloatArray
) -> None:
    drawn = draw_strip(axes, [windows] * 3, [""] * 3, signal=[image, 2 * image, image])
    assert not np.asarray(drawn[0].get_facecolors())[:, 3].any()
    (edge,) = (artist for artist in axes[0].collections if isinstance(artist, LineCollection))
    assert np.allclose(edge.get_colors(), sector_colours(8))
    assert len({ax.images[0].get_clim() for ax in axes}) == 1
    assert axes[0].images[0].get_clim()[1] > image[windows.mask].max()


def test_ring_lies_in_sector_0(ax: Axes, windows: CellWindows) -> None:
    draw_strip([ax], [windows], [""])
    (ring,) = (line for line in ax.lines if line.get_marker() == "o")
    place = np.array([[ring.get_ydata()[0], ring.get_xdata()[0]]])
    uv = windows.disk.to_disk(place, outside="nearest")
    assert windows.grid.window_of(uv).tolist() == [0]


def test_arcs_make_up_the_outline(windows: CellWindows) -> None:
    arcs = sector_arcs(windows)
    assert len(arcs) == 8
    for arc, following in zip(arcs, arcs[1:] + arcs[:1], strict=True):
        assert np.allclose(arc[-1], following[0])
    steps = np.diff(windows.disk.outline_yx, axis=0, append=windows.disk.outline_yx[:1])
    length = sum(np.hypot(*np.diff(arc, axis=0).T).sum() for arc in arcs)
    assert length == pytest.approx(np.hypot(*steps.T).sum())


def test_colours_are_cyclic() -> None:
    colours = sector_colours(36)[:, :3]
    steps = np.linalg.norm(np.diff(colours, axis=0, append=colours[:1]), axis=1)
    assert steps.max() < 0.2
    assert len(np.unique(colours.round(3), axis=0)) == 36


def test_field_of_view_holds_every_outline() -> None:
    first, second = np.array([[0.0, 0.0], [10.0, 5.0]]), np.array([[20.0, -30.0], [np.nan, np.nan]])
    top, bottom, left, right = field_of_view([first, second])
    assert (top, bottom, left, right) == pytest.approx((-1.4, 21.4, -31.4, 6.4))


def test_strip_refuses(axes: list[Axes], windows: CellWindows) -> None:
    with pytest.raises(ParameterError, match="windows has 2 frames"):
        draw_strip(axes, [windows] * 2, [""] * 3)
    with pytest.raises(ParameterError, match="windows has 0 frames"):
        draw_strip([], [], [])
    with pytest.raises(SignalError, match=r"\(3, 3\).*\(50, 90\)"):
        draw_strip(axes, [windows] * 3, [""] * 3, signal=[np.ones((3, 3))] * 3)
