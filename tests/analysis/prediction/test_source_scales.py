"""What surrogates keep in its place: how much a source varies, by sector and by time."""

import numpy as np
import pytest

import cytodisk as cd
from cytodisk.analysis.prediction.source_scales import Scales

FRAMES, SECTORS = 200, 12


def test_scales_are_those_of_sectors_and_of_slow_changes() -> None:
    wanted = (1.0 + 0.9 * np.sin(np.arange(FRAMES) / 16.0))[:, None] * np.linspace(1.0, 5.0, SECTORS)
    source = np.random.default_rng(0).normal(size=wanted.shape) * wanted
    known = np.ones(source.shape, dtype=bool)
    source[50:55, 3], known[50:55, 3] = 0.0, False
    found = Scales.of(source, known, 2.0).table
    assert np.corrcoef(found.ravel(), wanted.ravel())[0, 1] > 0.95
    assert (source / found)[known].std() == pytest.approx(np.sqrt(np.pi / 2.0), rel=0.05)


def test_what_is_still_is_not_blown_up() -> None:
    source = np.zeros((FRAMES, 3))
    source[:60, 0] = np.random.default_rng(1).normal(size=60)
    found = Scales.of(source, np.ones(source.shape, dtype=bool), 2.0).table
    assert found.min() > 0
    assert np.abs(source / found).max() < 20
    np.testing.assert_array_equal(Scales.of(0.0 * source, source == 7, 2.0).table, 1.0)


def test_a_front_that_varies_more_in_both_signals_predicts_nothing() -> None:
    random = np.random.default_rng(2)
    front = np.exp(1.5 * np.cos(2.0 * np.pi * np.arange(SECTORS) / SECTORS))
    how = {"surrogates": 19, "max_order": 1, "neighbours": False}
    found = [cd.predict(*(random.normal(size=(2, 40, SECTORS)) * front), **how) for _ in range(15)]
    by_chance = np.mean([one["gain_null"].mean().item() for one in found])
    assert np.mean([one["gain"].item() for one in found]) < 1.7 * by_chance  # 2.6 if scales shifted, too
