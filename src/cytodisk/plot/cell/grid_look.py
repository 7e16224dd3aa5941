"""How strong the lines of windows are: the weaker, the more there are, so that a signal below them shows."""

from __future__ import annotations

import numpy as np

_USUAL_WINDOWS = 600  # 10 layers of 60 sectors
_WIDTH, _LEAST_WIDTH, _MOST_WIDTH = 0.18, 0.07, 0.35  # points
_OPACITY, _LEAST_OPACITY, _MOST_OPACITY = 0.28, 0.12, 0.35


def line_width(n_windows: int) -> float:
    """Width of the lines of a grid in a panel of some 40 mm.

    Parameters
    ----------
    n_windows : int

    Returns
    -------
    float
        In points; as the side of a window, it halves where there are four times as many.
    """
    return float(np.clip(_WIDTH * _side(n_windows), _LEAST_WIDTH, _MOST_WIDTH))


def line_opacity(n_windows: int) -> float:
    """Opacity of the lines of a grid over a signal.

    Parameters
    ----------
    n_windows : int

    Returns
    -------
    float
        0 to 1.
    """
    return float(np.clip(_OPACITY * _side(n_windows), _LEAST_OPACITY, _MOST_OPACITY))


def _side(n_windows: int) -> float:
    """Side of a window over that of one of 600."""
    return float(np.sqrt(_USUAL_WINDOWS / max(n_windows, 1)))
