"""Settings of a correlation."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any, Literal, get_args

from cytodisk.analysis.parameters import whole_number
from cytodisk.analysis.peaks import Rule, check_rule
from cytodisk.analysis.series import Detrend, check_detrend
from cytodisk.analysis.surrogates import Null
from cytodisk.errors import ParameterError

FEWEST_SURROGATES = 19
VELOCITIES = ("velocity", "velocity_cell_frame")

Against = Literal["window", "edge"]


@dataclass(frozen=True)
class CorrelationSettings:
    """What decides the result of `cytodisk correlate`, beside the study; see `cross_correlate`.

    Attributes
    ----------
    max_lag : int or None
        In frames; None for a quarter of the movie, at most 20.
    against : {"window", "edge"}
        Compare each window with the other signal's same window, or with its outermost one in the sector.
    rule : {"nearest", "largest"}
        See `peak_correlation`.
    detrend : {"none", "linear", "median"}
    detrend_frames : int or None
    difference : bool
    min_pairs : int
    skip_lags : tuple of int
        Lags that do not count, such as -1 and 0 where masks jitter, see `jitter_step`.
    surrogates : int
    null : {"phase", "shift"}
    seed : int
    pairs : bool
        Also correlate every window of one signal with every window of the other.
    frames, sectors : (int, int) or None
        First and last that are used, both counted; sectors 50 to 5 go on over the last. None for all.
    without_frames : tuple of int
        Frames that are left out, such as those whose mask is wrong, with the steps of the edge from and to
        them.
    name : str
        Keeps the result beside others of the same signals.
    """

    max_lag: int | None = None
    against: Against = "window"
    rule: Rule = "nearest"
    detrend: Detrend = "none"
    detrend_frames: int | None = None
    difference: bool = False
    min_pairs: int = 10
    skip_lags: tuple[int, ...] = ()
    surrogates: int = 1999
    null: Null = "phase"
    seed: int = 0
    pairs: bool = False
    frames: tuple[int, int] | None = None
    without_frames: tuple[int, ...] = ()
    sectors: tuple[int, int] | None = None
    name: str = ""

    @classmethod
    def of(cls, **values: Any) -> CorrelationSettings:
        """Settings from values by name.

        Raises
        ------
        ParameterError
            A name is unknown, or a value out of range.
        """
        known = [field.name for field in fields(cls)]
        unknown = sorted(set(values) - set(known))
        if unknown:
            raise ParameterError(f"settings have no {unknown[0]!r}: they are {', '.join(known)}")
        settings = cls(**values)
        check_rule(settings.rule)
        check_detrend(settings.detrend, settings.detrend_frames)
        for name, choice in (("against", Against), ("null", Null)):
            if getattr(settings, name) not in get_args(choice):
                raise ParameterError(
                    f"{name} must be one of {', '.join(get_args(choice))}, got {getattr(settings, name)!r}"
                )
        for name, least in (("surrogates", 0), ("seed", 0), ("min_pairs", 3), ("max_lag", 0)):
            if getattr(settings, name) is not None:
                whole_number(name, getattr(settings, name), least)
        if 0 < settings.surrogates < FEWEST_SURROGATES:
            raise ParameterError(
                f"surrogates must be 0, or at least {FEWEST_SURROGATES} for any p to reach 0.05, got "
                f"{settings.surrogates}"
            )
        if settings.frames is not None and settings.frames[1] < settings.frames[0]:
            raise ParameterError(f"frames must go from the first to the last, got {settings.frames}")
        return settings

    def common(self) -> dict[str, Any]:
        """What `cross_correlate` and `correlate_pairs` both take."""
        names = ("detrend", "detrend_frames", "difference", "min_pairs", "surrogates", "null", "seed")
        return {name: getattr(self, name) for name in names}
