from typing import Any

import numpy as np
import pytest
import xarray as xr

import cytodisk as cd
from cytodisk import Scale
from cytodisk.errors import ParameterError
from cytodisk.scale import suited_lag, suited_time

KNOWN = Scale(0.5, 4.0)


@pytest.mark.parametrize(
    ("scale", "units"),
    [
        (KNOWN, ("µm", "µm²", "s", "µm/s")),
        (Scale(0.5), ("µm", "µm²", "frame", "µm/frame")),
        (Scale(None, 4.0), ("px", "px²", "s", "px/s")),
        (Scale(), ("px", "px²", "frame", "px/frame")),
    ],
)
def test_units(scale: Scale, units: tuple[str, ...]) -> None:
    assert (scale.length_unit, scale.area_unit, scale.time_unit, scale.velocity_unit) == units


def test_converts_what_is_known() -> None:
    assert (KNOWN.length(3.0), KNOWN.area(8.0), KNOWN.time(2.0), KNOWN.velocity(2.0)) == (1.5, 2.0, 8.0, 0.25)
    assert (KNOWN.seconds(3), Scale().seconds(3)) == (12.0, None)
    np.testing.assert_array_equal(KNOWN.length(np.array([2.0, 4.0])), [1.0, 2.0])
    values = np.array([1.0, 7.0])
    for unknown in (Scale().length, Scale().area, Scale().time, Scale().velocity):
        np.testing.assert_array_equal(unknown(values), values)


@pytest.mark.parametrize("value", [0.0, -1.0, np.nan, np.inf, True, "0.1", 10**400])
@pytest.mark.parametrize("name", ["pixel_size_um", "frame_interval_s"])
def test_only_positive_numbers(name: str, value: Any) -> None:
    with pytest.raises(ParameterError, match=name):
        Scale(**{name: value})


def test_numbers_of_numpy_become_plain() -> None:
    scale = Scale(np.float32(0.5))
    assert type(scale.pixel_size_um) is float
    assert scale == Scale(0.5)


def test_of_reads_what_carries_one() -> None:
    array = xr.DataArray(np.zeros(2), attrs=KNOWN.attrs)
    assert Scale.of(array) == Scale.of(xr.Dataset(attrs=KNOWN.attrs)) == KNOWN
    assert Scale.of(xr.DataArray(np.zeros(2), attrs={"pixel_size_um": None})) == Scale()
    assert Scale.of(np.zeros(2)) == Scale()


def test_a_given_value_goes_before_that_of_the_file() -> None:
    assert KNOWN.given(None, 2.0) == Scale(0.5, 2.0)
    assert KNOWN.given() == KNOWN


def test_time_coords_have_seconds_where_they_are_known() -> None:
    array = xr.DataArray(np.zeros(2), KNOWN.time_coords(np.array([3, 4])), ("time",))
    assert array["time_s"].to_numpy().tolist() == [12.0, 16.0]
    assert list(Scale().time_coords(np.array([3, 4]))) == ["frame"]


def test_maps_and_windows_carry_the_scale_of_the_mask() -> None:
    mask = xr.DataArray(cd.simulate.disk(9.0), dims=("y", "x"), attrs={"pixel_size_um": 0.5})
    disk = cd.map_to_disk(mask)
    grid = cd.polar_windows(2, 4)
    assert disk.scale == cd.edge_windows(mask, 2, 4).scale == Scale(0.5)
    assert cd.map_to_disk(mask, pixel_size_um=0.2).scale == Scale(0.2)
    data = cd.sample(grid.on(disk), np.ones(mask.shape))
    assert Scale.of(data) == Scale(0.5)
    assert data["area"].attrs["units"] == "px²"


def test_movies_carry_it_into_maps_velocity_and_activity() -> None:
    masks = np.stack([cd.simulate.disk(9.0)] * 3)
    movie = cd.map_movie(masks, pixel_size_um=0.5, frame_interval_s=4.0)
    activity = cd.sample_movie(movie, cd.polar_windows(2, 4), masks.astype(float))
    for carrier in (movie, movie[1], activity, activity["mean"], cd.edge_velocity(movie, 4)):
        assert Scale.of(carrier) == KNOWN


@pytest.mark.parametrize(
    ("longest_s", "step_s", "name"),
    [
        (300.0, 5.0, "s"),
        (301.0, 5.0, "min"),
        (240.0, 60.0, "min"),
        (36000.0, 60.0, "min"),
        (36001.0, 60.0, "h"),
    ],
)
def test_times_have_a_unit_that_suits(longest_s: float, step_s: float, name: str) -> None:
    assert suited_time(longest_s, step_s).name == name
    assert Scale(None, step_s).shown_time(longest_s / step_s).name == name


@pytest.mark.parametrize(
    ("fastest", "frames", "interval_s", "words"),
    [
        (0.1, 40, 5.0, "0.1 µm/s"),
        (0.099, 40, 5.0, "99 nm/s"),
        (0.02, 100, 10.0, "1.2 µm/min"),
        (0.0005, 100, 10.0, "30 nm/min"),
        (0.0005, 100, 3600.0, "1.8 µm/h"),
    ],
)
def test_velocities_go_with_the_times(fastest: float, frames: int, interval_s: float, words: str) -> None:
    assert Scale(0.1, interval_s).shown_velocity(fastest, frames).words(fastest) == words


def test_unknown_scales_keep_their_units() -> None:
    assert Scale().shown_velocity(0.01, 10).words(0.01) == "0.01 px/frame"
    assert (Scale().shown_time(9).words(1.0), Scale().shown_time(9).words(9.0)) == ("1 frame", "9 frames")
    assert suited_lag(5.0).number(-20.0, sign=True) == "−20"


def test_no_number_and_zero() -> None:
    unit = Scale(0.1, 60.0).shown_time(5)
    assert (unit.words(np.nan), unit.words(np.inf), unit.words(-0.0)) == ("–", "–", "0 min")
    assert suited_lag(59.9).words(59.9 * 3) == "2.99 min"
    assert (suited_time(0.0).name, suited_time(3600.0, 3600.0).words(3600.0)) == ("s", "1 h")
