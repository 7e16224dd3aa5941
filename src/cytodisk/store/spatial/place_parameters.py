"""What of a study goes to other programs."""

from __future__ import annotations

from pydantic import field_validator

from cytodisk.parameters import Parameters, from_zero, in_order, parameter


class PlaceParameters(Parameters):
    """Which cells, in which frames, and whether their windows too."""

    cells: tuple[int, ...] | None = parameter(
        None, "Numbers of the cells; without it all that have a map.", words="whole numbers, such as 0,3"
    )
    frames: tuple[int, int] | None = parameter(
        None,
        "First and last frame; without it all.",
        words="the first and the last, such as 10:80",
    )
    windows: bool = parameter(True, "With the windows of the cells, not the cells and nuclei alone.")

    @field_validator("cells", "frames")
    @classmethod
    def _from_zero(cls, numbers: tuple[int, ...] | None) -> tuple[int, ...] | None:
        return from_zero(numbers)

    @field_validator("frames")
    @classmethod
    def _in_order(cls, frames: tuple[int, int] | None) -> tuple[int, int] | None:
        return in_order(frames)


class SpatialParameters(PlaceParameters):
    """The same, and whether images go with them."""

    images: bool = parameter(
        True, "With the images that were measured; without them it does not matter where those are."
    )
