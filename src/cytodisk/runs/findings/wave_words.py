"""Numbers of a wave in words: how many, how fast, which way on the picture, how long from crest to crest."""

from __future__ import annotations

import math
from typing import Any

from cytodisk.number_words import counted
from cytodisk.scale import Scale

_ONE_WAY, _MOSTLY = 0.8, 0.5
_SECOND_DIGITS = 2


def waves_around(mode: float) -> str:
    """As "2 waves around the cell", or "all around at once" for none."""
    if mode == 0:
        return "all around at once"
    return f"{counted(int(mode), 'wave')} around the cell"


def period_words(row: Any, scale: Scale) -> str:
    """As "period 95 s", or "period 12 frames" where the frame interval is unknown."""
    return f"period {time_words(row['period'], scale)}"


def time_words(frames: float, scale: Scale) -> str:
    """A time in frames in the unit that suits it, as "95 s"; "an unknown time" for NaN."""
    if not math.isfinite(frames):
        return "an unknown time"
    return scale.shown_time(frames).words(scale.time(float(frames)), 2 if frames < 1000 else 3)


def speed_words(speed: float, scale: Scale, frames: float) -> str:
    """The size of a speed in the unit that suits it, as "0.12 µm/s"; its sign is said by the way.

    Parameters
    ----------
    speed : float
        In the study's unit of velocity.
    scale : Scale
    frames : float
        Those of the movie, which decide between seconds, minutes and hours.
    """
    return scale.shown_velocity(abs(speed), frames).words(abs(speed), _SECOND_DIGITS)


def wave_numbers(row: Any, scale: Scale) -> str:
    """The numbers of a wave, which way it runs, and where on the picture that is.

    Parameters
    ----------
    row : mapping
        Of a table of waves, with the frames of the movie.
    scale : Scale

    Returns
    -------
    str
        As "2 waves around the cell, 0.12 µm/s clockwise as seen in the image (towards higher sectors), period
        95 s"; of other kinds than rotating without speed and way.
    """
    parts = [waves_around(row["mode"])] if row["mode"] else []
    if row["kind"] == "rotating":
        way = row["way"]
        higher = "higher" if way == "clockwise" else "lower"
        known = math.isfinite(row["edge_speed"])
        speed = f"{speed_words(row['edge_speed'], scale, row['frames'])} " if known else ""
        parts.append(f"{speed}{way} as seen in the image (towards {higher} sectors)")
    return ", ".join([*parts, period_words(row, scale)])


def course_words(row: Any, scale: Scale) -> str:
    """How much of the wave runs this way, and how long a crest takes around the cell."""
    share = abs(row["direction"])
    much = "Nearly all of it runs" if share >= _ONE_WAY else "Most of it runs" if share >= _MOSTLY else ""
    first = f"{much} this way" if much else "Part of it runs the other way"
    return f"{first}; one crest is once around the cell after {time_words(_turn(row), scale)}."


def _turn(row: Any) -> float:
    """Frames that a crest takes once around."""
    return float(row["period"] * max(row["mode"], 1))


def chance_words(row: Any) -> str:
    """As "p = 0.002"."""
    return f"p = {row['p']:.2g}"
