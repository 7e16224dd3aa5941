from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from scipy.stats import binom

from cytodisk.analysis.event_average import average_around
from cytodisk.analysis.events import edge_events
from cytodisk.errors import ParameterError

NAN = np.nan


def by_sector(values: Any, units: str = "px/frame") -> xr.DataArray:
    table = np.asarray(values, dtype=np.float64)
    coords = {"frame": ("time", np.arange(len(table))), "sector": np.arange(table.shape[1])}
    return xr.DataArray(table, coords, ("time", "sector"), attrs={"units": units})


def pulses(onsets: dict[int, list[int]], frames: int = 20, sectors: int = 8, length: int = 2) -> xr.DataArray:
    """Velocity 1 for so many frames from each onset on, by sector; else 0."""
    values = np.zeros((frames, sectors))
    for sector, starts in onsets.items():
        for start in starts:
            values[start : start + length, sector] = 1.0
    return by_sector(values)


def events_of(velocity: xr.DataArray) -> pd.DataFrame:
    return edge_events(velocity, threshold=0.5)


def test_the_velocity_around_its_own_onsets() -> None:
    velocity = pulses({0: [5, 12], 3: [8], 5: [6, 13]})
    average = average_around(velocity, events_of(velocity), before=3, after=4)
    assert average["mean"].dims == ("delay",)
    assert average["delay"].to_numpy().tolist() == [-3, -2, -1, 0, 1, 2, 3, 4]
    assert average["mean"].to_numpy().tolist() == [0, 0, 0, 1, 1, 0, 0, 0]
    assert set(average["n"].to_numpy()) == set(average["n_patches"].to_numpy()) == {5}
    np.testing.assert_array_equal(average["lower"], average["mean"])  # all alike: no spread
    np.testing.assert_array_equal(average["upper"], average["mean"])
    assert average["mean"].attrs["units"] == "px/frame"
    assert "delay_s" not in average.coords


@pytest.mark.parametrize(("at", "zero"), [("onset", 6), ("peak", 7), ("end", 9)])
def test_moments(at: Any, zero: int) -> None:
    values = np.zeros((20, 1))
    values[6:9, 0] = [1.0, 3.0, 2.0]
    events = events_of(by_sector(values))
    number = by_sector(np.arange(20.0)[:, None], "a.u.")
    average = average_around(number, events, before=1, after=1, at=at)
    assert average["mean"].to_numpy().tolist() == [zero - 1, zero, zero + 1]


def test_layers_channels_and_seconds() -> None:
    velocity = pulses({2: [5], 6: [7]})
    random = np.random.default_rng(0)
    values = random.normal(size=(20, 2, 3, 8))
    activity = xr.DataArray(
        values,
        {"frame": ("time", np.arange(20)), "channel": ["a", "b"], "time_s": ("time", 1.5 * np.arange(20))},
        ("time", "channel", "layer", "sector"),
    )
    average = average_around(activity, events_of(velocity), before=2, after=1)
    assert average["mean"].dims == ("channel", "layer", "delay")
    assert average["delay_s"].to_numpy().tolist() == [-3.0, -1.5, 0.0, 1.5]
    assert average["channel"].to_numpy().tolist() == ["a", "b"]
    expected = 0.5 * (values[3:7, ..., 2] + values[5:9, ..., 6])
    np.testing.assert_allclose(average["mean"], np.moveaxis(expected, 0, -1))
    turned = average_around(
        activity.transpose("sector", "layer", "time", "channel"), events_of(velocity), before=2, after=1
    )
    np.testing.assert_array_equal(turned["mean"].transpose(*average["mean"].dims), average["mean"])


def test_what_is_missing_does_not_count() -> None:
    velocity = pulses({1: [1], 4: [10], 6: [17]})
    signal = by_sector(np.broadcast_to(np.arange(8.0), (20, 8)).copy(), "a.u.")
    signal[9, 4] = NAN
    average = average_around(signal, events_of(velocity), before=2, after=3)
    # Sector 1 begins in frame 1, sector 6 has its end in 19: they reach beyond the movie.
    assert average["n"].to_numpy().tolist() == [2, 2, 3, 3, 3, 2]
    assert average["mean"].to_numpy().tolist() == [5.0, 3.5, 11 / 3, 11 / 3, 11 / 3, 2.5]
    assert average["n_patches"].to_numpy().tolist() == [2, 2, 3, 3, 3, 2]


