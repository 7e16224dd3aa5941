"""The finest grid of windows that are not too small, from the areas of smaller ones."""

from collections.abc import Sequence

import numpy as np

from cytodisk.arrays import FloatArray

_MARGIN = 1.1  # areas of other windows are interpolated


def finest_grid(
    areas: Sequence[FloatArray], median_px: float, least_px: float, *, fewer_layers: bool = True
) -> tuple[int, int] | None:
    """Layers and sectors of the grid with the most windows that are large enough in all of some frames.

    Parameters
    ----------
    areas : sequence of ndarray of shape (layers, sectors) and dtype float
        Areas of windows of one grid in square pixels, by frame.
    median_px, least_px : float
        That the median and the smallest window must have.
    fewer_layers : bool
        Whether the layers can be others; those by depth cannot.

    Returns
    -------
    (int, int) or None
        Of several grids with about as many windows the one most like the given; None if there is none.

    Notes
    -----
    Layers and sectors of a coarser grid are unions of parts of the given ones. A window that is cut has its
    area shared out evenly, which is exact where the coarser grid's borders are borders of the given one.
    """
    layers, sectors = areas[0].shape
    summed = _summed(areas)
    found: list[tuple[int, int]] = []
    for some in range(1, layers + 1) if fewer_layers else (layers,):
        rows = _at(summed, 1, some)
        fits = [count for count in _counts(sectors) if _large(_at(rows, 2, count), median_px, least_px)]
        if fits:
            found.append((some, max(fits)))
    if not found:
        return None
    most = max(a * b for a, b in found)
    ratio = layers / sectors
    near = [grid for grid in found if grid[0] * grid[1] >= 0.8 * most]
    return min(near, key=lambda grid: abs(np.log(grid[0] / grid[1] / ratio)))


def finest_grid_with_nucleus(
    areas: Sequence[FloatArray],
    nucleus_layers: int,
    median_px: float,
    least_px: float,
    *,
    fewer_layers: bool = True,
) -> tuple[int, int, int] | None:
    """As `finest_grid` for windows of a cytoplasm and a nucleus: layers, sectors, and layers of the nucleus.

    Parameters
    ----------
    areas : sequence of ndarray of shape (layers, sectors) and dtype float
        As for `finest_grid`; cells without a nucleus have no area in its layers.
    nucleus_layers : int
        How many of the layers, the last ones, are in the nucleus.
    median_px, least_px : float
        That the median and the smallest window of each compartment must have.
    fewer_layers : bool
        Whether the cytoplasm can have fewer layers.

    Returns
    -------
    (int, int, int) or None
    """
    layers, sectors = len(areas[0]) - nucleus_layers, areas[0].shape[1]
    with_nucleus = [area for area in areas if np.nansum(area[layers:]) > 0] or list(areas)
    outer, inner = (
        _summed([area[:layers] for area in areas]),
        _summed([area[layers:] for area in with_nucleus]),
    )
    outer_layers = range(1, layers + 1) if fewer_layers else (layers,)
    found: list[tuple[int, int, int]] = []
    for count in _counts(sectors):
        fits, fits_inside = (
            [some for some in choices if _large(_at(_at(summed, 1, some), 2, count), median_px, least_px)]
            for summed, choices in ((outer, outer_layers), (inner, range(1, nucleus_layers + 1)))
        )
        if fits and fits_inside:
            found.append((max(fits), count, max(fits_inside)))
    if not found:
        return None
    most = max((a + c) * b for a, b, c in found)
    near = [grid for grid in found if (grid[0] + grid[2]) * grid[1] >= 0.8 * most]
    return min(near, key=lambda grid: abs(np.log(grid[0] / grid[1] / (layers / sectors))))


def _summed(areas: Sequence[FloatArray]) -> FloatArray:
    """Areas cumulated over layers and sectors, from 0, shape (frames, layers + 1, sectors + 1)."""
    layers, sectors = areas[0].shape
    summed = np.zeros((len(areas), layers + 1, sectors + 1))
    summed[:, 1:, 1:] = np.cumsum(np.cumsum(np.nan_to_num(np.stack(areas)), axis=1), axis=2)
    return summed


def _counts(sectors: int) -> list[int]:
    """Numbers of sectors that are looked at: all if they are few, then round ones."""
    return [count for count in range(1, sectors + 1) if count <= 20 or count % 4 == 0 or count == sectors]


def _at(summed: FloatArray, axis: int, count: int) -> FloatArray:
    """Cumulated areas at the borders of `count` equal parts along an axis."""
    size = summed.shape[axis] - 1
    place = np.linspace(0.0, size, count + 1)
    before = np.minimum(place.astype(int), size - 1)
    share = np.expand_dims(place - before, [k for k in range(summed.ndim) if k != axis])
    low, high = (summed.take(before + k, axis=axis) for k in (0, 1))
    return np.asarray(low + share * (high - low))


def _large(summed: FloatArray, median_px: float, least_px: float) -> bool:
    areas = np.diff(np.diff(summed, axis=1), axis=2).reshape(len(summed), -1)
    if (areas > 0).all():
        least, middle = areas.min(axis=1), np.median
    else:
        areas = np.where(areas > 0, areas, np.nan)  # layers deeper than the cell have none
        least, middle = np.nanmin(areas, axis=1), np.nanmedian
    return bool((least >= _MARGIN * least_px).all() and (middle(areas, axis=1) >= _MARGIN * median_px).all())
