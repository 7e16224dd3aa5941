from itertools import pairwise

import numpy as np
import pytest
from curves import circle, evenly, exact, lobed, moved, smooth_curves
from hypothesis import given, settings
from hypothesis import strategies as st

from cytodisk.motion.cyclic_path import cyclic_path

STEPS = [(1, 1), (1, 2), (2, 1), (2, 3), (3, 2), (1, 3), (3, 1), (1, 4), (4, 1), (1, 6), (6, 1)]


def step_cost(before: np.ndarray, after: np.ndarray, length: float, smoothness: float) -> float:
    """Simpson's rule, exact for the square of a displacement that is linear in between."""
    middle = 0.5 * (before + after)
    size = (before @ before + 4.0 * middle @ middle + after @ after) / 6.0
    return float(size * length + smoothness * (after - before) @ (after - before) / length)


def path_cost(
    here: np.ndarray, there: np.ndarray, pairs: list[tuple[int, int]], spacing: float, smoothness: float
) -> float:
    total = 0.0
    for (i0, j0), (i1, j1) in pairwise(pairs):
        before, after = (there[j % len(there)] - here[i % len(here)] for i, j in ((i0, j0), (i1, j1)))
        total += step_cost(before, after, 0.5 * (i1 - i0 + j1 - j0) * spacing, smoothness)
    return total


def cheapest_from(
    here: np.ndarray, there: np.ndarray, j0: int, i0: int, spacing: float, smoothness: float
) -> float:
    """Plain twin: one turn from the pair (i0, j0) over all pairs, without a band."""
    n, m = len(here), len(there)
    best = {(0, 0): 0.0}

    def d(i: int, j: int) -> np.ndarray:
        return there[(j0 + j) % m] - here[(i0 + i) % n]

    for i in range(1, n + 1):
        for j in range(1, m + 1):
            costs = [
                best[i - a, j - b] + step_cost(d(i - a, j - b), d(i, j), 0.5 * (a + b) * spacing, smoothness)
                for a, b in STEPS
                if (i - a, j - b) in best
            ]
            if costs:
                best[i, j] = min(costs)
    return best[n, m]


def closed(i: np.ndarray, j: np.ndarray, n: int, m: int) -> list[tuple[int, int]]:
    return [*zip(i.tolist(), j.tolist(), strict=True), (int(i[0]) + n, int(j[0]) + m)]


def assert_one_turn(i: np.ndarray, j: np.ndarray, n: int, m: int) -> None:
    pairs = closed(i, j, n, m)
    steps = [(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(pairs)]
    assert set(steps) <= set(STEPS)


def samples(points: np.ndarray, n: int) -> np.ndarray:
    contour = exact(points)
    return contour.at(evenly(contour, n))


@settings(max_examples=15)
@given(
    smooth_curves(0.1), smooth_curves(0.1), st.integers(12, 18), st.integers(12, 18), st.floats(1.0, 200.0)
)
def test_the_path_is_as_cheap_as_the_plain_twin(
    first: np.ndarray, second: np.ndarray, n: int, m: int, smoothness: float
) -> None:
    here, there, spacing = samples(first, n), samples(second, m), 15.0
    i, j = cyclic_path(here, there, spacing, smoothness)
    assert_one_turn(i, j, n, m)
    ours = path_cost(here, there, closed(i, j, n, m), spacing, smoothness)
    twin = cheapest_from(here, there, int(j[0]), int(i[0]), spacing, smoothness)
    assert ours == pytest.approx(twin, rel=1e-9)


@settings(max_examples=5)
@given(smooth_curves(0.1), smooth_curves(0.1))
def test_no_other_cut_gives_a_cheaper_turn(first: np.ndarray, second: np.ndarray) -> None:
    here, there, spacing = samples(first, 10), samples(second, 11), 25.0
    i, j = cyclic_path(here, there, spacing, 64.0)
    ours = path_cost(here, there, closed(i, j, 10, 11), spacing, 64.0)
    best = min(cheapest_from(here, there, start, 0, spacing, 64.0) for start in range(11))
    assert ours <= best * (1.0 + 1e-9)


@given(smooth_curves(0.15), smooth_curves(0.15), st.integers(8, 60), st.integers(8, 60))
def test_both_index_lists_increase_through_one_turn(
    first: np.ndarray, second: np.ndarray, n: int, m: int
) -> None:
    m = min(max(m, n // 4), 4 * n)
    i, j = cyclic_path(samples(first, n), samples(second, m), 5.0, 64.0)
    assert_one_turn(i, j, n, m)


@pytest.mark.parametrize("n", [8, 64, 128])
def test_a_curve_is_paired_with_itself_point_by_point(n: int) -> None:
    here = samples(lobed(), n)
    i, j = cyclic_path(here, here, 2.0, 64.0)
    np.testing.assert_array_equal(i, i[0] + np.arange(n))
    np.testing.assert_array_equal(np.mod(j - i, n), 0)


@pytest.mark.parametrize("start", [1, 37, 64, 127])
def test_the_first_sample_may_lie_anywhere(start: int) -> None:
    here = samples(lobed(), 128)
    i, j = cyclic_path(here, np.roll(here, start, axis=0), 2.0, 64.0)
    np.testing.assert_array_equal(i, i[0] + np.arange(128))
    np.testing.assert_array_equal(np.mod(j - i, 128), start)


def test_a_short_way_through_is_taken_on_a_curve_with_fewer_samples() -> None:
    here, there = samples(circle(40.0), 60), samples(circle(40.0), 30)
    i, j = cyclic_path(here, there, 6.0, 64.0)
    assert_one_turn(i, j, 60, 30)
    np.testing.assert_array_equal(i, 2 * j + i[0] - 2 * j[0])
    np.testing.assert_array_equal(np.mod(i - 2 * j, 60), 0)


def test_a_small_turn_leaves_the_pairs_close() -> None:
    points = lobed()
    here, there = samples(points, 128), samples(moved(points, 4.0, (1.0, -1.0)), 128)
    i, j = cyclic_path(here, there, 2.0, 64.0)
    assert np.abs(np.mod(j - i + 64, 128) - 64).max() <= 2
