"""Label images of cells and of their nuclei, with the list of which nucleus lies where."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any, Literal, TypeAlias, get_args

import numpy as np
import pandas as pd

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.checks import whole_number
from cytodisk.errors import ParameterError
from cytodisk.geometry.mask import clean_mask
from cytodisk.simulate.cells import disk
from cytodisk.simulate.drawing import half_covered
from cytodisk.simulate.label_images import cell_masks, packed
from cytodisk.simulate.nuclei.cells_with_nuclei import deepest_place
from cytodisk.simulate.nuclei.nucleus_shapes import oval
from cytodisk.simulate.random_cells import random_smooth

NucleusCase = Literal["one", "none", "two", "shared", "partly outside", "no cell"]
NUCLEUS_CASES: tuple[NucleusCase, ...] = get_args(NucleusCase)
LabelImage: TypeAlias = np.ndarray[Any, np.dtype[np.uint16]]

_RADIUS_SHARES = 0.35, 0.7  # of a nucleus, of the depth of the cell where it lies
_SHARED_SHARE = 0.65  # of a shared nucleus, in the cell that has more of it
_INSIDE_SHARE = 0.98  # of a nucleus that lies partly outside of its cell
_ASIDE = 20  # px beside a cell for what stands out of it
_LOOSE_RADIUS = 6.0  # px, of a nucleus without a cell


@dataclass(frozen=True, eq=False)
class CellsWithNuclei:
    """Label images of cells and of nuclei, and which belong together.

    Attributes
    ----------
    cells, nuclei : ndarray of shape (H, W) and dtype uint16
        Labels are 1, 2, …, those of the nuclei in another order than those of the cells.
    truth : DataFrame
        A row for each cell, and one with cell 0 for each nucleus without a cell. Columns: `cell`; `nuclei`,
        labels as text, such as "3" or "3,7", and "" for none; `n_nuclei`; `overlap`, share of the nuclei's
        area that lies in this cell, NaN without a nucleus; `case`, one of `NUCLEUS_CASES`. A nucleus that two
        cells share stands in the rows of both.

    Examples
    --------
    >>> import cytodisk as cd
    >>> field = cd.simulate.label_image_with_nuclei(cells=4, without=1, two=0, shared=0)
    >>> field.truth["case"].value_counts().sort_index().to_dict()
    {'no cell': 1, 'none': 1, 'one': 2, 'partly outside': 1}
    """

    cells: LabelImage
    nuclei: LabelImage
    truth: pd.DataFrame


def label_image_with_nuclei(
    cells: int = 12,
    seed: int = 0,
    *,
    without: int = 1,
    two: int = 1,
    shared: int = 1,
    partly_outside: int = 1,
    loose: int = 1,
) -> CellsWithNuclei:
    """Many cells with their nuclei, as a segmentation program returns them, with its usual faults.

    Parameters
    ----------
    cells : int
        In all, at least 1 and at most 65 535. Those that no other parameter speaks of have one nucleus.
    seed : int
        The same seed gives the same images.
    without : int
        Cells without a nucleus.
    two : int
        Cells with two nuclei.
    shared : int
        Pairs of neighbours that share one nucleus, because they were parted at the wrong place: 65 % of it
        lies in one of them.
    partly_outside : int
        Cells with a nucleus of which 2 to 5 % lies outside.
    loose : int
        Nuclei without a cell.

    Returns
    -------
    CellsWithNuclei

    Raises
    ------
    ParameterError
        A number is out of range, or the faults need more cells than there are.

    See Also
    --------
    label_image : Cells alone.
    cell_with_nucleus : One cell, and where its nucleus lies.

    Examples
    --------
    >>> import cytodisk as cd
    >>> field = cd.simulate.label_image_with_nuclei(cells=8, seed=1)
    >>> int(field.cells.max()), int(field.nuclei.max())
    (8, 8)
    """
    cells = whole_number("cells", cells, 1, 65_535)
    wanted: dict[NucleusCase, int] = {
        "none": whole_number("without", without, 0),
        "two": whole_number("two", two, 0),
        "shared": whole_number("shared", shared, 0),
        "partly outside": whole_number("partly_outside", partly_outside, 0),
        "no cell": whole_number("loose", loose, 0),
    }
    needed = sum(wanted.values()) + wanted["shared"] - wanted["no cell"]
    if needed > cells:
        raise ParameterError(
            f"cells must be at least {needed} for these faults, got {cells}: ask for more cells"
        )
    wanted["one"] = cells - needed
    random = np.random.default_rng([19, whole_number("seed", seed, 0)])
    cases = np.array([case for case in NUCLEUS_CASES for _ in range(wanted[case])], dtype=object)
    random.shuffle(cases)
    return _put_together([_TILES[case](random) for case in cases], random)


@dataclass(frozen=True, eq=False)
class _Tile:
    """A part of the field: labels count from 1 in each tile."""

    cells: LabelImage
    nuclei: LabelImage
    case: NucleusCase


def _put_together(tiles: list[_Tile], random: np.random.Generator) -> CellsWithNuclei:
    corners, (height, width) = packed([tile.cells > 0 for tile in tiles])
    cells, nuclei = np.zeros((2, height + 2, width + 2), dtype=np.uint16)
    names = 1 + random.permutation(sum(int(tile.nuclei.max()) for tile in tiles))
    rows: list[dict[str, Any]] = []
    n_cells = n_nuclei = 0
    for tile, (y, x) in zip(tiles, corners, strict=True):
        own = np.append(0, names[n_nuclei : n_nuclei + int(tile.nuclei.max())])
        part = np.s_[y + 1 : y + 1 + tile.cells.shape[0], x + 1 : x + 1 + tile.cells.shape[1]]
        cells[part] = np.where(tile.cells, tile.cells + n_cells, 0)
        nuclei[part] = own[tile.nuclei]
        rows += _rows(cells[part], nuclei[part], tile.case)
        n_cells, n_nuclei = n_cells + int(tile.cells.max()), n_nuclei + int(tile.nuclei.max())
    columns = ["cell", "nuclei", "n_nuclei", "overlap", "case"]
    return CellsWithNuclei(cells, nuclei, pd.DataFrame(rows, columns=columns))


def _rows(cells: LabelImage, nuclei: LabelImage, case: NucleusCase) -> Iterator[dict[str, Any]]:
    """What a tile shows: a row for each of its cells."""
    for cell in np.unique(cells[cells > 0]) if cells.any() else [0]:
        found = np.unique(nuclei[(cells == cell) & (nuclei > 0)])
        overlap = (np.isin(nuclei, found) & (cells == cell)).sum() / max(np.isin(nuclei, found).sum(), 1)
        yield {
            "cell": int(cell),
            "nuclei": ",".join(map(str, found)),
            "n_nuclei": len(found),
            "overlap": float(overlap) if len(found) and cell else np.nan,
            "case": case,
        }


def _one(random: np.random.Generator) -> _Tile:
    mask, place, radius = _cell(random)
    return _tile(mask, [_nucleus(mask, place, radius, random) & mask], "one")


def _none(random: np.random.Generator) -> _Tile:
    return _tile(_cell(random)[0], [], "none")


def _two(random: np.random.Generator) -> _Tile:
    mask, place, radius = _cell(random)
    radius, angle = 0.5 * radius, random.uniform(0.0, 2.0 * np.pi)
    away = (radius + 1.5) * np.array([np.sin(angle), np.cos(angle)])
    both = [_nucleus(mask, place + side * away, radius) & mask for side in (1.0, -1.0)]
    return _tile(mask, both, "two")


def _shared(random: np.random.Generator) -> _Tile:
    mask = _plain_cell(random)
    place, deep = deepest_place(mask)
    nucleus = _nucleus(mask, place, 0.5 * deep)
    cut = np.quantile(np.nonzero(nucleus)[1], _SHARED_SHARE)
    halves = np.where(np.arange(mask.shape[1]) <= cut, 1, 2)
    return replace(_tile(mask, [nucleus], "shared"), cells=np.where(mask, halves, 0).astype(np.uint16))


def _partly_outside(random: np.random.Generator) -> _Tile:
    """A long nucleus goes to the right until enough of it is outside."""
    mask = np.pad(_plain_cell(random), _ASIDE)
    place, deep = deepest_place(mask)
    long = oval(np.pi * (0.5 * deep) ** 2, elongation=2.5) + place
    while True:
        long = long + np.array([0.0, 0.1])
        nucleus = half_covered(long, (mask.shape[0], mask.shape[1]))
        if (nucleus & mask).sum() <= _INSIDE_SHARE * nucleus.sum():
            return _tile(mask, [nucleus], "partly outside")


def _no_cell(random: np.random.Generator) -> _Tile:
    mask = disk(_LOOSE_RADIUS, margin=1)
    return _tile(np.zeros_like(mask), [mask], "no cell")


def _plain_cell(random: np.random.Generator) -> BoolArray:
    seed, radius = int(random.integers(2**31)), random.uniform(22.0, 28.0)
    return random_smooth(seed, radius=radius, roughness=0.05, margin=0)


def _cell(random: np.random.Generator) -> tuple[BoolArray, FloatArray, float]:
    """A cell, its deepest place and the radius of a nucleus there."""
    mask = clean_mask(cell_masks(1, random)[0])[0]
    place, deep = deepest_place(mask)
    return mask, place, deep * random.uniform(*_RADIUS_SHARES)


def _nucleus(
    mask: BoolArray,
    place: FloatArray,
    radius: float,
    random: np.random.Generator | None = None,
) -> BoolArray:
    """Round, or with a generator an oval that is as long as the round one is wide."""
    elongation = 1.0 if random is None else random.uniform(1.0, 1.6)
    angle = 0.0 if random is None else random.uniform(0.0, np.pi)
    outline = oval(np.pi * radius**2 / elongation, elongation, angle) + place
    return half_covered(outline, (mask.shape[0], mask.shape[1]))


def _tile(mask: BoolArray, nuclei: list[BoolArray], case: NucleusCase) -> _Tile:
    labels = np.zeros(mask.shape, dtype=np.uint16)
    for label, nucleus in enumerate(nuclei, start=1):
        labels[nucleus] = label
    return _Tile(mask.astype(np.uint16), labels, case)


_TILES: dict[NucleusCase, Callable[[np.random.Generator], _Tile]] = {
    "one": _one,
    "none": _none,
    "two": _two,
    "shared": _shared,
    "partly outside": _partly_outside,
    "no cell": _no_cell,
}
