"""Scale from what a microscope measured: times of frames, height and width of a pixel."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cytodisk.checks import LARGEST_SCALE, SMALLEST_SCALE
from cytodisk.scale import alike

UNEVEN = 0.2
"""Frames are unevenly spaced where a step differs by more than this share from the median step."""


def interval_of(times_s: Sequence[float]) -> tuple[float | None, tuple[str, ...]]:
    """Frame interval from the times of frames, and what is wrong with them.

    Parameters
    ----------
    times_s : sequence of float
        Of all frames, in order, in seconds.

    Returns
    -------
    (float or None, tuple of str)
        The mean step in seconds; None with a note where frames are unevenly spaced or out of order, None
        alone for fewer than two frames.

    Examples
    --------
    >>> from cytodisk.images.formats.measured_scale import interval_of
    >>> interval_of([0.0, 5.0, 10.1])[0]
    5.05
    >>> interval_of([0.0, 5.0, 60.0])[0] is None
    True
    """
    times = np.asarray(times_s, dtype=np.float64)
    if len(times) < 2:
        return None, ()
    steps = np.diff(times)
    typical = float(np.median(steps))
    if not np.isfinite(steps).all() or typical <= 0 or steps.min() <= 0:
        return None, (
            "the times of its frames do not grow: the frame interval is unknown; give it with "
            "--frame-interval",
        )
    if np.abs(steps - typical).max() > UNEVEN * typical:
        return None, (
            f"its frames are unevenly spaced ({steps.min():.3g} to {steps.max():.3g} s apart): the frame "
            "interval is taken as unknown; give it with --frame-interval",
        )
    return float(times[-1] - times[0]) / (len(times) - 1), ()


def agreed_interval(
    times_s: Sequence[float], set_s: float | None, frames: int
) -> tuple[float | None, tuple[str, ...]]:
    """Frame interval from the times of frames and the interval that was set.

    Parameters
    ----------
    times_s : sequence of float
        Of all frames, in seconds; others are as good as none.
    set_s : float or None
        In seconds; None or 0 where none was set.
    frames : int
        How many there are.

    Returns
    -------
    (float or None, tuple of str)
        None with a note where the two disagree, or the times make no sense.
    """
    planned = set_s if set_s is not None and np.isfinite(set_s) and set_s > 0 else None
    if frames < 2:
        return None, ()
    if len(times_s) != frames:
        return _believable(planned, ())
    measured, notes = interval_of(times_s)
    if measured is None or planned is None or abs(measured - planned) <= UNEVEN * planned:
        return _believable(measured, notes)
    return None, (
        f"its frames were {measured:.4g} s apart and {planned:.4g} s was set: the frame interval is taken as "
        "unknown; give it with --frame-interval",
    )


def _believable(interval_s: float | None, notes: tuple[str, ...]) -> tuple[float | None, tuple[str, ...]]:
    """An interval that a movie can have, or a note on what is wrong with it."""
    if interval_s is None or SMALLEST_SCALE <= interval_s <= LARGEST_SCALE:
        return interval_s, notes
    return None, (
        f"its frame interval of {interval_s:g} s makes no sense: it is taken as unknown; give it with "
        "--frame-interval",
    )


def pixel_size_of(sizes_um: Sequence[float | None]) -> tuple[float | None, tuple[str, ...], str]:
    """Pixel size from the height and width of a pixel, and what is wrong with it.

    Parameters
    ----------
    sizes_um : sequence of (float or None)
        Height and width, in µm; None where the file does not say.

    Returns
    -------
    (float or None, tuple of str, str)
        The size, None where unknown; a note where it makes no sense; and the fault of pixels that are not
        square, for which no map is right.
    """
    known = [size for size in sizes_um if size is not None]
    if len(known) < len(sizes_um):
        return None, (), ""
    if not all(SMALLEST_SCALE <= size <= LARGEST_SCALE for size in known):
        words = " × ".join(f"{size:g}" for size in known)
        return None, (f"its pixel size of {words} µm makes no sense; give it with --pixel-size",), ""
    if not alike(*known):
        words = " × ".join(f"{size:.4g}" for size in known)
        return None, (), f"has pixels of {words} µm: resample it to square pixels"
    return float(f"{known[-1]:.9g}"), (), ""
