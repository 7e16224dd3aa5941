"""Parameters of `cytodisk correlate`."""

from typing import Literal

from pydantic import field_validator

from cytodisk.analysis.correlation.correlation_parameters import (
    CLUSTERS,
    MOST_SURROGATES,
    PairCorrelationParameters,
    PeakParameters,
    SkipLagsParameters,
)
from cytodisk.parameters import from_zero, in_order, parameter

FEWEST_SURROGATES = 19

_LONGEST_NAME = 60


class CorrelateParameters(PeakParameters, SkipLagsParameters, PairCorrelationParameters):
    """What decides the result of `cytodisk correlate`, beside the study and its two signals."""

    max_lag: int | None = parameter(
        None,
        "Longest lag; without it a quarter of the movie, at most 20, or what leaves enough pairs of frames.",
        least=0,
        most=1_000_000,
        unit="frames",
    )
    against: Literal["window", "edge"] = parameter(
        "window",
        'What a window of one signal is compared with: "window" is the same window of the other signal, '
        '"edge" the outermost window of the sector.',
    )
    surrogates: int = parameter(
        1999,
        f"Number of surrogate series to compare with; 0 for none, else at least {FEWEST_SURROGATES}, as p "
        "could not reach 0.05 with fewer.",
        least=0,
        most=MOST_SURROGATES,
    )
    geometry: bool = parameter(
        True,
        "Also correlate what is left without what geometry alone would give: the movie's mean in the lab and "
        "its mean by depth. It reads the maps and the signal again.",
    )
    control: tuple[str, ...] = parameter(
        (),
        "Channels that are regressed out too, window by window, such as a volume marker.",
        words="names of channels with commas between",
    )
    clusters: bool = parameter(True, CLUSTERS)
    pairs: bool = parameter(
        False, "Also correlate every window of one signal with every window of the other, by distance."
    )
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
    sectors: tuple[int, int] | None = parameter(
        None,
        "First and last sector that are used; 50:5 goes on over the last. Without it all.",
        words="the first and the last, such as 10:80",
    )
    name: str = parameter("", "Keeps the result beside others of the same signals.")

    @field_validator("surrogates")
    @classmethod
    def _enough(cls, surrogates: int) -> int:
        if 0 < surrogates < FEWEST_SURROGATES:
            raise ValueError(f"must be 0, or at least {FEWEST_SURROGATES} for any p to reach 0.05")
        return surrogates

    @field_validator("frames")
    @classmethod
    def _in_order(cls, frames: tuple[int, int] | None) -> tuple[int, int] | None:
        return in_order(frames)

    @field_validator("frames", "sectors", "without_frames")
    @classmethod
    def _from_zero(cls, numbers: tuple[int, ...] | None) -> tuple[int, ...] | None:
        return from_zero(numbers)

    @field_validator("name")
    @classmethod
    def _short(cls, name: str) -> str:
        if len(name) > _LONGEST_NAME:
            raise ValueError(f"must be a text of at most {_LONGEST_NAME} letters")
        return name
