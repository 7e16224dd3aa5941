"""Surrogates of a source: products by Fourier are those of the shifted source itself."""

import numpy as np
import pytest

from cytodisk.analysis.prediction.chance_gains import chance_gains, memory, split_source
from cytodisk.analysis.prediction.lagged_design import rows_with_past
from cytodisk.analysis.prediction.layer_series import LayerSeries
from cytodisk.analysis.prediction.pooled_autoregression import Held, explained
from cytodisk.analysis.prediction.prediction_orders import Orders
from cytodisk.analysis.prediction.source_shifts import ShiftedSource, Shifts

FRAMES, SECTORS, PAST = 30, 4, 3


def shifted(source: np.ndarray, frames: int, sectors: int) -> np.ndarray:
    """Lags 1 to 3 of a source on a circle with three empty frames, shape (T, S, 3)."""
    circle = np.concatenate([source, np.zeros((PAST, SECTORS))])
    moved = np.roll(circle, (frames, sectors), axis=(0, 1))
    return np.stack([np.roll(moved, lag, axis=0)[:FRAMES] for lag in range(1, PAST + 1)], axis=-1)


def test_products_are_those_of_the_shifted_columns() -> None:
    random = np.random.default_rng(0)
    source, table = random.normal(size=(FRAMES, SECTORS)), random.normal(size=(FRAMES, SECTORS, 2))
    used = random.random((FRAMES, SECTORS)) < 0.8
    table[~used] = 0.0
    shifts = Shifts(np.array([5, 17, 0]), np.array([1, 3, 0]))
    run = ShiftedSource(source, used, PAST, shifts)
    with_columns, with_itself = run.with_columns(table), run.with_itself()
    for place, (frames, sectors) in enumerate(zip(shifts.frames, shifts.sectors, strict=True)):
        columns = np.where(used[..., None], shifted(source, frames, sectors), 0.0)
        centred = columns - np.where(used[..., None], columns.sum(axis=0) / used.sum(axis=0)[:, None], 0.0)
        np.testing.assert_allclose(with_columns[place], np.einsum("tsq,tsk->qk", columns, table), atol=1e-12)
        np.testing.assert_allclose(with_itself[place], np.einsum("tsq,tsk->qk", centred, centred), atol=1e-12)


@pytest.mark.parametrize("turns", [True, False])
def test_shifts_keep_their_distance_and_none_comes_twice(turns: bool) -> None:
    around = 6 if turns else 1
    shifts = Shifts.drawn(50, around, 10, 1000, 0)
    pairs = set(zip(shifts.frames.tolist(), shifts.sectors.tolist(), strict=True))
    assert len(pairs) == len(shifts.frames) == 31 * around
    assert shifts.frames.min() == 10
    assert shifts.frames.max() == 40


def test_explained_squares_are_those_of_nested_regressions() -> None:
    random = np.random.default_rng(1)
    columns, target = random.normal(size=(20, 3)), random.normal(size=20)
    columns[:, 1] = 2.0 * columns[:, 0]  # adds nothing
    found = explained((columns.T @ columns)[None], (columns.T @ target)[None])[0]
    for count in range(1, 4):
        fit = columns[:, :count] @ np.linalg.lstsq(columns[:, :count], target, rcond=None)[0]
        assert found[count - 1] == pytest.approx(fit @ fit)


def test_a_surrogate_is_the_model_with_the_shifted_rest() -> None:
    random = np.random.default_rng(3)
    target, source, other = random.normal(size=(3, FRAMES, SECTORS))
    source[1:] += target[:-1]
    source[7, 2] = np.nan
    series = LayerSeries(target, source, (np.roll(target, 1, axis=1),), (other,), turns=True)
    orders = Orders(2, 1, PAST)
    rows = rows_with_past(series, PAST)
    held = Held.of(series, rows, orders)
    gains = chance_gains(held, series, orders, PAST, None, count=40, seed=0)
    followed, rest = split_source(series, orders)
    least = min(PAST + memory(rest), (FRAMES + PAST) // 4)
    shifts = Shifts.drawn(FRAMES + PAST, SECTORS, least, 40, 0)
    own = [target[rows.frame - lag, rows.sector] for lag in (1, 2)]
    beside = [np.roll(target, 1, axis=1)[rows.frame - lag, rows.sector] for lag in (1, 2)]
    means = np.eye(SECTORS)[rows.sector]
    held_columns = np.column_stack([*own, *beside, other[rows.frame - 1, rows.sector], means])
    wanted = target[rows.frame, rows.sector]
    kept = np.stack([followed[rows.frame - lag, rows.sector] for lag in range(1, PAST + 1)], axis=-1)
    for gain, frames, sectors in zip(gains, shifts.frames, shifts.sectors, strict=True):
        columns = kept + shifted(rest, frames, sectors)[rows.frame, rows.sector]
        before = np.linalg.lstsq(held_columns, wanted, rcond=None)[1].item()
        after = np.linalg.lstsq(np.column_stack([held_columns, columns]), wanted, rcond=None)[1].item()
        assert gain == pytest.approx(np.log(before / after), abs=1e-10)


def test_the_source_is_the_sum_of_both_its_parts() -> None:
    random = np.random.default_rng(4)
    target, source = random.normal(size=(2, FRAMES, SECTORS))
    source[1:] += target[:-1]
    followed, rest = split_source(LayerSeries(target, source, (), (), True), Orders(2, 0, 1))
    np.testing.assert_allclose(followed + rest, source - source.mean(axis=0), atol=1e-12)
    assert rest[2:].var() < 0.8 * source.var()
    assert abs(np.mean(rest[2:] * target[1:-1])) < 0.02


def test_memory_is_the_lag_at_which_little_is_left() -> None:
    slow = np.zeros((400, 30))
    noise = np.random.default_rng(6).normal(size=slow.shape)
    for frame in range(1, 400):
        slow[frame] = 0.9 * slow[frame - 1] + noise[frame]
    assert 7 <= memory(slow) <= 11  # 0.9 ** 9.5 is 1/e
    assert memory(noise) == 1
