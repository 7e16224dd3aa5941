"""Pixels that pile up at the smallest or the largest value of a cell: clipped and saturated signals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from cytodisk.arrays import IntArray

FEWEST_PIXELS = 25
"""Levels beside the end of the range are pooled until they hold so many pixels."""

_LEAST_SHARE = 0.005  # of the cell's pixels; less is not looked at
_PHOTON_LOSS = 4.0  # zeros of dim, uneven images: so many times a series through the next levels at most
_ABOVE_NEIGHBOURS = 4.0  # times the levels below it that a pile at the top must hold
_ABOVE_AT_CEILING = 2.0  # the same where the value is one at which cameras end
_CEILINGS = (255.0, 1023.0, 4095.0, 16383.0, 65535.0)
_NEARLY_ALL = 0.99
_MOST = 0.75  # at the smallest value: too few pixels are left to tell why
_OF_TWO_LEVELS = 2  # masks and labels: such an image has no range to be cut off


@dataclass(frozen=True)
class Pileup:
    """How much of a cell is at the ends of a signal's range, in the channel that is worst.

    Attributes
    ----------
    clipped, saturated : float
        Share of the cell's pixels that pile up at the smallest and at the largest value.
    clipped_channel, saturated_channel : str
        Channel of that share; empty if it is 0.
    clipped_note : str
        That pixels without a photon would look the same; empty if the share of clipped pixels is sure.
    """

    clipped: float = 0.0
    clipped_channel: str = ""
    saturated: float = 0.0
    saturated_channel: str = ""
    clipped_note: str = ""


def pileup(channels: Sequence[str], values: Any) -> Pileup:
    """Shares of the channel that is clipped most and of the one that is saturated most.

    Parameters
    ----------
    channels : sequence of str
        Their names.
    values : ndarray of shape (C, N)
        Pixels of the cell in each of them.

    Returns
    -------
    Pileup
    """
    clipped, saturated, note = (0.0, ""), (0.0, ""), ""
    for name, of_channel in zip(channels, values, strict=True):
        finite = np.isfinite(of_channel)
        known = of_channel if finite.all() else of_channel[finite]
        share = clipped_share(known)
        if share > clipped[0]:
            clipped, note = (share, name), clipped_note(known)
        saturated = max(saturated, (saturated_share(known), name), key=lambda found: found[0])
    return Pileup(*clipped, *saturated, note)


def clipped_share(values: Any) -> float:
    """Share of values that were cut off at the smallest one.

    A dim image has many zeros too, as many pixels get no photon. There the levels above fall off like a
    series: 0.60, 0.30, 0.08. A clipped signal has one high level, and few values at each of the next ones.
    Where three quarters or more are at the smallest value, the levels above hold too little to tell: that
    share is given whatever they are, and `clipped_note` says whether it is sure. An image of two values is a
    mask or a label, and is not clipped.

    Parameters
    ----------
    values : ndarray of shape (N,)
        Finite.

    Returns
    -------
    float
        0 for zeros that the levels above explain, for a cell that has one value other than 0, and for one of
        two values unless nearly all are the smaller.
    """
    if not values.size:
        return 0.0
    lowest = values.min()
    share = float(np.mean(values == lowest))
    if share < _LEAST_SHARE:
        return 0.0
    if share == 1.0:
        return 1.0 if lowest == 0 else 0.0
    counts = np.unique(values, return_counts=True)[1]
    if len(counts) == _OF_TWO_LEVELS:
        return share if share > _NEARLY_ALL else 0.0
    return share if share >= _MOST or _unexplained(counts) else 0.0


def clipped_note(values: Any) -> str:
    """What to know of a share of clipped values: that a dim image would look the same.

    Parameters
    ----------
    values : ndarray of shape (N,)
        Finite.

    Returns
    -------
    str
        Empty where `clipped_share` is 0, or where the levels above the smallest show that it was cut off.
    """
    share = clipped_share(values)
    counts = np.unique(values, return_counts=True)[1]
    if share < _MOST or share == 1.0 or _unexplained(counts):
        return ""
    return (
        f"most of the cell is {values.min():g}: dim or cut off; the two cannot be told apart at so few "
        "grey levels"
    )


def _unexplained(counts: IntArray) -> bool:
    """Whether more values are at the lowest level than photon noise leaves there, by the next ones."""
    near, next_, levels = _pooled(counts[1:])
    return next_ > 0 and bool(counts[0] > _PHOTON_LOSS * near**2 / next_ / levels)


def saturated_share(values: Any) -> float:
    """Share of values that were cut off at the largest one.

    Parameters
    ----------
    values : ndarray of shape (N,)
        Finite.

    Returns
    -------
    float
        0 for a largest value that is no more frequent than those just below it.
    """
    if not values.size:
        return 0.0
    highest = values.max()
    share = float(np.mean(values == highest))
    at_ceiling = float(highest) in _CEILINGS
    if share < _LEAST_SHARE:
        return 0.0
    if share == 1.0:
        return 1.0 if at_ceiling else 0.0
    counts = np.unique(values, return_counts=True)[1][::-1]
    near, _, levels = _pooled(counts[1:])
    if levels == 0:
        return share if at_ceiling else 0.0
    bar = _ABOVE_AT_CEILING if at_ceiling else _ABOVE_NEIGHBOURS
    return share if counts[0] > bar * near / levels else 0.0


def _pooled(counts: IntArray) -> tuple[float, float, int]:
    """Pixels in the fewest next levels that hold `FEWEST_PIXELS`, in as many after them, and their number.

    The number is 0 if all levels together hold fewer.
    """
    total = np.cumsum(counts)
    levels = 1 + int(np.searchsorted(total, FEWEST_PIXELS))
    if levels > len(counts):
        return 0.0, 0.0, 0
    near = float(total[levels - 1])
    return near, float(total[min(2 * levels, len(counts)) - 1]) - near, levels
