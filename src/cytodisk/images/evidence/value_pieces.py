"""How the values of a frame lie: in pieces, alike or mixed, thick or as thin rims."""

from __future__ import annotations

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components
from skimage import measure

from cytodisk.arrays import AnyArray, IntArray
from cytodisk.images.label_boxes import Strips


def share_alike(strips: Strips) -> float:
    """Share of neighbours in a row, both with a label, that have the same; 1 without any."""
    alike, both = 0, 0
    for _, strip in strips:
        if not strip.any():  # most of a large image, and quickly seen
            continue
        left, right = strip[:, :-1], strip[:, 1:]
        inside = (left != 0) & (right != 0)
        both += int(inside.sum())
        alike += int(((left == right) & inside).sum())
    return alike / both if both else 1.0


def count_pieces(strips: Strips) -> int:
    """Number of 8-connected pieces of one value, over all labels of a frame."""
    total = 0
    seams: list[IntArray] = []
    above: tuple[AnyArray, IntArray] | None = None
    for _, strip in strips:
        if not strip.any():
            above = None
            continue
        pieces, count = measure.label(  # type: ignore[no-untyped-call,unused-ignore]
            strip, background=0, connectivity=2, return_num=True
        )
        if above is not None:
            seams.append(_joined(*above, strip[0], pieces[0] + total))
        above = strip[-1].copy(), pieces[-1].astype(np.int64) + total
        total += int(count)
    if not seams:
        return total
    ends = np.unique(np.concatenate(seams), axis=0)
    if not len(ends):
        return total
    names, place = np.unique(ends, return_inverse=True)
    first, second = place.reshape(-1, 2).T
    graph = sparse.coo_array((np.ones(len(ends), dtype=bool), (first, second)), shape=(len(names),) * 2)
    together, _ = connected_components(graph, directed=False)
    return total - (len(names) - int(together))


def _joined(above: AnyArray, pieces_above: IntArray, below: AnyArray, pieces_below: IntArray) -> IntArray:
    """Pieces of two rows that touch, shape (N, 2)."""
    pairs = []
    width = len(above)
    for step in (-1, 0, 1):
        up = slice(max(0, -step), width - max(0, step))
        down = slice(max(0, step), width - max(0, -step))
        joined = (above[up] == below[down]) & (above[up] != 0)
        pairs.append(np.column_stack([pieces_above[up][joined], pieces_below[down][joined]]))
    return np.unique(np.concatenate(pairs), axis=0)


def thick_values(strips: Strips) -> AnyArray:
    """The values that fill a square of 3 × 3 pixels somewhere, sorted; 0 may be among them."""
    found: list[AnyArray] = []
    before: AnyArray | None = None
    for _, strip in strips:
        rows = strip if before is None else np.concatenate([before, strip])
        before = rows[-2:].copy()
        if len(rows) < 3 or rows.shape[1] < 3:
            continue
        if not rows.any():
            found.append(np.zeros(1, rows.dtype))
            continue
        down, right = rows[1:] == rows[:-1], rows[:, 1:] == rows[:, :-1]
        three = right[:, 1:] & right[:, :-1]
        filled = three[:-2] & three[1:-1] & three[2:] & (down[1:] & down[:-1])[:, 1:-1]
        found.append(np.unique(rows[1:-1, 1:-1][filled]))
    return np.unique(np.concatenate(found)) if found else np.empty(0)


def touching_values(strips: Strips) -> AnyArray:
    """The values beside 0 that lie side by side with another one beside 0, sorted."""
    found: list[AnyArray] = []
    before: AnyArray | None = None
    for _, strip in strips:
        rows = strip if before is None else np.concatenate([before, strip])
        before = rows[-1:].copy()
        if not rows.any():
            continue
        for one, other in ((rows[1:], rows[:-1]), (rows[:, 1:], rows[:, :-1])):
            touch = (one != other) & (one != 0) & (other != 0)
            found += [np.unique(one[touch]), np.unique(other[touch])]
    return np.unique(np.concatenate(found)) if found else np.empty(0)
