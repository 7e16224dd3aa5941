"""Which nucleus belongs to which cell, from what their labels share."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.errors import NucleusError
from cytodisk.geometry.fragments import SEVERAL_FROM
from cytodisk.geometry.nucleus_mask import MOST_OUTSIDE, THE_CELL
from cytodisk.images.nuclei.label_overlaps import LabelOverlaps

MatchStatus: TypeAlias = Literal["ok", "none", "several", "partly outside", "shared", "no cell"]

_HOLDS = 0.5  # share of a nucleus from which on a cell holds it


@dataclass(frozen=True)
class NucleusMatch:
    """The nuclei of a cell, or a nucleus without a cell.

    Attributes
    ----------
    cell : int or None
        Label; None for a nucleus that no cell holds.
    nuclei : tuple of int
        Labels of the cell's nuclei, the largest first.
    specks : tuple of int
        Labels of what lies in the cell but has less than a tenth of its largest nucleus.
    overlap : float
        Share of the nuclei's area that lies inside the cell; NaN without a nucleus.
    status : {"ok", "none", "several", "partly outside", "shared", "no cell"}
    reason : str
        What the status means here; empty for "ok".
    """

    cell: int | None
    nuclei: tuple[int, ...]
    specks: tuple[int, ...]
    overlap: float
    status: MatchStatus
    reason: str

    @property
    def labels(self) -> str:
        """Labels of the nuclei, as "3" or "3,7"."""
        return ",".join(map(str, self.nuclei))


def matches_of(overlaps: LabelOverlaps) -> Iterator[NucleusMatch]:
    """Give each nucleus to the cell that holds most of it.

    Parameters
    ----------
    overlaps : LabelOverlaps

    Yields
    ------
    NucleusMatch
        The cells by label, then the nuclei that no cell holds.
    """
    sharing = _Sharing(overlaps)
    for place in range(len(overlaps.cells)):
        yield sharing.of_cell(place)
    for nucleus in np.flatnonzero(~sharing.held):
        yield sharing.without_cell(int(nucleus))


def check_nuclei(overlaps: LabelOverlaps) -> None:
    """Raise NucleusError where the nuclei are the cells, or around them.

    Parameters
    ----------
    overlaps : LabelOverlaps
    """
    of_cell, of_nucleus = overlaps.pairs.T
    covered = overlaps.shared_px > THE_CELL * overlaps.cell_px[of_cell]
    n_with, n_covered = len(np.unique(of_cell)), int(np.count_nonzero(covered))
    if not n_covered or 2 * n_covered < n_with:
        return
    larger = overlaps.cell_px[of_cell] < THE_CELL * overlaps.nucleus_px[of_nucleus]
    if 2 * (larger & covered).sum() > n_covered:
        raise NucleusError(
            f"{n_covered} of {n_with} cells lie inside a nucleus: are the two swapped? Pass the cells first, "
            "and then the nuclei"
        )
    raise NucleusError(
        f"{n_covered} of {n_with} cells are covered by a nucleus: are these the masks of the cells twice? "
        "Pass those of the nuclei"
    )


class _Sharing:
    """What cells and nuclei share, by cell and by nucleus."""

    def __init__(self, overlaps: LabelOverlaps):
        self._all = overlaps
        shares = overlaps.shared_px / overlaps.nucleus_px[overlaps.pairs[:, 1]]
        order = np.argsort(-shares, kind="stable")  # the larger share first, of equal ones the first cell
        self._cells, self._nuclei, self._shares = (*overlaps.pairs[order].T, shares[order])
        owner, best = np.full(len(overlaps.nuclei), -1), np.zeros(len(overlaps.nuclei))
        found, first = np.unique(self._nuclei, return_index=True)
        owner[found], best[found] = self._cells[first], self._shares[first]
        self._owner, self._best = owner, best
        self.held = best >= _HOLDS  # by nucleus
        self._by_cell = _grouped(self._cells, len(overlaps.cells))
        self._by_nucleus = _grouped(self._nuclei, len(overlaps.nuclei))

    def of_cell(self, cell: int) -> NucleusMatch:
        """The match of the cell at a place."""
        label, pairs = int(self._all.cells[cell]), self._by_cell[cell]
        own = self._nuclei[pairs]
        own = own[self.held[own] & (self._owner[own] == cell)]
        if not len(own):
            return self._without_nucleus(label, pairs)
        areas = self._all.nucleus_px[own]
        own, areas = own[np.argsort(-areas, kind="stable")], -np.sort(-areas)
        large = areas >= SEVERAL_FROM * areas[0]
        nuclei = own[large]
        overlap = float((self._best[nuclei] * areas[large]).sum() / areas[large].sum())
        status, reason = self._judged(nuclei, overlap)
        return NucleusMatch(label, self._labels(nuclei), self._labels(own[~large]), overlap, status, reason)

    def without_cell(self, nucleus: int) -> NucleusMatch:
        """The match of a nucleus at a place that no cell holds."""
        where = self._where(nucleus) or "it lies in no cell"
        return NucleusMatch(
            None, self._labels(np.array([nucleus])), (), float(self._best[nucleus]), "no cell", where
        )

    def _judged(self, nuclei: IntArray, overlap: float) -> tuple[MatchStatus, str]:
        for nucleus in nuclei:
            if self._is_shared(nucleus):
                return "shared", f"of nucleus {self._all.nuclei[nucleus]}, {self._where(nucleus)}"
        if len(nuclei) > 1:
            return "several", f"{len(nuclei)} nuclei lie in the cell"
        if 1 - overlap > MOST_OUTSIDE:
            return "partly outside", f"{_percent(1 - overlap)} of the nucleus lies outside the cell"
        return "ok", ""

    def _without_nucleus(self, label: int, pairs: IntArray) -> NucleusMatch:
        for nucleus in self._nuclei[pairs]:
            if self._is_shared(nucleus):
                words = f"of nucleus {self._all.nuclei[nucleus]}, {self._where(nucleus)}"
                return NucleusMatch(label, (), (), np.nan, "shared", words)
        words = "no nucleus lies in the cell"
        if len(pairs):  # the one that lies in it with most of itself
            nucleus, share = self._nuclei[pairs[0]], self._shares[pairs[0]]
            words += f"; nucleus {self._all.nuclei[nucleus]} does with {_percent(share)} of its area"
        return NucleusMatch(label, (), (), np.nan, "none", words)

    def _is_shared(self, nucleus: int) -> bool:
        return bool((self._shares[self._by_nucleus[nucleus]] > MOST_OUTSIDE).sum() > 1)

    def _where(self, nucleus: int) -> str:
        """As "55 % lie in label 3 and 45 % in label 4": cells of the tables have other numbers."""
        pairs = self._by_nucleus[nucleus]
        words = [
            f"{_percent(share)} {'lie ' if number == 0 else ''}in label {self._all.cells[cell]}"
            for number, (cell, share) in enumerate(zip(self._cells[pairs], self._shares[pairs], strict=True))
        ]
        return " and ".join(words)

    def _labels(self, places: IntArray) -> tuple[int, ...]:
        return tuple(self._all.nuclei[places].tolist())


def _grouped(places: IntArray, count: int) -> list[IntArray]:
    """Places of each number in an array of numbers, in their order."""
    order = np.argsort(places, kind="stable")
    return np.split(order, np.searchsorted(places[order], np.arange(1, count))) if count else []


def _percent(share: float | FloatArray) -> str:
    return f"{100 * float(share):.0f} %"
