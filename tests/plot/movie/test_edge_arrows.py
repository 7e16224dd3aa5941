from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.motion.contour import Contour
from cytodisk.motion.disk_movie import DiskMovie, FrameRecord
from cytodisk.motion.tracking import TrackedBoundary
from cytodisk.plot.movie.edge_arrows import draw_velocity_arrows
from cytodisk.plot.style import INWARD_COLOUR, OUTWARD_COLOUR
from cytodisk.scale import Scale


@pytest.fixture
def circle() -> FloatArray:
    """40 unit normals, (row, column), from +x towards +y."""
    angle = np.linspace(0.0, 2.0 * np.pi, 40, endpoint=False)
    return np.column_stack([np.sin(angle), np.cos(angle)])


def _movie(*outlines: FloatArray, height: int = 100) -> DiskMovie:
    """Frames whose tracked points are the points of an outline."""

    def record(time: int, points: FloatArray) -> FrameRecord:
        contour = Contour(points, points)
        return FrameRecord("ok", "", lambda: TrackedBoundary(time, contour, contour.arc[:-1]))

    records = tuple(record(time, points) for time, points in enumerate(outlines))
    return DiskMovie(records, (height, 100), Scale(), lambda _: pytest.fail("no map is needed"))


def _arrows(ax: Axes, normals: FloatArray, moved: FloatArray, **options: Any) -> Any:
    """A disk of radius 20 px whose points move along their normals."""
    points = 50.0 + 20.0 * normals
    return draw_velocity_arrows(ax, _movie(points, points + moved[:, None] * normals), 0, **options)


def test_arrows_have_the_colour_of_their_direction(ax: Axes, circle: FloatArray) -> None:
    moved = np.where(np.arange(40) < 20, 2.0, -1.0)
    arrows = _arrows(ax, circle, moved, every=4)
    assert arrows.N == 10
    colours = [tuple(colour) for colour in arrows.get_facecolors()]
    assert colours == [to_rgba(OUTWARD_COLOUR)] * 5 + [to_rgba(INWARD_COLOUR)] * 5


@pytest.mark.parametrize("along", ["path", "normal"])
def test_arrows_end_on_the_next_outline(ax: Axes, circle: FloatArray, along: str) -> None:
    arrows = _arrows(ax, circle, np.full(40, 2.0), every=1, along=along)
    tips = arrows.get_offsets() + np.column_stack([arrows.U, arrows.V]) / arrows.scale
    assert np.hypot(*(tips - 50.0).T) == pytest.approx(np.full(40, 22.0), abs=0.02)


def test_arrows_along_the_normal_leave_sliding_out(ax: Axes, circle: FloatArray) -> None:
    points = 50.0 + 20.0 * circle
    turn = np.radians(2.0)
    slid = 50.0 + 20.0 * circle @ np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    path = draw_velocity_arrows(ax, _movie(points, slid), 0)
    normal = draw_velocity_arrows(ax, _movie(points, slid), 0, along="normal")
    assert np.hypot(path.U, path.V).min() > 0.6
    assert np.hypot(normal.U, normal.V).max() < 0.02


def test_points_on_the_border_have_no_arrow(ax: Axes, circle: FloatArray) -> None:
    points = 50.0 + 20.0 * circle
    cut = int(points[:, 0].max()) + 1  # the lowest point lies on the image's border
    arrows = draw_velocity_arrows(ax, _movie(points, points + circle, height=cut), 0, every=1)
    assert 30 < arrows.N < 40


def test_scale_is_told(ax: Axes, circle: FloatArray) -> None:
    _arrows(ax, circle, np.full(40, 2.0), scale=Scale(0.5), stretch=3.0)
    words = [text.get_text() for text in ax.texts] + [key.text.get_text() for key in _keys(ax)]
    assert words == ["5 µm", "1 µm per frame\n(arrows 3 times as long)"]


def test_small_steps_are_stretched_on_request(ax: Axes, circle: FloatArray) -> None:
    arrows = _arrows(ax, circle, np.full(40, 0.1), stretch=None)
    assert 1.0 / arrows.scale == pytest.approx(50.0)
    assert 2.0 < 0.1 / arrows.scale < 6.1


def _keys(ax: Axes) -> list[Any]:
    return [artist for artist in ax.get_children() if type(artist).__name__ == "QuiverKey"]


def test_a_still_edge_has_no_key(ax: Axes, circle: FloatArray) -> None:
    _arrows(ax, circle, np.zeros(40), stretch=None)
    assert not _keys(ax)


def test_arrows_refuse(ax: Axes, circle: FloatArray) -> None:
    for options, message in (
        ({"every": 0}, "every must be a whole number of at least 1, got 0"),
        ({"stretch": 0.0}, "stretch must be a positive number"),
        ({"along": "edge"}, "along must be one of path, normal"),
    ):
        with pytest.raises(ParameterError, match=message):
            _arrows(ax, circle, np.ones(40), **options)
    with pytest.raises(ParameterError, match="frame 1 or the next has no map"):
        draw_velocity_arrows(ax, _movie(circle, circle), 1)
