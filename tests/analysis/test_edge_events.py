from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from cytodisk.analysis.events import edge_events, velocity_noise
from cytodisk.errors import ParameterError

NAN = np.nan


def velocity_of(values: Any, units: str = "px/frame", **coords: Any) -> xr.DataArray:
    table = np.asarray(values, dtype=np.float64)
    table = table[:, None] if table.ndim == 1 else table
    known = {"frame": ("time", np.arange(len(table))), "sector": np.arange(table.shape[1])}
    return xr.DataArray(table, known | coords, ("time", "sector"), attrs={"units": units})


def in_time(values: xr.DataArray, interval_s: float) -> xr.DataArray:
    return values.assign_coords(time_s=("time", values["frame"].to_numpy() * interval_s))


def test_two_pulses_have_the_numbers_that_they_were_made_with() -> None:
    #                              0     1    2    3    4    5     6     7     8    9
    velocity = velocity_of([[0.0], [1.0], [3.0], [2.0], [0.0], [-2.0], [-4.0], [0.0], [0.5], [NAN]], "µm/s")
    length = xr.full_like(velocity, 7.0).assign_attrs(units="µm")
    events = edge_events(in_time(velocity, 5.0), threshold=1.0, edge_length=length)
    assert len(events) == 2
    out, back = events.to_dict("records")
    assert out == {
        "sector": 0,
        "kind": "protrusion",
        "onset": 1,
        "end": 4,
        "peak": 2,
        "onset_s": 5.0,
        "end_s": 20.0,
        "peak_s": 10.0,
        "duration": 15.0,
        "peak_velocity": 3.0,
        "mean_velocity": 2.0,
        "area": 6.0 * 5.0 * 7.0,
        "onset_known": True,
        "end_known": True,
        "complete": True,
        "patch": 0,
    }
    assert (back["kind"], back["onset"], back["end"], back["peak"]) == ("retraction", 5, 7, 6)
    assert (back["peak_velocity"], back["mean_velocity"], back["area"]) == (-4.0, -3.0, -6.0 * 5.0 * 7.0)
    assert (back["duration"], back["patch"]) == (10.0, 1)
    assert events.attrs["threshold"] == 1.0
    units = events.attrs["units"]
    assert set(units) == set(events.columns)
    assert (units["onset"], units["onset_s"], units["duration"]) == ("frame", "s", "s")
    assert (units["peak_velocity"], units["area"]) == ("µm/s", "µm²")


def test_without_seconds_or_areas() -> None:
    events = edge_events(velocity_of([0.0, 1.0, 1.0, 1.0, 0.0]), threshold=0.5)
    assert events[["onset_s", "end_s", "peak_s", "area"]].isna().all(axis=None)
    assert float(events["duration"].iloc[0]) == 3.0
    assert (events.attrs["units"]["duration"], events.attrs["units"]["area"]) == ("frame", "")


@pytest.mark.parametrize(("min_frames", "onsets"), [(1, [1, 4, 8]), (2, [4, 8]), (3, [8]), (4, [])])
def test_short_events_are_left_out(min_frames: int, onsets: list[int]) -> None:
    velocity = velocity_of([0, 9, 0, 0, 9, 9, 0, 0, 9, 9, 9, 0])
    events = edge_events(velocity, threshold=1.0, min_frames=min_frames)
    assert events["onset"].tolist() == onsets


def test_the_peak_must_be_above_the_threshold() -> None:
    velocity = velocity_of([[0, 0, 0, 0], [1, 2, -1, -2], [1, 1, -1, -1], [0, 0, 0, 0]])
    assert edge_events(velocity, threshold=1.0)["sector"].tolist() == [1, 3]
    assert edge_events(velocity, threshold=2.0).empty
    assert len(edge_events(velocity, threshold=0.0)) == 4


def test_what_reaches_the_ends_or_a_gap_is_not_complete() -> None:
    column = [1, 1, 0, 1, 1, NAN, 1, 1, 0, 1, 1, -1, -1, 1, 1, NAN]
    events = edge_events(velocity_of(column), threshold=0.5)
    assert events["onset"].tolist() == [0, 3, 6, 9, 11, 13]
    assert events["end"].tolist() == [2, 5, 8, 11, 13, 15]
    assert events["onset_known"].tolist() == [False, True, False, True, True, True]
    assert events["end_known"].tolist() == [True, False, True, True, True, False]
    assert events["complete"].tolist() == [False, False, False, True, True, False]