def test_only_moments_that_are_known() -> None:
    velocity = pulses({0: [0], 2: [8], 4: [18]})
    events = events_of(velocity)
    counted = {
        at: int(average_around(velocity, events, before=0, after=0, at=at)["n"][0])
        for at in ("onset", "peak", "end")
    }
    assert counted == {"onset": 2, "peak": 1, "end": 2}
    assert int(average_around(-velocity, events_of(-velocity), before=0, after=0)["n"][0]) == 0
    back = average_around(-velocity, events_of(-velocity), before=0, after=0, kind="retraction")
    assert back["mean"].to_numpy().tolist() == [-1.0]


def test_no_events_give_nan() -> None:
    velocity = pulses({})
    average = average_around(velocity, events_of(velocity), before=1, after=2)
    assert np.isnan(average[["mean", "lower", "upper"]].to_array()).all()
    assert not average["n"].any()
    assert average["n"].dtype == np.int64


def test_windows_lose_their_own_mean_and_size() -> None:
    velocity = pulses({0: [5], 3: [9], 5: [12]})
    wave = np.sin(np.arange(20.0))[:, None]
    signal = by_sector(wave * [1, 0, 0, 7, 0, 0, 0, 0] + [100, 0, 0, -30, 0, 5, 0, 0], "a.u.")
    events = events_of(velocity)
    plain = average_around(signal, events, before=3, after=3, normalise="mean")
    windows = np.array([wave[2:9, 0], 7 * wave[6:13, 0], np.zeros(7)])
    windows -= windows.mean(axis=1, keepdims=True)
    np.testing.assert_allclose(plain["mean"], windows.mean(axis=0), atol=1e-12)
    assert plain["mean"].attrs["units"] == "a.u."
    scaled = average_around(signal, events, before=3, after=3, normalise="sd")
    parts = windows[:2] / windows[:2].std(axis=1, keepdims=True)  # the third does not vary
    np.testing.assert_allclose(scaled["mean"], parts.mean(axis=0), atol=1e-12)
    assert set(scaled["n"].to_numpy()) == {2}
    assert scaled["mean"].attrs["units"] == "1"


def test_own_means_are_those_of_what_is_there() -> None:
    velocity = pulses({0: [1]})
    signal = by_sector(np.broadcast_to(np.arange(20.0)[:, None], (20, 8)), "a.u.")
    average = average_around(signal, events_of(velocity), before=2, after=2, normalise="mean")
    np.testing.assert_array_equal(average["mean"], [NAN, -1.5, -0.5, 0.5, 1.5])


def test_whole_patches_are_drawn() -> None:
    """Ten sectors that see one event are one event: they do not make the band narrower."""
    starts = range(0, 100, 20)
    alone = pulses({start: [5] for start in starts}, sectors=100)
    together = pulses({s: [5] for start in starts for s in range(start, start + 10)}, sectors=100)
    signal = by_sector(np.repeat([[1.0, 4.0, 2.0, 2.0, 3.0]], 20, axis=0).repeat(20, axis=1), "a.u.")
    one, many = (
        average_around(signal, events_of(v), before=0, after=0, confidence=0.999) for v in (alone, together)
    )
    assert (int(one["n"][0]), int(many["n"][0]), int(many["n_patches"][0])) == (5, 50, 5)
    for name in ("mean", "lower", "upper"):
        np.testing.assert_allclose(one[name], many[name])
    means = 1.0, 2.4, 4.0
    assert means[0] <= float(one["lower"][0]) < means[1] < float(one["upper"][0]) <= means[2]


@pytest.mark.parametrize("patches", [1, 2, 4, 5])
def test_few_patches_have_no_band(patches: int) -> None:
    velocity = pulses({s: [5] for start in range(patches) for s in (4 * start, 4 * start + 1)}, sectors=24)
    average = average_around(velocity, events_of(velocity), before=1, after=1)
    assert set(average["n_patches"].to_numpy()) == {patches}
    assert np.isfinite(average["mean"]).all()
    for name in ("lower", "upper"):
        assert np.isfinite(average[name]).to_numpy().tolist() == [patches == 5] * 3


def test_the_band_ends_where_patches_become_few() -> None:
    """Two of six events begin too early to be seen three frames before."""
    starts = [2, 2, 5, 8, 11, 14]
    velocity = pulses({2 * place: [start] for place, start in enumerate(starts)}, sectors=12)
    average = average_around(velocity, events_of(velocity), before=3, after=1)
    assert average["n_patches"].to_numpy().tolist() == [4, 6, 6, 6, 6]
    assert np.isnan(average["upper"]).to_numpy().tolist() == [True, False, False, False, False]


