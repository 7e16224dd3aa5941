"""Nuclei drawn into real outlines of cells, for benchmarks."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import tifffile
from scipy.ndimage import distance_transform_edt

import cytodisk as cd
from cytodisk.arrays import BoolArray
from cytodisk.errors import MaskError

SHARE_OF_DEPTH = 0.5
"""Radius of a drawn nucleus over the depth of its cell."""

LEAST_PX = 12
"""Area below which a drawn nucleus is too small to be one."""


def drawn_nucleus(mask: BoolArray, share: float = SHARE_OF_DEPTH) -> BoolArray:
    """A round nucleus at the deepest place of a cell.

    Parameters
    ----------
    mask : ndarray of shape (H, W) and dtype bool
    share : float
        Its radius over the distance of that place from the edge.

    Returns
    -------
    ndarray of shape (H, W) and dtype bool
    """
    depth = distance_transform_edt(np.pad(mask, 1))[1:-1, 1:-1]
    place = np.unravel_index(int(depth.argmax()), depth.shape)
    row, column = np.indices(mask.shape)
    away = (row - place[0]) ** 2 + (column - place[1]) ** 2
    return np.asarray(away <= (share * depth.max()) ** 2)


def cells_with_drawn_nuclei(path: Path, step: int = 1) -> Iterator[tuple[int, BoolArray, BoolArray]]:
    """Number, mask and drawn nucleus of the cells of a stack of masks, or of one cell in so many.

    Cells without room for a nucleus of 12 px are left out.
    """
    for number, image in enumerate(tifffile.imread(path)):
        if number % step:
            continue
        try:
            mask, _ = cd.clean_mask(image > 0)
        except MaskError:
            continue
        rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
        mask = mask[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
        nucleus = drawn_nucleus(mask)
        if nucleus.sum() >= LEAST_PX:
            yield number, mask, nucleus
