"""`Scale`: µm per pixel and seconds per frame, or unknown; it converts, and names the units."""

from __future__ import annotations

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


def alike(first: float, *others: float, ratio: float = _ALIKE) -> bool:
    """Whether sizes or times above 0 differ by 1 % at most, or by another ratio of largest to least."""
    values = (first, *others)
    return max(values) <= ratio * min(values)


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