def test_what_goes_on_to_the_last_frame_is_not_complete() -> None:
    (event,) = edge_events(in_time(velocity_of([0, 1, 1]), 2.0), threshold=0.5).to_dict("records")
    assert (event["end"], event["end_s"], event["end_known"]) == (3, 6.0, False)


def test_a_sine_has_an_event_each_half_period() -> None:
    time = np.arange(60)
    velocity = velocity_of(np.sin(2 * np.pi * (time + 0.5) / 20))
    events = edge_events(velocity, threshold=0.5)
    assert events["onset"].tolist() == [0, 10, 20, 30, 40, 50]
    assert (events["duration"] == 10).all()
    assert events["kind"].tolist() == ["protrusion", "retraction"] * 3
    np.testing.assert_allclose(np.abs(events["peak_velocity"]), np.cos(np.pi / 20))
    # Sum of sin over half a period of 20 steps, at their middles.
    np.testing.assert_allclose(np.abs(events["mean_velocity"]), 0.1 / np.sin(np.pi / 20))
    assert events["complete"].tolist() == [False, True, True, True, True, False]


def test_a_constant_velocity_is_one_event_without_ends() -> None:
    velocity = velocity_of(np.full((10, 3), 0.1))
    events = edge_events(velocity)
    assert (events.attrs["noise"], events.attrs["threshold"]) == (0.0, 0.0)
    assert events["sector"].tolist() == [0, 1, 2]
    assert (events["duration"] == 10).all()
    assert not events[["onset_known", "end_known"]].any(axis=None)
    assert set(events["patch"]) == {0}


@pytest.mark.parametrize("value", [NAN, 0.0])
def test_nothing_moves(value: float) -> None:
    events = edge_events(velocity_of(np.full((10, 4), value)))
    full = edge_events(velocity_of([0.0, 1.0, 1.0, 0.0]), threshold=0.1)
    assert events.empty
    assert events.dtypes.to_dict() == full.dtypes.to_dict()
    assert set(events.attrs) == set(full.attrs)


def test_a_patch_travels_around_sector_0() -> None:
    values = np.zeros((20, 60))
    for step in range(8):
        values[2 + step : 5 + step, (56 + step) % 60] = 1.0
    values[2:5, 30] = 1.0
    events = edge_events(velocity_of(values), threshold=0.5)
    wave = events[events["sector"] != 30]
    assert wave["sector"].tolist() == [56, 57, 58, 59, 0, 1, 2, 3]
    assert set(wave["patch"]) == {1}
    assert set(events[events["sector"] == 30]["patch"]) == {0}


def test_patches_touch_in_the_same_step_and_are_of_one_kind() -> None:
    values = np.zeros((12, 5))
    values[1:3, 0] = 1.0
    values[3:5, 1] = 1.0  # begins when the neighbour has ended
    values[4:6, 2] = -1.0  # the other kind
    values[4:6, 3] = -1.0
    values[8:10, [0, 4]] = 1.0  # neighbours around the end
    events = edge_events(velocity_of(values), threshold=0.5)
    assert events.groupby("patch")["sector"].apply(list).tolist() == [[0], [1], [2, 3], [0, 4]]
    selected = velocity_of(values).isel(sector=[0, 1, 2, 4])
    assert edge_events(selected, threshold=0.5).query("onset == 8")["patch"].nunique() == 2
    shifted = velocity_of(values, sector=np.arange(10, 15))
    events = edge_events(shifted, threshold=0.5)
    assert sorted(set(events["sector"])) == [10, 11, 12, 13, 14]
    assert events.query("onset == 8")["patch"].nunique() == 2


def test_two_sectors_and_one() -> None:
    pulse = [0.0, 1.0, 1.0, 0.0]
    assert edge_events(velocity_of(np.array([pulse] * 2).T), threshold=0.5)["patch"].tolist() == [0, 0]
    assert edge_events(velocity_of(pulse), threshold=0.5)["patch"].tolist() == [0]


def brute_force(values: np.ndarray, limit: float) -> set[tuple[int, int, int]]:
    found = set()
    for sector in range(values.shape[1]):
        start = None
        for time in range(len(values) + 1):
            here = np.sign(values[time, sector]) if time < len(values) else NAN
            if start is not None and here != np.sign(values[start, sector]):
                run = values[start:time, sector]
                if len(run) >= 2 and np.abs(run).max() > limit:
                    found.add((sector, start, time))
                start = None
            if start is None and (here > 0 or here < 0):
                start = time
    return found


