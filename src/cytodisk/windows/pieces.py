"""Into how many pieces windows fall."""

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from cytodisk.arrays import BoolArray, IntArray

_NEIGHBOURS = ((0, 1), (1, -1), (1, 0), (1, 1))  # half of the eight: the others are these backwards


def pieces_by_window(weights: sparse.csr_array, mask: BoolArray) -> IntArray:
    """Number of 8-connected pieces of the pixels that each window has a share in.

    Parameters
    ----------
    weights : csr_array of shape (windows, pixels)
        Pixels of the mask in row-major order.
    mask : ndarray of shape (H, W) and dtype bool

    Returns
    -------
    ndarray of shape (windows,) and dtype int
        0 for a window without pixels.
    """
    n_windows, n_pixels = weights.shape
    entries = weights.tocoo()
    held = entries.data > 0
    window, pixel = entries.row[held].astype(np.int64), entries.col[held].astype(np.int64)
    keys = np.sort(window * n_pixels + pixel)
    window, pixel = np.divmod(keys, n_pixels)
    number = np.full(np.add(mask.shape, 2), -1, dtype=np.int64)
    number[1:-1, 1:-1][mask] = np.arange(n_pixels)
    place = np.argwhere(mask)[pixel] + 1
    first, second = [], []
    for step in _NEIGHBOURS:
        beside = number[tuple((place + step).T)]
        wanted = window * n_pixels + beside
        found = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
        joined = (beside >= 0) & (keys[found] == wanted)
        first.append(np.flatnonzero(joined))
        second.append(found[joined])
    ends = np.concatenate(first), np.concatenate(second)
    graph = sparse.coo_array((np.ones(len(ends[0]), dtype=bool), ends), shape=(len(keys), len(keys)))
    n_pieces, piece = connected_components(graph, directed=False)
    owner = np.zeros(n_pieces, dtype=np.int64)
    owner[piece] = window
    return np.bincount(owner, minlength=n_windows)
