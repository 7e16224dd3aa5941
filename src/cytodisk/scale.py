"""`Scale`: µm per pixel and seconds per frame, or unknown; it converts, and names the units."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.checks import LARGEST_SCALE, SMALLEST_SCALE, is_number
from cytodisk.errors import ParameterError
from cytodisk.parameter_words import number_words, short_words

Number = TypeVar("Number", float, FloatArray)
"""A number or an array of numbers."""

_ALIKE = 1.01

_MINUTE, _HOUR = 60.0, 3600.0  # in s
_LONGEST_IN_S, _LONGEST_IN_MIN = 300.0, 36000.0  # times beyond are in the next unit
_SLOWEST_IN_UM = 0.1  # velocities that do not reach it are in nm


def alike(first: float, *others: float, ratio: float = _ALIKE) -> bool:
    """Whether sizes or times above 0 differ by 1 % at most, or by another ratio of largest to least."""
    values = (first, *others)
    return max(values) <= ratio * min(values)


@dataclass(frozen=True)
class ShownUnit:
    """A unit that suits the numbers to be shown; tables stay in µm and s.

    Parameters
    ----------
    name : str
        Such as "min" or "nm/s".
    factor : float
        How many of it make one unit of the table.
    """

    name: str
    factor: float = 1.0

    def words(self, value: float, digits: int = 3, *, sign: bool = False) -> str:
        """A number of the table in this unit, as "2.5 min" or, with its sign, "−20 s"; "–" for NaN."""
        shown = self.number(value, digits, sign=sign)
        if not math.isfinite(value):
            return shown
        plural = self.name == "frame" and shown.lstrip("+−") != "1"
        return f"{shown} {self.name}{'s' * plural}"

    def number(self, value: float, digits: int = 3, *, sign: bool = False) -> str:
        """The same without the unit."""
        if not math.isfinite(value):
            return "–"
        rounded = float(f"{value * self.factor:.{digits}g}") + 0.0  # 0 has no sign
        return f"{rounded:{'+' if sign else ''}.12g}".replace("-", "−")


def suited_time(longest_s: float, step_s: float = 0.0) -> ShownUnit:
    """The unit for times up to so many seconds: s up to 300 s, min up to 10 h, else h.

    Parameters
    ----------
    longest_s : float
        The longest of the times that stand together, such as those of an axis.
    step_s : float
        Time between frames: from a minute on, times are in min, and from an hour on in h.

    Examples
    --------
    >>> from cytodisk.scale import suited_time
    >>> suited_time(200.0).name, suited_time(2400.0).name, suited_time(90000.0).words(90000.0)
    ('s', 'min', '25 h')
    """
    if longest_s <= _LONGEST_IN_S and step_s < _MINUTE:
        return ShownUnit("s")
    if longest_s <= _LONGEST_IN_MIN and step_s < _HOUR:
        return ShownUnit("min", 1.0 / _MINUTE)
    return ShownUnit("h", 1.0 / _HOUR)


def suited_lag(step_s: float) -> ShownUnit:
    """The unit for lags of frames so many seconds apart: s, min from 30 s on, h from 30 min on.

    Examples
    --------
    >>> from cytodisk.scale import suited_lag
    >>> suited_lag(5.0).words(-20.0, sign=True), suited_lag(30.0).words(90.0, sign=True)
    ('−20 s', '+1.5 min')
    """
    if step_s < 0.5 * _MINUTE:
        return ShownUnit("s")
    return ShownUnit("min", 1.0 / _MINUTE) if step_s < 0.5 * _HOUR else ShownUnit("h", 1.0 / _HOUR)


def suited_velocity(fastest: float, unit: str, time: ShownUnit) -> ShownUnit:
    """The unit for velocities: per s, min or h as the movie's times are, in nm where the fastest is < 0.1 µm.

    Parameters
    ----------
    fastest : float
        The largest size of the velocities that stand together.
    unit : str
        Their unit; other than µm/s it stays.
    time : ShownUnit
        That of the movie's times.

    Examples
    --------
    >>> from cytodisk.scale import suited_time, suited_velocity
    >>> suited_velocity(0.082, "µm/s", suited_time(200.0)).words(0.082)
    '82 nm/s'
    >>> suited_velocity(0.01, "µm/s", suited_time(2400.0)).words(0.01)
    '0.6 µm/min'
    """
    if unit != "µm/s":
        return ShownUnit(unit)
    factor = 1.0 / time.factor
    if math.isfinite(fastest) and 0.0 < abs(fastest) * factor < _SLOWEST_IN_UM:
        return ShownUnit(f"nm/{time.name}", 1000.0 * factor)
    return ShownUnit(f"µm/{time.name}", factor)


@dataclass(frozen=True)
class Scale:
    """µm per pixel and seconds per frame; None where unknown, and then results are in px and frames.

    Parameters
    ----------
    pixel_size_um : float or None
        Side of a pixel in µm.
    frame_interval_s : float or None
        Time from a frame to the next in seconds.

    Raises
    ------
    ParameterError
        One of them is not a positive, finite number.

    Examples
    --------
    >>> from cytodisk import Scale
    >>> scale = Scale(pixel_size_um=0.1, frame_interval_s=5.0)
    >>> scale.velocity(2.0), scale.velocity_unit  # 2 px/frame
    (0.04, 'µm/s')
    >>> Scale().velocity(2.0), Scale().velocity_unit
    (2.0, 'px/frame')
    """

    pixel_size_um: float | None = None
    frame_interval_s: float | None = None

    def __post_init__(self) -> None:
        for name in ("pixel_size_um", "frame_interval_s"):
            value = getattr(self, name)
            if value is None:
                continue
            if not (is_number(value) and SMALLEST_SCALE <= value <= LARGEST_SCALE):
                limits = " to ".join(map(number_words, (SMALLEST_SCALE, LARGEST_SCALE)))
                raise ParameterError(
                    f"{name} must be a number from {limits}, got {short_words(value)}: leave it out when it "
                    "is not known"
                )
            object.__setattr__(self, name, float(value))

    @classmethod
    def of(cls, carrier: Any) -> Scale:
        """The scale that something carries.

        Parameters
        ----------
        carrier : DataArray, Dataset, map, movie or windows
            Has a `scale`, or `attrs` with `pixel_size_um` and `frame_interval_s`. Anything else has none.

        Returns
        -------
        Scale
        """
        scale = getattr(carrier, "scale", None)
        if isinstance(scale, Scale):
            return scale
        attrs = getattr(carrier, "attrs", None)
        if not isinstance(attrs, Mapping):
            return cls()
        return cls(attrs.get("pixel_size_um"), attrs.get("frame_interval_s"))

    @property
    def attrs(self) -> dict[str, float]:
        """What is known, as attrs of an array: `pixel_size_um` and `frame_interval_s`."""
        both = {"pixel_size_um": self.pixel_size_um, "frame_interval_s": self.frame_interval_s}
        return {name: value for name, value in both.items() if value is not None}

    @property
    def length_unit(self) -> str:
        """µm, or px."""
        return "px" if self.pixel_size_um is None else "µm"

    @property
    def area_unit(self) -> str:
        """µm², or px²."""
        return f"{self.length_unit}²"

    @property
    def time_unit(self) -> str:
        """s, or frame."""
        return "frame" if self.frame_interval_s is None else "s"

    @property
    def velocity_unit(self) -> str:
        """Such as µm/s or px/frame."""
        return f"{self.length_unit}/{self.time_unit}"

    def length(self, pixels: Number) -> Number:
        """A length in pixels → in `length_unit`."""
        return pixels if self.pixel_size_um is None else pixels * self.pixel_size_um

    def area(self, square_pixels: Number) -> Number:
        """An area in square pixels → in `area_unit`."""
        return square_pixels if self.pixel_size_um is None else square_pixels * self.pixel_size_um**2

    def velocity(self, pixels_per_frame: Number) -> Number:
        """A velocity in px/frame → in `velocity_unit`."""
        factor = self.length(1.0) / self.time(1.0)
        return pixels_per_frame * factor

    def time(self, frames: Number) -> Number:
        """A time in frames → in `time_unit`."""
        return frames if self.frame_interval_s is None else frames * self.frame_interval_s

    def seconds(self, frame: int) -> float | None:
        """Time of a frame in seconds; None where the interval is unknown."""
        return None if self.frame_interval_s is None else frame * self.frame_interval_s

    def time_coords(self, frames: IntArray) -> dict[str, Any]:
        """Coordinates of the dim `time` of an array: `frame`, and `time_s` where the interval is known."""
        coords: dict[str, Any] = {"frame": ("time", frames, {"units": "frame"})}
        if self.frame_interval_s is not None:
            coords["time_s"] = ("time", frames * self.frame_interval_s, {"units": "s"})
        return coords

    def shown_time(self, frames: float) -> ShownUnit:
        """The unit that suits the times of so many frames; "frame" where seconds are not known."""
        interval = self.frame_interval_s
        if interval is None:
            return ShownUnit("frame")
        return suited_time(frames * interval, interval)

    def shown_velocity(self, fastest: float, frames: float) -> ShownUnit:
        """The unit that suits velocities up to `fastest`, which is in `velocity_unit`."""
        return suited_velocity(fastest, self.velocity_unit, self.shown_time(frames))

    def given(self, pixel_size_um: float | None = None, frame_interval_s: float | None = None) -> Scale:
        """This scale, where a user gave no other one."""
        return Scale(
            self.pixel_size_um if pixel_size_um is None else pixel_size_um,
            self.frame_interval_s if frame_interval_s is None else frame_interval_s,
        )

    def words(self) -> tuple[str, str]:
        """Two sentences for a user: the pixel size and the frame interval, or what their lack means."""
        pixel, interval = self.pixel_size_um, self.frame_interval_s
        return (
            "pixel size: unknown, lengths are in px" if pixel is None else f"pixel size: {pixel:g} µm",
            "frame interval: unknown, times are in frames"
            if interval is None
            else f"frame interval: {interval:g} s",
        )


UNKNOWN = Scale()
"""Neither is known: results are in px and frames."""
