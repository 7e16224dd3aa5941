"""What explains power without a wave."""

import numpy as np
from numpy.testing import assert_allclose

from cytodisk.analysis.waves.wave_background import background, edge_groups

FREQUENCIES = np.linspace(0.01, 0.06, 24)
GROUPS = edge_groups(4)
COLUMN = np.array([0, 1, 2, 3, 4, 1, 2, 3, 4])
NOISE = np.random.default_rng(0).exponential(size=(24, 9, 2))


def test_excess_does_not_know_how_much_power_a_period_or_a_mode_has() -> None:
    plain = background(NOISE, FREQUENCIES, GROUPS)
    period = FREQUENCIES[:, None, None] ** -1.5 * np.exp(np.sin(np.arange(24.0)))[:, None, None]
    mode = np.exp(-0.4 * COLUMN)[:, None]
    shaped = background(NOISE * period * mode, FREQUENCIES, GROUPS)
    assert_allclose(np.exp(shaped.excess), np.exp(plain.excess), atol=0.02)
    assert_allclose(shaped.usual, plain.usual * period * mode, rtol=0.02)


def test_background_is_the_mean_of_noise_and_one_wave_hardly_moves_it() -> None:
    plain = background(NOISE, FREQUENCIES, GROUPS)
    assert_allclose(np.minimum(np.exp(plain.excess), 4.0).mean(), 1.0 - np.exp(-4.0), atol=0.01)
    waved = NOISE.copy()
    waved[10, 2] = 1000.0
    moved = background(waved, FREQUENCIES, GROUPS).usual[10, 2] / plain.usual[10, 2]
    assert (moved < 2.5).all()
    assert_allclose(background(waved, FREQUENCIES, GROUPS).usual[20], plain.usual[20], rtol=0.3)
