"""Surrogates of a source: products by Fourier are those of the shifted source itself."""

import numpy as np
import pytest

from cytodisk.analysis.prediction.chance_gains import chance_gains, split_source
from cytodisk.analysis.prediction.lagged_design import rows_with_past
from cytodisk.analysis.prediction.layer_series import LayerSeries
from cytodisk.analysis.prediction.pooled_autoregression import Held, explained
from cytodisk.analysis.prediction.predict import predict
from cytodisk.analysis.prediction.prediction_orders import Orders
from cytodisk.analysis.prediction.source_scales import Scales
from cytodisk.analysis.prediction.source_shifts import ShiftedSource, Shifts, circle_of
from cytodisk.errors import ParameterError

FRAMES, SECTORS, PAST = 30, 4, 3


def shifted(source: np.ndarray, frames: int, sectors: int) -> np.ndarray:
    """Lags 1 to 3 of a source on a circle, 0 where they hold both its ends or none, shape (T, S, 3)."""
    length = len(source)
    circle = np.concatenate([source, np.full((circle_of(length) - length, source.shape[1]), np.nan)])
    past = np.stack([np.roll(circle, lag, axis=0) for lag in range(1, PAST + 1)], axis=-1)
    past[1:PAST] = np.nan  # frame 0 sees the last ones alone
    past[np.isnan(past).any(axis=-1)] = 0.0
    return np.roll(past, (frames, sectors), axis=(0, 1))[:length]


@pytest.mark.parametrize("frames", [FRAMES, FRAMES + 1])  # the circle is as long, or longer
def test_products_are_those_of_the_shifted_columns(frames: int) -> None:
    random = np.random.default_rng(0)
    source, table = random.normal(size=(frames, SECTORS)), random.normal(size=(frames, SECTORS, 2))
    used = random.random((frames, SECTORS)) < 0.8
    table[~used] = 0.0
    shifts = Shifts(np.array([5, 17, 0]), np.array([1, 3, 0]))
    scales = Scales(random.uniform(0.5, 2.0, frames), random.uniform(0.1, 3.0, SECTORS))
    run = ShiftedSource(source, used, PAST, shifts, scales)
    with_columns, with_itself = run.products(table)
    for place, (later, around) in enumerate(zip(shifts.frames, shifts.sectors, strict=True)):
        moved = shifted(source / scales.table, later, around) * scales.table[..., None]
        columns = np.where(used[..., None], moved, 0.0)
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


def test_one_frame_of_past_on_a_circle_as_long_as_the_movie_tears_no_row() -> None:
    source = np.random.default_rng(8).normal(size=(FRAMES, SECTORS))
    used = np.ones(source.shape, dtype=bool)
    run = ShiftedSource(source, used, 1, Shifts(np.array([4]), np.array([1])), Scales.alike(*source.shape))
    with_columns, with_itself = run.products(source[..., None])
    moved = np.roll(source, (5, 1), axis=(0, 1))
    assert with_columns.item() == pytest.approx(np.sum(moved * source))
    assert with_itself.item() == pytest.approx(np.sum((moved - moved.mean(axis=0)) ** 2))


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
    target[-1] = np.nan
    series = LayerSeries(target, source, (np.roll(target, 1, axis=1),), (other,), turns=True)
    orders = Orders(2, 1, PAST)
    rows = rows_with_past(series, PAST)
    held = Held.of(series, rows, orders)
    gains = chance_gains(held, series, orders, PAST, None, count=40, seed=0)
    followed, rest = split_source(series, orders, PAST)
    shifts = Shifts.drawn(circle_of(FRAMES), SECTORS, PAST, 40, 0)
    scale = Scales.of(rest, rest != 0.0, 0.5 * PAST).table
    own = [target[rows.frame - lag, rows.sector] for lag in (1, 2)]
    beside = [np.roll(target, 1, axis=1)[rows.frame - lag, rows.sector] for lag in (1, 2)]
    means = np.eye(SECTORS)[rows.sector]
    held_columns = np.column_stack([*own, *beside, other[rows.frame - 1, rows.sector], means])
    wanted = target[rows.frame, rows.sector]
    kept = np.stack([followed[rows.frame - lag, rows.sector] for lag in range(1, PAST + 1)], axis=-1)
    for gain, frames, sectors in zip(gains, shifts.frames, shifts.sectors, strict=True):
        moved = shifted(rest / scale, frames, sectors) * scale[..., None]
        columns = kept + moved[rows.frame, rows.sector]
        before = np.linalg.lstsq(held_columns, wanted, rcond=None)[1].item()
        after = np.linalg.lstsq(np.column_stack([held_columns, columns]), wanted, rcond=None)[1].item()
        assert gain == pytest.approx(np.log(before / after), abs=1e-10)


