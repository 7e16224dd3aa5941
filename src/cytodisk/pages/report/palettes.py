"""Colour maps as the pages' scripts take them."""

from __future__ import annotations

import matplotlib as mpl
import numpy as np
from matplotlib.colors import to_hex


def palette(name: str) -> list[str]:
    """256 colours of a colour map as "#rrggbb"."""
    return [to_hex(colour) for colour in mpl.colormaps[name](np.linspace(0, 1, 256))]
