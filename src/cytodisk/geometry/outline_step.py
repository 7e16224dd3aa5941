"""The step of an outline: 1 px, or more for a mask that was drawn small and scaled up."""

import numpy as np

from cytodisk.arrays import FloatArray

_FEWEST_RUNS = 20  # a box or a cross has fewer
_SHORT_SHARE = 0.06  # of runs may be shorter than the step: where a crop or a retouch cut a block
_STAIRS_SHARE = 0.6  # of runs at least belong to stairs; in teeth of a comb half of them do
_USUAL_SHARE = 0.3  # of runs at least are one step long, as stairs of a curve are


def outline_step(outline_yx: FloatArray) -> int:
    """Length of the stairs' steps in the outline of a mask, in pixels.

    A curve drawn on pixels goes in stairs, and along each stretch of it one of both directions takes steps
    of a single pixel. After a mask is scaled up by s, no straight run is shorter than s.

    Parameters
    ----------
    outline_yx : ndarray of shape (N, 2) and dtype float
        As `trace_outline` gives it: one point half-way along each side of a pixel.

    Returns
    -------
    int
        1 for a mask drawn at the size of its pixels, for one with few corners, or one of long straight edges.

    Examples
    --------
    >>> import numpy as np
    >>> import cytodisk as cd
    >>> from cytodisk.geometry.outline import trace_outline
    >>> mask = cd.simulate.disk(12)
    >>> outline_step(trace_outline(mask)), outline_step(trace_outline(np.kron(mask, np.ones((4, 4))) > 0))
    (1, 4)
    """
    runs, levels = straight_runs(outline_yx)
    if len(runs) < _FEWEST_RUNS or _stairs_share(levels) < _STAIRS_SHARE:
        return 1
    step = int(np.quantile(runs, _SHORT_SHARE, method="higher"))
    usual = np.mean((runs >= step) & (runs <= step + 1))
    return step if usual >= _USUAL_SHARE else 1


def straight_runs(outline_yx: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Straight stretches of an outline along rows and columns, which take turns.

    Parameters
    ----------
    outline_yx : ndarray of shape (N, 2) and dtype float
        As `trace_outline` gives it.

    Returns
    -------
    lengths : ndarray of shape (R,) and dtype float
        In pixels.
    levels : ndarray of shape (R,) and dtype float
        The y of a stretch along a row, the x of one along a column.
    """
    along_row = outline_yx[:, 0] % 1.0 != 0.0  # the side lies between two rows
    level = np.where(along_row, outline_yx[:, 0], outline_yx[:, 1])
    starts = np.flatnonzero((along_row != np.roll(along_row, 1)) | (level != np.roll(level, 1)))
    return np.diff(starts, append=starts[0] + len(outline_yx)).astype(np.float64), level[starts]


def _stairs_share(levels: FloatArray) -> float:
    """Share of stretches that are steps of stairs: those before and after go the same way."""
    rise = np.sign(np.roll(levels, -2) - levels)  # direction of the next stretch
    return float(np.mean(rise == np.roll(rise, 2)))