def test_half_of_the_surrogates_of_one_sector_run_backwards_in_time() -> None:
    target, source = np.random.default_rng(8).normal(size=(2, 40, 1))
    series, orders = LayerSeries(target, source, (), (), turns=True), Orders(2, 0, PAST)
    rows = rows_with_past(series, PAST)
    held = Held.of(series, rows, orders)
    gains = chance_gains(held, series, orders, PAST, None, count=20, seed=0)
    scale = Scales.of(source - source.mean(), np.ones(source.shape, dtype=bool), 0.5 * PAST).table
    rest = (source - source.mean()) / scale
    forth, back = Shifts.drawn(40, 1, PAST, 20, 0), Shifts.drawn(40, 1, 1, 10, 1)
    assert len(gains) == 20
    for gain, place in ((gains[9], 9), (gains[10], 0), (gains[19], 9)):
        one, by = (rest, forth) if gain == gains[9] else (rest[::-1], back)
        columns = (shifted(one, by.frames[place], 0) * scale[..., None])[rows.frame, rows.sector]
        columns = columns - columns.mean(axis=0)
        columns -= held.basis @ (held.basis.T @ columns)
        left = np.linalg.lstsq(columns, held.left, rcond=None)[1].item()
        assert gain == pytest.approx(np.log(held.residual / left), abs=1e-10)
    many = chance_gains(held, series, orders, PAST, None, count=999, seed=0)
    assert len(many) == 40 - 2 * PAST + 1 + 39


def test_the_source_is_the_sum_of_what_others_say_and_the_rest() -> None:
    random = np.random.default_rng(4)
    target, source = random.normal(size=(2, 300, SECTORS))
    source[1:] += 2.0 * target[:-1]
    followed, rest = split_source(LayerSeries(target, source, (), (), True), Orders(2, 0, 1), PAST)
    np.testing.assert_allclose(rest.mean(axis=0), 0.0, atol=1e-12)
    both = followed + rest
    np.testing.assert_allclose(both - both.mean(axis=0), source - source.mean(axis=0), atol=1e-12)
    np.testing.assert_allclose(
        followed[2:] - followed[2:].mean(axis=0), 2.0 * (target[1:-1] - target[1:-1].mean(axis=0)), atol=0.3
    )


def test_slow_series_that_know_nothing_of_each_other_stay_whole() -> None:
    slow = np.random.default_rng(6).normal(size=(2, 400, 1))
    for frame in range(1, 400):
        slow[:, frame] += 0.95 * slow[:, frame - 1]
    followed, rest = split_source(LayerSeries(slow[0], slow[1], (), (), False), Orders(1, 0, 1), PAST)
    assert not followed.any()
    np.testing.assert_allclose(rest, slow[1] - slow[1].mean(axis=0))


def test_gaps_that_leave_surrogates_too_few_rows_are_refused() -> None:
    source, target = np.random.default_rng(7).normal(size=(2, 40, SECTORS))
    source[::7], target[::7] = np.nan, np.nan  # six on end: enough for the model, not for white series
    found = predict(source, target, order=2, source_order=PAST, surrogates=0)
    assert np.isfinite(found["gain"])
    with pytest.raises(ParameterError, match=r"gaps leave 2\d rows.*fill in short gaps.*surrogates=0"):
        predict(source, target, order=2, source_order=PAST, surrogates=99)
