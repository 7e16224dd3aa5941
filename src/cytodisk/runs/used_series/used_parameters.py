"""Parameters of which frames and sectors of a study are used, and of what is regressed out of signals."""

from pydantic import field_validator

from cytodisk.parameters import Parameters, from_zero, in_order, parameter

_LONGEST_NAME = 60


class UsedFramesParameters(Parameters):
    """Which frames of a study's series are used, and what the result is called."""

    geometry: bool = parameter(True, "Also do without what geometry alone would give.")
    frames: tuple[int, int] | None = parameter(
        None,
        "First and last frame that are used; without it all.",
        words="the first and the last, such as 10:80",
    )
    without_frames: tuple[int, ...] = parameter(
        (),
        "Frames that are left out, such as those with a wrong mask.",
        words="whole numbers, such as 17,24",
    )
    name: str = parameter("", "Keeps the result beside others of the same signals.")

    @field_validator("frames")
    @classmethod
    def _in_order(cls, frames: tuple[int, int] | None) -> tuple[int, int] | None:
        return in_order(frames)

    @field_validator("frames", "without_frames")
    @classmethod
    def _from_zero(cls, numbers: tuple[int, ...] | None) -> tuple[int, ...] | None:
        return from_zero(numbers)

    @field_validator("name")
    @classmethod
    def _short(cls, name: str) -> str:
        if len(name) > _LONGEST_NAME:
            raise ValueError(f"must be a text of at most {_LONGEST_NAME} letters")
        return name


class UsedSeriesParameters(UsedFramesParameters):
    """Which frames and sectors of a study's series are used."""

    sectors: tuple[int, int] | None = parameter(
        None,
        "First and last sector that are used; 50:5 goes on over the last. Without it all.",
        words="the first and the last, such as 10:80",
    )

    @field_validator("sectors")
    @classmethod
    def _sectors_from_zero(cls, numbers: tuple[int, ...] | None) -> tuple[int, ...] | None:
        return from_zero(numbers)
