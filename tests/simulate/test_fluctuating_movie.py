import hashlib
from functools import cache

import numpy as np
import pytest
import shapely
from scipy.spatial import cKDTree

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.errors import ParameterError
from cytodisk.simulate import SimulatedMovie, movie
from cytodisk.simulate.coupling import TRANSITION_POINTS, coupled_stretch
from cytodisk.simulate.fluctuation import random_fluctuation
from cytodisk.simulate.movie_kinds import HABITS, MovieKind
from cytodisk.simulate.movie_plans import plan_movie
from cytodisk.simulate.paths import paths


@cache
def long_movie() -> SimulatedMovie:
    return movie("fluctuating", 0, frames=400, signals=False)


@cache
def coupled_movie(lag: int) -> SimulatedMovie:
    return movie("fluctuating", 3, frames=80, radius_px=30.0, protrusion_px=9.0, coupled=0.4, lag_frames=lag)


def sector_velocity(shown: SimulatedMovie, sectors: int = 60) -> FloatArray:
    steps = shown.normal_displacement_px[:-1]
    return np.asarray(steps.reshape(len(steps), sectors, -1).mean(axis=2))


@cache
def edge_signal(lag: int) -> list[tuple[FloatArray, IntArray]]:
    """Velocity that the outermost pixels' expected signal stands for, and their boundary points, by frame."""
    shown = coupled_movie(lag)
    assert shown.truth is not None
    found = []
    for mask, outline, counts in zip(
        shown.masks, shown.boundary_yx, shown.truth.sel(channel="edge").to_numpy(), strict=True
    ):
        pixels = np.argwhere(mask)
        depth, nearest = cKDTree(outline, leafsize=64, compact_nodes=False, balanced_tree=False).query(pixels)
        at_edge = (counts[mask] - 20.0) * np.exp(depth / 5.0)
        found.append(((at_edge[depth < 1.5] - 500.0) / 80.0, nearest[depth < 1.5]))
    return found


def edge_and_velocity(lag: int, coupled: float, shift: int) -> FloatArray:
    """Velocity read from the edge signal where coupling is as told, and the true one a shift earlier."""
    shown, pairs = coupled_movie(lag), []
    for frame in range(10, len(shown.masks) - 10):
        values, nearest = edge_signal(lag)[frame]
        used = shown.coupled[nearest] == coupled
        pairs.append([values[used], shown.normal_displacement_px[frame - shift, nearest[used]]])
    return np.concatenate(pairs, axis=1)


def correlation(pairs: FloatArray) -> float:
    return float(np.corrcoef(pairs)[0, 1])


@pytest.mark.slow
def test_a_fluctuating_cell_stays_simple_for_400_frames() -> None:
    shown = long_movie()
    assert shapely.is_valid(shapely.polygons(shown.boundary_yx)).all()
    areas = shapely.area(shapely.polygons(shown.boundary_yx))
    assert areas.min() / (np.pi * 45.0**2) > 0.7
    assert areas.max() / (np.pi * 45.0**2) < 1.4


@pytest.mark.parametrize("options", [{"radius_px": 10.0}, {"protrusion_px": 60.0}])
def test_no_size_or_height_makes_a_fluctuating_edge_cross_itself(options: dict[str, float]) -> None:
    shown = movie("fluctuating", 1, frames=30, signals=False, **options)  # type: ignore[arg-type]
    assert shapely.is_valid(shapely.polygons(shown.boundary_yx)).all()


def test_the_height_of_protrusions_scales_the_velocity() -> None:
    still, half, full = (
        movie("fluctuating", 1, frames=30, protrusion_px=height, signals=False).normal_displacement_px[:-1]
        for height in (0.0, 2.0, 4.0)
    )
    assert not still.any()
    assert full.std() == pytest.approx(2.0 * half.std(), rel=0.05)


def test_the_velocity_is_stationary_and_forgets_itself_without_a_period() -> None:
    velocity = sector_velocity(long_movie())
    assert 0.7 < velocity.std() < 1.0
    assert velocity.std(axis=0).min() > 0.65
    assert velocity.std(axis=0).max() < 1.05
    assert velocity[:200].std() == pytest.approx(velocity[200:].std(), rel=0.05)
    ahead = [np.mean(velocity[:-lag] * velocity[lag:]) / velocity.var() for lag in range(1, 41)]
    assert ahead[0] > 0.7
    assert np.abs(ahead[2:]).max() < 0.2
    assert np.abs(ahead[20:]).max() < 0.1


def test_neighbours_move_together_and_places_far_apart_do_not() -> None:
    together = np.corrcoef(sector_velocity(long_movie()).T)
    along = np.array([np.diagonal(np.roll(together, -apart, axis=1)).mean() for apart in (1, 3, 10, 30)])
    assert along[0] > 0.9
    assert 0.4 < along[1] < 0.7
    assert np.abs(along[2:]).max() < 0.1


def test_the_rate_is_the_change_of_the_level_and_the_deviation_is_as_told() -> None:
    pushes = random_fluctuation(np.random.default_rng(1), np.linspace(-3.0, 3.0, 40), 5.0)
    for frame in (-20.0, 0.0, 399.7):
        change = (pushes.level(frame + 1e-4) - pushes.level(frame - 1e-4)) / 2e-4
        np.testing.assert_allclose(pushes.rate(frame), change, atol=1e-6)
    levels = np.array([pushes.level(frame) for frame in range(-2000, 2000)])
    np.testing.assert_allclose(levels.std(axis=0), 5.0, rtol=0.1)


