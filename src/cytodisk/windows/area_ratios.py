"""Areas of windows in a cell, beside those that the grid gives them."""

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.windows.polar_layout import PolarLayout


def area_ratios(grid: PolarLayout, areas: FloatArray) -> FloatArray:
    """Each window's share of the area of its compartment over its share of that in the disk.

    Parameters
    ----------
    grid : PolarLayout
        With the radii of the cell.
    areas : ndarray of shape (layers, sectors) and dtype float
        In the cell.

    Returns
    -------
    ndarray of shape (present layers, sectors) and dtype float
    """
    by_layer, compartments = areas.sum(axis=1), grid.compartments
    whole = np.array([by_layer[compartments == name].sum() for name in compartments])
    shares, present = areas / whole[:, None], grid.present
    return np.asarray(shares[present] / grid.area_shares[present, None])
