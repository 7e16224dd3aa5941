"""Settings of a correlation."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import Any, Literal, get_args

import numpy as np

from cytodisk.analysis.correlation.peaks import Rule, check_rule
from cytodisk.analysis.correlation.prepared_series import Detrend, check_detrend
from cytodisk.analysis.correlation.surrogates import Null
from cytodisk.analysis.parameters import whole_number
from cytodisk.errors import ParameterError

FEWEST_SURROGATES = 19

_LEAST = {"surrogates": 0, "seed": 0, "min_pairs": 3, "max_lag": 0}
_PAIRS, _LISTS = ("frames", "sectors"), ("skip_lags", "without_frames")
_LONGEST_NAME = 60

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
        settings = cls(**{name: _parsed(name, value) for name, value in values.items()})
        check_rule(settings.rule)
        check_detrend(settings.detrend, settings.detrend_frames)
        for name, choice in (("against", Against), ("null", Null)):
            if getattr(settings, name) not in get_args(choice):
                raise ParameterError(
                    f"{name} must be one of {', '.join(get_args(choice))}, got {getattr(settings, name)!r}"
                )
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


def _parsed(name: str, value: Any) -> Any:
    """A value as the plain type that its setting has; ParameterError if it is none."""
    if name in _LEAST and value is not None:
        return whole_number(name, value, _LEAST[name])
    if name in _PAIRS and value is not None:
        numbers = _whole_numbers(name, value)
        if len(numbers) != 2:
            raise ParameterError(f"{name} must be the first and the last, such as (10, 80), got {value!r}")
        return numbers
    if name in _LISTS:
        return _whole_numbers(name, value)
    if name == "name" and (not isinstance(value, str) or len(value) > _LONGEST_NAME):
        raise ParameterError(f"name must be a text of at most {_LONGEST_NAME} letters, got {value!r}")
    return value


def _whole_numbers(name: str, value: Any) -> tuple[int, ...]:
    if isinstance(value, str) or not isinstance(value, Iterable):
        raise ParameterError(f"{name} must be whole numbers, such as (10, 80), got {value!r}")
    numbers = tuple(value)
    for number in numbers:
        whole_number(name, abs(number) if isinstance(number, int | np.integer) else number, 0)
    return tuple(int(number) for number in numbers)