@pytest.mark.parametrize("seed", range(5))
def test_random_velocities_against_plain_loops(seed: int) -> None:
    random = np.random.default_rng(seed)
    values = random.normal(size=(40, 9)).round(1)
    values[random.random(values.shape) < 0.1] = NAN
    events = edge_events(velocity_of(values), threshold=1.0)
    found = set(zip(events["sector"], events["onset"], events["end"], strict=True))
    assert found == brute_force(values, 1.0)
    assert len(found) == len(events) > 20
    spans = events.sort_values(["sector", "onset"]).groupby("sector")
    assert all((one["onset"].to_numpy()[1:] >= one["end"].to_numpy()[:-1]).all() for _, one in spans)
    for event in events.to_dict("records"):
        run = values[event["onset"] : event["end"], event["sector"]]
        assert event["mean_velocity"] == pytest.approx(run.mean())
        assert event["peak_velocity"] == run[np.abs(run).argmax()]
        assert event["peak"] == event["onset"] + np.abs(run).argmax()
    # Patches are numbered as they come, and are what plain merging of touching events gives.
    assert pd.unique(events["patch"]).tolist() == list(range(events["patch"].nunique()))
    assert same_groups(events["patch"].to_numpy(), merged(events, 9))


def merged(events: pd.DataFrame, sectors: int) -> np.ndarray:
    groups = np.arange(len(events))
    rows = events.to_dict("records")
    for i, a in enumerate(rows):
        for j, b in enumerate(rows):
            near = (a["sector"] - b["sector"]) % sectors in (1, sectors - 1)
            together = a["onset"] < b["end"] and b["onset"] < a["end"]
            if near and together and a["kind"] == b["kind"]:
                groups[groups == groups[i]] = groups[j]
    return groups


def same_groups(one: np.ndarray, other: np.ndarray) -> bool:
    return bool(np.array_equal(one[:, None] == one, other[:, None] == other))


def test_counted_pixels_are_the_area() -> None:
    velocity = velocity_of([[0, 0], [1, -1], [1, -1], [0, 0]], "µm/s")
    won = xr.DataArray(
        [[9, 9], [4, 0], [3, 1], [9, 9]], velocity.coords, velocity.dims, attrs={"units": "µm²"}
    )
    lost = xr.DataArray(
        [[9, 9], [1, 5], [0, 6], [9, 9]], velocity.coords, velocity.dims, attrs={"units": "µm²"}
    )
    events = edge_events(velocity, threshold=0.5, protruded_area=won, retracted_area=lost)
    assert events["area"].tolist() == [6.0, -10.0]
    assert events.attrs["units"]["area"] == "µm²"
    unknown = won.astype(float).where(won != 3)
    events = edge_events(velocity, threshold=0.5, protruded_area=unknown, retracted_area=lost)
    assert np.isnan(events["area"].iloc[0])
    assert events["area"].iloc[1] == -10.0


@pytest.mark.parametrize(
    ("units", "interval", "area"),
    [("µm/frame", 5.0, 6.0), ("µm/s", 5.0, 30.0), ("µm/min", 5.0, 0.5), ("µm/h", 1800.0, 3.0)],
)
def test_area_is_in_the_time_of_the_velocity(units: str, interval: float, area: float) -> None:
    velocity = in_time(velocity_of([0, 1, 1, 0], units), interval)
    length = xr.full_like(velocity, 3.0).assign_attrs(units="µm")
    events = edge_events(velocity, threshold=0.5, edge_length=length)
    assert events["area"].tolist() == pytest.approx([area])


def test_uneven_times_and_later_frames() -> None:
    velocity = velocity_of([0, 1, 1, 0], "µm/s", frame=("time", np.arange(7, 11)))
    velocity = velocity.assign_coords(time_s=("time", [0.0, 1.0, 3.0, 10.0]))
    length = xr.full_like(velocity, 2.0).assign_attrs(units="µm")
    (event,) = edge_events(velocity, threshold=0.5, edge_length=length).to_dict("records")
    assert (event["onset"], event["end"], event["onset_s"], event["end_s"]) == (8, 10, 1.0, 10.0)
    assert (event["duration"], event["area"]) == (9.0, 2.0 * 9.0)