def test_the_edge_is_where_its_closed_form_says_forwards_and_backwards() -> None:
    plan = plan_movie("fluctuating", np.random.default_rng(4), 45.0, HABITS["fluctuating"])
    boundary = paths(plan, -25, 26, interior=False).boundary_yx
    in_cell = np.stack([plan.pose.to_cell(edge, frame) for frame, edge in enumerate(boundary, -25)])
    angle, radius = np.arctan2(in_cell[..., 0], in_cell[..., 1]), np.hypot(*np.moveaxis(in_cell, -1, 0))
    np.testing.assert_allclose(angle, np.tile(angle[25], (51, 1)), atol=1e-9)
    pushes = plan.flow.fluctuation
    expected = [pushes(angle[25], pushes.level(frame) - pushes.level(0.0)) for frame in range(-25, 26)]
    np.testing.assert_allclose(radius - radius[25], expected, atol=2e-3)


def test_fluctuating_cells_take_every_option() -> None:
    options = {"speed_px": 1.0, "turn_deg": 2.0, "jitter_px": 0.5, "dropped": 0.2, "protrusion_px": 6.0}
    first, again = (
        movie("fluctuating", 2, frames=10, coupled=0.5, **options)  # type: ignore[arg-type]
        for _ in range(2)
    )
    assert (~first.present).sum() == 2
    assert first.signal is not None
    assert first.signal.identical(again.signal)
    np.testing.assert_array_equal(first.masks, again.masks)
    np.testing.assert_array_equal(first.coupled, again.coupled)
    travelled = np.hypot(*(first.boundary_yx[-1].mean(axis=0) - first.boundary_yx[0].mean(axis=0)))
    assert travelled == pytest.approx(9.0, abs=1.5)


def test_lag_and_coupling_leave_the_motion_as_it_is() -> None:
    plain = movie("fluctuating", 5, frames=6, signals=False)
    for options in ({"lag_frames": 7}, {"lag_frames": -5}, {"coupled": 0.0}, {"coupled": 0.3}):
        other = movie("fluctuating", 5, frames=6, **options)  # type: ignore[arg-type]
        np.testing.assert_array_equal(other.boundary_yx, plain.boundary_yx)
        np.testing.assert_array_equal(other.masks, plain.masks)


@pytest.mark.parametrize("lag", [4, -3])
def test_a_plain_correlation_finds_the_coupled_stretch_and_its_lag(lag: int) -> None:
    coupled = {shift: correlation(edge_and_velocity(lag, 1.0, shift)) for shift in range(-8, 9)}
    assert max(coupled, key=coupled.__getitem__) == lag
    assert coupled[lag] > 0.9999
    assert all(abs(found) < 0.3 for shift, found in coupled.items() if abs(shift - lag) >= 3)
    # Ten pushes that remember 2.6 frames: 60 frames are about 200 independent pairs, four deviations 0.3.
    apart = [correlation(edge_and_velocity(lag, 0.0, shift)) for shift in range(-8, 9)]
    assert np.abs(apart).max() < 0.3


def test_the_uncoupled_signal_has_the_statistics_of_the_coupled_one() -> None:
    inside, outside = (edge_and_velocity(4, value, 4)[0] for value in (1.0, 0.0))
    assert outside.std() == pytest.approx(inside.std(), rel=0.15)
    assert abs(outside.mean() - inside.mean()) < 0.1


@pytest.mark.parametrize("share", [0.0, 0.002, 0.25, 0.5, 0.996, 1.0])
@pytest.mark.parametrize("seed", range(3))
def test_one_smooth_stretch_of_the_edge_is_coupled(share: float, seed: int) -> None:
    coupled = coupled_stretch(share, np.random.default_rng(seed))
    assert coupled.mean() == pytest.approx(share, abs=1e-3)
    assert coupled.min() >= 0.0
    assert coupled.max() <= 1.0
    steps = np.diff(coupled, append=coupled[:1])
    assert np.count_nonzero(np.diff(np.sign(steps[steps != 0.0]))) <= 2
    assert np.count_nonzero((coupled > 0.0) & (coupled < 1.0)) <= 2 * TRANSITION_POINTS
    if 0.1 < share < 0.9:
        assert np.abs(steps).max() < 2.0 / TRANSITION_POINTS


def test_stretches_start_elsewhere_in_other_movies() -> None:
    starts = {
        int(movie("still", seed, frames=2, coupled=0.3, signals=False).coupled.argmax()) for seed in range(5)
    }
    assert len(starts) == 5


@pytest.mark.parametrize(
    ("kind", "seed", "options", "expected"),
    [
        ("bulging", 0, {}, "8cdbf716953bf4fc47bbbca8ab04e3df076f10126b84b5fd3d8353b7f90b7fad"),
        (
            "migrating",
            3,
            {"lag_frames": -2, "jitter_px": 0.5, "dropped": 0.2},
            "9ba516fd264b7582e0ab81316bb64abf704e2241cf0eb4babaf7380926011fb1",
        ),
    ],
)
def test_movies_are_those_of_the_first_release(
    kind: MovieKind, seed: int, options: dict[str, float], expected: str
) -> None:
    """Made before edges could be coupled along a part; rounded, so that no machine's last bit counts."""
    shown = movie(kind, seed, frames=6, coupled=1.0, **options)  # type: ignore[arg-type]
    assert shown.signal is not None
    content = hashlib.sha256()
    edge = np.rint(shown.boundary_yx * 1e4).astype(np.int64)
    for array in (shown.masks, shown.present, shown.signal.to_numpy(), edge):
        content.update(np.ascontiguousarray(array).tobytes())
    assert content.hexdigest() == expected
    assert (shown.coupled == 1.0).all()


@pytest.mark.parametrize("coupled", [-0.1, 1.5, np.nan, "half", True])
def test_bad_shares_are_named(coupled: object) -> None:
    with pytest.raises(ParameterError, match="coupled"):
        movie("fluctuating", coupled=coupled)  # type: ignore[arg-type]
