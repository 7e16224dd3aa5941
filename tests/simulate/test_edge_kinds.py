"""Movies whose edge is known exactly, for the velocity of the edge and for a still interior."""

import numpy as np
import pytest
import shapely

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.geometry.polygon import edge_lengths, signed_area
from cytodisk.simulate import EDGE_KINDS, MOVIE_KINDS, SimulatedMovie, movie
from cytodisk.simulate.drawing import coverage, half_covered
from cytodisk.simulate.movie_kinds import MovieKind


def polar(shown: SimulatedMovie, frame: int) -> tuple[FloatArray, FloatArray]:
    """Angle and distance of the boundary points from where the boundary's centroid is in frame 0."""
    centre = np.array(shapely.Polygon(shown.boundary_yx[0]).centroid.coords[0])
    y, x = (shown.boundary_yx[frame] - centre).T
    return np.arctan2(y, x), np.hypot(y, x)


@pytest.mark.parametrize("corner", [(3.0, 2.0), (-6.3, -4.1), (15.2, 20.7)])
def test_coverage_is_the_area_of_each_pixel_inside(corner: tuple[float, float]) -> None:
    random = np.random.default_rng(2)
    angle = np.linspace(0.0, 2.0 * np.pi, 40, endpoint=False)
    reach = 9.0 * (1.0 + 0.2 * random.normal(size=40))
    outline = np.column_stack([reach * np.sin(angle), reach * np.cos(angle)]) + 9.0 + np.array(corner)
    polygon = shapely.Polygon(outline)
    row, column = np.indices((25, 30))
    pixels = shapely.box(row - 0.5, column - 0.5, row + 0.5, column + 0.5)
    expected = shapely.area(shapely.intersection(polygon, pixels))
    np.testing.assert_allclose(coverage(outline, (25, 30)), expected, atol=1e-12)
    np.testing.assert_allclose(coverage(outline[::-1], (25, 30)), expected, atol=1e-12)
    np.testing.assert_array_equal(half_covered(outline, (25, 30)), coverage(outline, (25, 30)) >= 0.5)


@pytest.mark.parametrize("kind", [*EDGE_KINDS, "turning", "bulging"])
def test_velocity_times_length_is_the_change_of_area(kind: MovieKind) -> None:
    shown = movie(kind, 3, frames=8, radius_px=30.0, signals=False)
    length = np.stack([edge_lengths(outline) for outline in shown.boundary_yx])
    swept = (shown.velocity_px[:-1] * 0.5 * (length[1:] + length[:-1])).sum(axis=1)
    area = [signed_area(outline) for outline in shown.boundary_yx]
    np.testing.assert_allclose(swept, np.diff(area), atol=1e-7)
    assert np.isnan(shown.velocity_px[-1]).all()


@pytest.mark.parametrize("turn", [5.0, 10.0])
def test_a_cell_that_turns_has_velocity_without_bias(turn: float) -> None:
    shown = movie("turning", 1, frames=5, turn_deg=turn, signals=False)
    assert abs(shown.velocity_px[:-1].mean()) < 1e-6
    assert shown.normal_displacement_px[:-1].mean() < -0.1  # along the first frame's normal it has one


def test_a_filopodium_keeps_its_width_and_its_tip_runs_at_its_speed() -> None:
    shown = movie("filopodium", 4, frames=16, radius_px=35.0, signals=False)
    area = [shapely.Polygon(outline).area for outline in shown.boundary_yx]
    np.testing.assert_allclose(np.diff(area), 5.0 * 4.0, atol=1e-3)
    np.testing.assert_allclose(shown.velocity_px[:-1].max(axis=1), 4.0, atol=2e-3)
    assert (np.abs(shown.velocity_px[:-1]) < 1e-6).mean() > 0.8  # the disk and the sides stand
    last = shapely.Polygon(shown.boundary_yx[-1])
    body = shapely.Point(last.buffer(-10.0).centroid).buffer(36.0)
    rest = last.difference(body)
    assert rest.area / 5.0 == pytest.approx(60.0, abs=2.0)
    assert rest.buffer(-2.4).area > 0.0
    assert rest.buffer(-2.51).is_empty


