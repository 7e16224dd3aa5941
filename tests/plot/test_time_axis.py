import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes

from cytodisk.plot.time_axis import FrameTimes, time_stamp
from cytodisk.scale import Scale


@pytest.mark.parametrize(
    ("frames", "interval_s", "per_frame", "label"),
    [
        (10, None, 1.0, "frame"),
        (60, 5.0, 5.0, "time (s)"),
        (61, 5.0, 5.0 / 60.0, "time (min)"),
        (1000, 60.0, 1.0 / 60.0, "time (h)"),
    ],
)
def test_time_is_in_readable_units(
    frames: int, interval_s: float | None, per_frame: float, label: str
) -> None:
    times = FrameTimes(0, frames, interval_s)
    assert (times.per_frame, times.label) == (per_frame, label)


def _array(frames: list[int], seconds: list[float] | None = None, **attrs: float) -> xr.DataArray:
    coords = {"frame": ("time", frames)} | ({} if seconds is None else {"time_s": ("time", seconds)})
    return xr.DataArray(np.zeros(len(frames)), coords, ("time",), attrs=attrs)


def test_frames_and_seconds_come_from_the_array() -> None:
    assert FrameTimes.of(_array([3, 4, 5]), "a") == FrameTimes(3, 3)
    assert FrameTimes.of(_array([3, 4, 5], [6.0, 8.0, 10.0]), "a") == FrameTimes(3, 3, 2.0)
    assert FrameTimes.of(_array([0, 2, 4], [0.0, 10.0, 20.0]), "a") == FrameTimes(0, 3, 5.0, 2)
    assert FrameTimes.of(_array([0, 1], frame_interval_s=4.0), "a") == FrameTimes(0, 2, 4.0)
    assert FrameTimes.of(np.zeros(3), "a", Scale(frame_interval_s=4.0)) == FrameTimes(0, 3, 4.0)


def test_uneven_seconds_leave_the_axis_in_frames() -> None:
    assert FrameTimes.of(_array([0, 1, 2], [0.0, 1.0, 3.0], frame_interval_s=1.0), "a").label == "frame"


def test_axis_ends_half_a_step_outside(ax: Axes) -> None:
    assert FrameTimes(2, 3, 5.0, stride=2).set_axis(ax).tolist() == [10.0, 20.0, 30.0]
    assert ax.get_xlim() == (5.0, 35.0)


def test_time_stamps() -> None:
    assert time_stamp(7, Scale()) == "frame 7"
    assert time_stamp(7, Scale(frame_interval_s=5.0)) == "35 s"
    assert time_stamp(3, Scale(frame_interval_s=0.1)) == "0.3 s"
    assert time_stamp(7, Scale(frame_interval_s=90.0)) == "10.5 min"
