"""The scale of a run, from what its files say."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Literal, TypeAlias

from cytodisk.errors import SignalError
from cytodisk.images.frame_file import FrameFile
from cytodisk.scale import alike

Quantity: TypeAlias = Literal["pixel_size_um", "frame_interval_s"]

_WORDS = {
    "pixel_size_um": ("pixel size", "µm", "--pixel-size"),
    "frame_interval_s": ("frame interval", "s", "--frame-interval"),
}


def agreed(files: Sequence[FrameFile], quantity: Quantity) -> float | None:
    """What files agree on; None when none of them knows.

    Parameters
    ----------
    files : sequence of FrameFile
        The first that knows counts.
    quantity : {"pixel_size_um", "frame_interval_s"}

    Returns
    -------
    float or None
        In µm or seconds.

    Raises
    ------
    SignalError
        They differ by more than 1 %.
    """
    said = [(file.path, getattr(file.scale, quantity)) for file in files]
    known = [(path, value) for path, value in said if value is not None]
    if not known:
        return None
    first, value = known[0]
    name, unit, flag = _WORDS[quantity]
    for path, other in known:
        if not alike(value, other):
            raise SignalError(
                f"{name}s differ: {first} says {value:g} {unit}, {path} {other:g} {unit}: "
                f"pass the right one, as {flag}"
            )
    return float(value)


def most_common_size(sizes: Iterable[float]) -> float | None:
    """The size that most agree with, the first of equals; None without any.

    Parameters
    ----------
    sizes : iterable of float
        In µm.

    Returns
    -------
    float or None
    """
    counts = Counter(sizes)
    supporters = {size: sum(n for other, n in counts.items() if alike(size, other)) for size in counts}
    return max(supporters, key=lambda size: supporters[size], default=None)
