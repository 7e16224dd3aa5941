"""The pixel size of a run, from what its files say."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from cytodisk.errors import SignalError
from cytodisk.images.frames import FrameFile

_ALIKE = 1.01  # largest over least size of files that agree


def common_pixel_size(files: Sequence[FrameFile]) -> float | None:
    """The pixel size that files agree on, in µm; None when none of them knows.

    Raises
    ------
    SignalError
        They differ by more than 1 %.
    """
    known = {file.path: file.scale.pixel_size_um for file in files if file.scale.pixel_size_um is not None}
    if not known:
        return None
    first, size = next(iter(known.items()))
    for path, other in known.items():
        if not alike(size, other):
            raise SignalError(
                f"pixel sizes differ: {first} says {size:g} µm, {path} {other:g} µm: "
                "pass the right one, as --pixel-size"
            )
    return size


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


def alike(size: float, other: float) -> bool:
    """Whether two sizes differ by 1 % at most."""
    return max(size, other) <= _ALIKE * min(size, other)
