"""Are windows of a map empty, and do they sum to the cell?"""

from collections.abc import Sequence

import numpy as np

import cytodisk as cd
from cytodisk.disk.disk_map import DiskMap

SUM_ERROR = 1e-9


def check_windows(disk: DiskMap, grids: Sequence[tuple[int, int]]) -> tuple[int, float]:
    """Number of empty windows, and by how much sums of area and of intensity are off, relative.

    Parameters
    ----------
    disk : DiskMap
    grids : sequence of (int, int)
        Layers and sectors.

    Returns
    -------
    empty : int
    sum_error : float
    """
    signal = np.random.default_rng(0).uniform(1.0, 2.0, disk.mask.shape)
    known = disk.mask.sum(), signal[disk.mask].sum()
    empty, worst = 0, 0.0
    for layers, sectors in grids:
        on_cell = cd.polar_windows(layers, sectors).on(disk)
        found = cd.sample(on_cell, signal)
        sums = on_cell.areas.sum(), float((found["mean"] * found["n_pixels"]).sum())
        empty += int((on_cell.areas <= 0).sum())
        worst = max(worst, *(abs(a / b - 1.0) for a, b in zip(sums, known, strict=True)))
    return empty, float(worst)


def check_compartments(disk: DiskMap, grids: Sequence[tuple[int, int, int]]) -> tuple[int, float]:
    """The same for a map with a nucleus, whose sums must be those of cytoplasm and nucleus one by one.

    Parameters
    ----------
    disk : DiskMap
    grids : sequence of (int, int, int)
        Layers of the cytoplasm, sectors, layers of the nucleus.

    Returns
    -------
    empty : int
    sum_error : float
    """
    signal = np.random.default_rng(0).uniform(1.0, 2.0, disk.mask.shape)
    parts = {"cytoplasm": disk.mask & ~disk.nucleus.mask, "nucleus": disk.nucleus.mask}
    empty, worst = 0, 0.0
    for layers, sectors, nucleus_layers in grids:
        on_cell = cd.polar_windows(layers, sectors, nucleus_layers=nucleus_layers).on(disk)
        found = cd.sample(on_cell, signal)
        totals = (found["mean"] * found["n_pixels"]).to_numpy()
        empty += int((on_cell.areas <= 0).sum())
        for name, part in parts.items():
            rows = on_cell.grid.compartments == name
            sums = on_cell.areas[rows].sum(), totals[rows].sum()
            known = part.sum(), signal[part].sum()
            worst = max(worst, *(abs(a / b - 1.0) for a, b in zip(sums, known, strict=True)))
    return empty, float(worst)