def test_order_of_dims_does_not_matter() -> None:
    velocity = velocity_of(np.random.default_rng(0).normal(size=(20, 5)))
    pd.testing.assert_frame_equal(edge_events(velocity), edge_events(velocity.transpose("sector", "time")))


def test_noise_is_found_beneath_slow_motion() -> None:
    random = np.random.default_rng(1)
    slow = 5.0 * np.sin(2 * np.pi * np.arange(200) / 100)[:, None]
    values = slow + random.normal(0.0, 0.3, (200, 40))
    assert velocity_noise(velocity_of(values)) == pytest.approx(0.3, rel=0.04)
    events = edge_events(velocity_of(values))
    assert events.attrs["threshold"] == pytest.approx(0.6, rel=0.04)
    values[random.random(values.shape) < 0.02] = 50.0  # a few faults of masks
    assert velocity_noise(velocity_of(values)) == pytest.approx(0.3, rel=0.15)


def test_noise_of_positions_is_found_29_percent_too_high() -> None:
    positions = np.random.default_rng(2).normal(0.0, 1.0, (2001, 20))
    noise = velocity_noise(velocity_of(np.diff(positions, axis=0)))
    assert noise == pytest.approx(np.sqrt(2.0) * np.sqrt(10.0 / 6.0), rel=0.03)


def test_noise_of_positions_alone_makes_hardly_any_events() -> None:
    positions = np.random.default_rng(3).normal(0.0, 1.0, (501, 60))
    events = edge_events(velocity_of(np.diff(positions, axis=0)))
    assert len(events) < 0.002 * 500 * 60


GOOD = velocity_of(np.zeros((5, 3)), "µm/s")
AREA = xr.zeros_like(GOOD).assign_attrs(units="µm²")
LENGTH = xr.zeros_like(GOOD).assign_attrs(units="µm")


@pytest.mark.parametrize(
    ("velocity", "options", "message"),
    [
        (np.zeros((5, 3)), {}, "velocity must be a DataArray with dims time and sector, got ndarray"),
        (GOOD.rename(sector="point"), {}, r"got \('time', 'point'\)"),
        (GOOD[:0], {}, "velocity is empty"),
        (GOOD[:, :0], {}, "velocity is empty"),
        (GOOD.assign_attrs(units=""), {}, "velocity.attrs has no 'units'"),
        (GOOD.where(GOOD != 0, np.inf), {}, "finite numbers, or NaN"),
        (GOOD.isel(time=[0, 1, 3, 4]), {}, r"follow each other, its frame is 0, 1, 3, 4"),
        (GOOD, {"min_frames": 0}, "min_frames must be a whole number of at least 1, got 0"),
        (GOOD, {"min_frames": 2.5}, "min_frames"),
        (GOOD, {"threshold": -1}, "threshold must be a number of at least 0, got -1"),
        (GOOD, {"threshold": NAN}, "threshold"),
        (GOOD, {"threshold": "2"}, "threshold"),
        (GOOD.isel(time=slice(2)), {}, "threshold cannot be told .* pass a number"),
        (GOOD, {"protruded_area": AREA}, "go together"),
        (GOOD, {"retracted_area": AREA}, "go together"),
        (GOOD, {"protruded_area": AREA, "retracted_area": LENGTH}, "in µm², retracted_area in µm"),
        (GOOD, {"edge_length": LENGTH}, "no seconds: give it the coordinate time_s"),
        (GOOD, {"edge_length": LENGTH.isel(time=slice(4))}, "edge_length must be .*got .'time': 4"),
        (
            GOOD,
            {"edge_length": LENGTH.assign_coords(frame=("time", np.arange(1, 6)))},
            "numbers of their frames",
        ),
        (GOOD, {"edge_length": 3.0}, "got float"),
        (GOOD, {"edge_length": LENGTH.assign_attrs(units="px")}, "µm/s, edge_length in px"),
        (GOOD, {"edge_length": LENGTH.assign_attrs(units="")}, "edge_length.attrs has no 'units'"),
        (GOOD.assign_attrs(units="µm/day"), {"edge_length": LENGTH}, "µm/day"),
    ],
)
def test_what_does_not_fit_is_refused(velocity: Any, options: dict[str, Any], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        edge_events(velocity, **options)