@pytest.mark.parametrize("heading", [0.0, 90.0, -135.0])
def test_a_filopodium_grows_in_the_direction_that_is_told(heading: float) -> None:
    shown = movie("filopodium", 4, frames=3, radius_px=20.0, heading_deg=heading, signals=False)
    step = shown.boundary_yx[1] - shown.boundary_yx[0]
    tip = step[np.hypot(*step.T).argmax()]
    grown = np.degrees(np.arctan2(*tip))
    assert (grown - heading + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize(("waves", "height"), [(None, 6.0), (5, 3.0)])
def test_waves_travel_around_a_round_cell_at_five_degrees_a_frame(waves: int | None, height: float) -> None:
    options = {} if waves is None else {"waves": waves}
    shown = movie("waving", 2, frames=20, protrusion_px=height, signals=False, **options)
    phase = []
    for frame in range(20):
        angle, reach = polar(shown, frame)
        order = np.argsort(angle)
        waved = np.interp(
            np.linspace(-np.pi, np.pi, 720, endpoint=False), angle[order], reach[order], period=2 * np.pi
        )
        spectrum = np.fft.rfft(waved) / 360.0
        assert np.abs(spectrum[1:]).argmax() + 1 == (waves or 3)
        assert np.abs(spectrum[waves or 3]) == pytest.approx(height, rel=0.01)
        phase.append(np.angle(spectrum[waves or 3]) / (waves or 3))
    turn = np.degrees(np.diff(np.unwrap(phase, period=2.0 * np.pi / (waves or 3))))
    np.testing.assert_allclose(np.abs(turn), 5.0, atol=0.02)
    assert np.ptp([signed_area(outline) for outline in shown.boundary_yx]) < 0.1


@pytest.mark.parametrize("count", [2, 4, 5])
def test_lobes_stand_and_change_sign(count: int) -> None:
    shown = movie("lobes", 1, frames=21, waves=count, signals=False)
    centred = []
    for frame in range(21):
        angle, reach = polar(shown, frame)
        centred.append(2.0 * np.mean((reach - 45.0) * np.exp(-1j * count * angle)))
    heights = np.array(centred) / centred[int(np.abs(centred).argmax())]
    np.testing.assert_allclose(heights.imag, 0.0, atol=0.05)
    assert heights.real.min() < -0.9
    assert heights.real.max() == 1.0
    np.testing.assert_allclose(shown.boundary_yx[20], shown.boundary_yx[0], atol=1e-2)  # one period


def test_lobes_are_drawn_among_symmetric_ones() -> None:
    drawn = set()
    for seed in range(12):
        angle, reach = polar(movie("lobes", seed, frames=12, signals=False), 5)
        heights = [abs(np.mean((reach - 45.0) * np.exp(-1j * k * angle))) for k in range(2, 7)]
        drawn.add(2 + int(np.argmax(heights)))
    assert drawn == {2, 4, 5}


def test_a_lamellipodium_grows_on_one_side_over_an_inside_that_stands() -> None:
    shown = movie("lamellipodium", 5, frames=21, radius_px=35.0, signals=False)
    assert (shown.interior_yx == shown.interior_yx[0]).all()
    moved = np.hypot(*np.moveaxis(shown.boundary_yx[-1] - shown.boundary_yx[0], -1, 0))
    assert moved.max() == pytest.approx(30.0, abs=1e-3)
    assert (moved < 0.1).mean() > 0.4
    assert shown.velocity_px[:-1].max() == pytest.approx(1.5, abs=0.01)


def test_the_material_channel_stands_where_matter_stands() -> None:
    shown = movie("lamellipodium", 5, frames=6, radius_px=20.0)
    assert shown.truth is not None
    counts = shown.truth.sel(channel="material").to_numpy()
    always = shown.masks.all(axis=0)
    np.testing.assert_allclose(counts[-1][always], counts[0][always], rtol=1e-9)


def test_jitter_is_correlated_over_its_length() -> None:
    ragged = []
    for length in (1.5, 30.0):
        masks = movie("still", 1, frames=12, jitter_px=1.0, jitter_length_px=length, signals=False).masks
        sides = sum(np.count_nonzero(np.diff(masks, axis=axis)) for axis in (1, 2))
        ragged.append(sides / len(masks))
    assert ragged[0] > 1.1 * ragged[1]


@pytest.mark.parametrize("kind", [kind for kind in MOVIE_KINDS if kind not in ("waving", "lobes")])
def test_waves_are_refused_for_kinds_that_have_none(kind: MovieKind) -> None:
    with pytest.raises(ParameterError, match=f"kind {kind!r} has no waves, got waves=3"):
        movie(kind, waves=3)
