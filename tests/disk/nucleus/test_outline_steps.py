"""The energy of the nuclear outline's steps, and what it adds to the system of a step."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cytodisk.arrays import FloatArray
from cytodisk.disk.nucleus.cone import TURN
from cytodisk.disk.nucleus.outline_steps import add_loop, loop_energy

N, WEIGHT = 7, 0.3


@pytest.fixture
def share() -> FloatArray:
    lengths = np.random.default_rng(1).uniform(0.5, 2.0, N)
    return np.asarray(lengths / lengths.sum())


@pytest.fixture
def angles(share: FloatArray) -> FloatArray:
    uneven = share * np.random.default_rng(2).uniform(0.5, 2.0, N)
    return np.asarray(1.0 + TURN * np.append(0.0, np.cumsum(uneven)[:-1]) / uneven.sum())


def residuals(angles: FloatArray, share: FloatArray) -> FloatArray:
    """Plain twin: one a step, 0 where it has its share of the turn."""
    steps = np.diff(angles, append=angles[0] + TURN)
    x = np.tan(0.5 * steps) / np.tan(0.5 * TURN * share)
    return np.asarray(np.sqrt(WEIGHT * share) * (np.sqrt(x) - 1.0 / np.sqrt(x)))


def slopes(angles: FloatArray, share: FloatArray, h: float = 1e-6) -> FloatArray:
    """Derivatives of the residuals by each angle, (N, N), by central differences."""
    steps = h * np.eye(N)
    there = [residuals(angles + step, share) - residuals(angles - step, share) for step in steps]
    return np.array(there).T / (2.0 * h)


def test_it_is_the_sum_of_squares_and_0_where_steps_are_as_long_as_the_outline_s(
    angles: FloatArray, share: FloatArray
) -> None:
    assert loop_energy(angles, share, WEIGHT) == pytest.approx(np.square(residuals(angles, share)).sum())
    even = TURN * np.append(0.0, np.cumsum(share)[:-1])
    assert loop_energy(even, share, WEIGHT) == pytest.approx(0.0, abs=1e-14)


def test_whole_turns_are_nothing(angles: FloatArray, share: FloatArray) -> None:
    turned = angles + TURN * np.arange(-3, N - 3)
    assert loop_energy(turned, share, WEIGHT) == pytest.approx(loop_energy(angles, share, WEIGHT))


def test_half_a_turn_and_two_at_one_angle_cost_without_bound(share: FloatArray) -> None:
    half = np.array([0.0, np.pi, *np.linspace(3.5, 6.0, N - 2)])
    assert loop_energy(half, share, WEIGHT) == np.inf
    assert loop_energy(np.array([0.0, 1.0, 1.0, 2.0, 3.0, 4.0, 5.0]), share, WEIGHT) == np.inf
    near = [loop_energy(np.array([0.0, gap, 2, 3, 4, 5, 6]), share, WEIGHT) for gap in (0.1, 1e-3, 1e-6)]
    assert near[0] < near[1] < near[2]


def test_gradient_and_curvature_agree_with_finite_differences(angles: FloatArray, share: FloatArray) -> None:
    diagonal, pair = np.arange(N), N + np.arange(N)
    blocks, right = np.zeros((2 * N, 3, 3)), np.zeros((N, 3))
    add_loop(angles, share, WEIGHT, np.arange(N), pair, diagonal, blocks, right)
    by_angle = slopes(angles, share)
    assert_allclose(right[:, 0], -2.0 * by_angle.T @ residuals(angles, share), atol=1e-7)
    matrix = np.diag(blocks[diagonal, 0, 0])
    for n in range(N):
        m = (n + 1) % N
        matrix[n, m] = matrix[m, n] = blocks[pair[n], 0, 0]
    assert_allclose(matrix, 2.0 * by_angle.T @ by_angle, atol=1e-6)
    assert (right[:, 1:] == 0.0).all()
    assert (blocks[:, 1:] == 0.0).all()