def test_without_draws_there_is_no_band() -> None:
    velocity = pulses({s: [5] for s in range(0, 12, 2)}, sectors=12)
    average = average_around(velocity, events_of(velocity), before=1, after=1, bootstrap=0)
    assert np.isfinite(average["mean"]).all()
    assert np.isnan(average["lower"]).all()


def test_draws_depend_on_the_seed_alone() -> None:
    velocity = pulses({s: [5] for s in range(0, 40, 2)}, sectors=40)
    signal = by_sector(np.random.default_rng(0).normal(size=(20, 40)), "a.u.")
    first, again, other = (
        average_around(signal, events_of(velocity), before=2, after=2, seed=seed) for seed in (1, 1, 2)
    )
    assert first.identical(again)
    assert not np.array_equal(first["lower"], other["lower"])


@pytest.mark.parametrize(
    ("patches", "confidence", "share"),
    [(5, 0.8, 0.8), (5, 0.95, 0.915), (10, 0.8, 0.8), (10, 0.95, 0.95), (30, 0.8, 0.8), (30, 0.95, 0.95)],
)
def test_the_band_holds_the_true_mean_as_often_as_it_says(
    patches: int, confidence: float, share: float
) -> None:
    """Independent experiments, a hundred at a time as layers: each has patches of two sectors."""
    rounds, at_once, sectors = 20, 100, 3 * patches
    velocity = pulses({s: [2] for s in range(sectors) if s % 3 < 2}, frames=6, sectors=sectors)
    events = events_of(velocity)
    random = np.random.default_rng(7)
    held = 0
    for seed in range(rounds):
        common = random.normal(3.0, 1.0, (at_once, patches)).repeat(3, axis=1)
        values = common + random.normal(0.0, 0.3, (at_once, sectors))
        signal = xr.DataArray(np.broadcast_to(values, (6, *values.shape)), dims=("time", "layer", "sector"))
        average = average_around(
            signal, events, before=0, after=0, bootstrap=1000, seed=seed, confidence=confidence
        )
        assert set(average["n_patches"].to_numpy().ravel()) == {patches}
        held += int(((average["lower"] <= 3.0) & (average["upper"] >= 3.0)).sum())
    low, high = binom.ppf([0.0005, 0.9995], rounds * at_once, share)
    assert low <= held <= high


GOOD = pulses({1: [5], 4: [6]})
EVENTS = events_of(GOOD)


@pytest.mark.parametrize(
    ("activity", "events", "options", "message"),
    [
        (GOOD.to_numpy(), EVENTS, {}, "activity must be a DataArray .* got ndarray"),
        (GOOD.rename(sector="point"), EVENTS, {}, "got .'time', 'point'"),
        (GOOD.astype(str), EVENTS, {}, "must hold numbers"),
        (GOOD.isel(time=[0, 2, 3]), EVENTS, {}, "follow each other"),
        (GOOD, "events", {}, "table of edge_events, got str"),
        (GOOD, EVENTS.drop(columns="patch"), {}, "table of edge_events"),
        (GOOD.isel(sector=slice(4)), EVENTS, {}, "of 8 sectors, activity of 4"),
        (GOOD.assign_coords(sector=np.arange(2, 10)), EVENTS, {}, "in sector 1, which activity has not"),
        (GOOD, EVENTS, {"before": -1}, "before must be a whole number of at least 0, got -1"),
        (GOOD, EVENTS, {"after": 2.5}, "after must be"),
        (GOOD, EVENTS, {"bootstrap": True}, "bootstrap must be"),
        (GOOD, EVENTS, {"seed": "0"}, "seed must be"),
        (GOOD, EVENTS, {"kind": "both"}, "kind must be one of protrusion, retraction, got 'both'"),
        (GOOD, EVENTS, {"at": "start"}, "at must be one of onset, peak, end"),
        (GOOD, EVENTS, {"normalise": None}, "normalise must be one of none, mean, sd"),
        (GOOD, EVENTS, {"confidence": 95}, "confidence must be .* got 95"),
        (GOOD, EVENTS, {"confidence": 1.0}, "confidence"),
    ],
)
def test_what_does_not_fit_is_refused(
    activity: Any, events: Any, options: dict[str, Any], message: str
) -> None:
    with pytest.raises(ParameterError, match=message):
        average_around(activity, events, **({"before": 1, "after": 1} | options))
