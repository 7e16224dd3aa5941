"""The mask of a nucleus → one piece without holes inside its cell, and a report of every change."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, get_args

import numpy as np
from scipy import ndimage

from cytodisk.arrays import BoolArray
from cytodisk.checks import one_of
from cytodisk.errors import MaskError, NucleusError
from cytodisk.geometry.mask_values import parse_mask
from cytodisk.geometry.nucleus_pieces import NucleusPieces, joined, listed_areas, without_holes
from cytodisk.geometry.nucleus_report import NucleusReport, SeveralPolicy
from cytodisk.geometry.outline import has_one_outline
from cytodisk.geometry.placed_mask import PlacedMask

MOST_OUTSIDE = 0.1
"""Share of a nucleus that may lie outside its cell, and is clipped; above, it is refused."""

MOST_AT_EDGE = 0.2
"""Share of a nucleus' outline at the cell's edge or beyond that is clipped; above, it is refused.

Of a round nucleus this much lies there as soon as 2 or 3 % of its area are outside.
"""

THE_CELL = 0.95
"""Share of a cell from which on a nucleus that covers it is the cell itself."""

_EIGHT = np.ones((3, 3), dtype=bool)


def fit_nucleus(
    mask: Any, nucleus: Any, *, several: SeveralPolicy = "refuse"
) -> tuple[BoolArray, NucleusReport]:
    """Reduce the mask of a nucleus to one piece without holes inside its cell, and count every change.

    Between nucleus and cell edge at least one pixel of cytoplasm is left: all eight neighbours of each
    pixel of the nucleus belong to the cell. What touches or crosses the edge is clipped to that.

    Parameters
    ----------
    mask : array_like of shape (H, W)
        One cell, as `clean_mask` returns it.
    nucleus : array_like of shape (H, W)
        The cell's nucleus: boolean, or whole numbers, where each label is a nucleus.
    several : {"refuse", "largest", "join"}
        What to do with several nuclei: refuse them, take the largest, or join them along the shortest way
        inside the cell. A piece of less than a tenth of the largest is a speck, and dropped.

    Returns
    -------
    nucleus : ndarray of shape (H, W) and dtype bool
        One 8-connected piece without holes.
    report : NucleusReport

    Raises
    ------
    NucleusError
        It is no mask, of another shape, empty, the cell's own mask, several nuclei, more than 10 % of it
        lies outside the cell, or more than 20 % of its outline at the cell's edge or beyond: a round nucleus
        with 2 or 3 % of its area outside.
    MaskError
        The cell's mask is in pieces, or has holes.
    ParameterError
        An unknown policy.

    See Also
    --------
    map_to_disk : Fits its nucleus in the same way.
    clean_mask : The same for the cell.

    Examples
    --------
    >>> import cytodisk as cd
    >>> cell = cd.simulate.disk(20)
    >>> nucleus = cd.simulate.disk(8, margin=20)
    >>> fitted, report = cd.fit_nucleus(cell, nucleus)
    >>> int(nucleus.sum()), report.area_px, report.notes
    (197, 197, ())
    """
    one_of("several", several, get_args(SeveralPolicy))
    cell = parse_mask(mask)
    labels = parse_nucleus(nucleus, cell.shape)
    placed = PlacedMask.of(cell | (labels != 0))
    inside = cell[placed.slices]
    if not has_one_outline(inside):
        raise MaskError("mask has holes or several pieces: pass it through clean_mask first")
    fitted, report = _fitted(inside, labels[placed.slices], several)
    return replace(placed, box=fitted).whole, report


def parse_nucleus(nucleus: Any, shape: tuple[int, ...]) -> Any:
    """Check that an array is the mask of a nucleus in an image of some shape.

    Parameters
    ----------
    nucleus : array_like of shape (H, W)
        Boolean, whole numbers from 0, or floats that are 0 and 1. Of a DataArray the dims y and x may come in
        any order.
    shape : (int, int)
        That of the cell's mask.

    Returns
    -------
    ndarray of shape (H, W) and dtype bool or int
        Whole numbers stay, since each label may be a nucleus.

    Raises
    ------
    NucleusError
    """
    if getattr(nucleus, "dims", None) == ("x", "y"):  # a DataArray goes by its names
        nucleus = nucleus.transpose("y", "x")
    try:
        array = np.asarray(nucleus)
    except ValueError as error:
        raise NucleusError(f"nucleus must be an array of shape (H, W): {error}") from error
    if array.shape != shape:
        raise NucleusError(
            f"nucleus has shape {array.shape}, the cell's mask {shape}: pass masks of one image, with the "
            "same height and width"
        )
    if array.dtype.kind == "f":
        if not np.isin(array, (0.0, 1.0)).all():
            raise NucleusError(
                f"nucleus is {array.dtype} with values other than 0 and 1: pass a mask, as image > threshold"
            )
        array = array == 1.0
    if array.dtype.kind not in "biu":
        raise NucleusError(f"nucleus must be boolean or numeric, got dtype {array.dtype}: pass nucleus > 0")
    if array.dtype.kind == "i" and array.min(initial=0) < 0:
        raise NucleusError(
            f"nucleus has negative values (down to {array.min()}): set what is no nucleus to 0"
        )
    if not array.any():
        raise NucleusError("nucleus is empty: no pixel belongs to it; leave nucleus out for a plain map")
    return array


def _fitted(cell: BoolArray, labels: Any, several: SeveralPolicy) -> tuple[BoolArray, NucleusReport]:
    given = labels != 0
    _check_other(cell, given)
    pieces = NucleusPieces.of(labels)
    chosen = pieces.mask_of(_chosen(pieces, cell, several))
    solid = without_holes(chosen)
    _check_inside(solid, cell)
    room: BoolArray = ndimage.binary_erosion(cell, _EIGHT)  # what is outside the image is no cell
    at_edge = _share_outside(solid, room)
    if at_edge > MOST_AT_EDGE:
        raise NucleusError(
            f"{100 * at_edge:.1f} % of the nuclear outline lies at the cell's edge or outside (at most "
            f"{100 * MOST_AT_EDGE:.0f} % is clipped){_area_words(solid, cell)}, so no cytoplasm is between "
            "them there: correct the masks, or leave the cell out"
        )
    one = _one_piece(solid & room, room, several)
    fitted = without_holes(one)
    added, paths = fitted & ~given, one & ~solid & ~given
    return fitted, NucleusReport(
        area_px=_count(fitted),
        n_nuclei=int(pieces.nuclei.sum()),
        dropped_px=_count(given & ~chosen & ~fitted),
        holes=_count_holes(solid & ~chosen) + _count_holes(fitted & ~one),
        filled_px=_count(added & ~paths),
        outside_px=_count(chosen & ~cell),
        clipped_px=_count(chosen & cell & ~fitted),
        clipped_share=at_edge,
        joined_px=_count(paths),
    )


def _count(mask: BoolArray) -> int:
    return int(np.count_nonzero(mask))


def _count_holes(holes: BoolArray) -> int:
    return int(ndimage.label(holes)[1]) if holes.any() else 0


def _check_other(cell: BoolArray, nucleus: BoolArray) -> None:
    """Raise NucleusError for a nucleus that is a cell: this one, or one around it."""
    covered = _count(cell & nucleus) / _count(cell)
    if covered <= THE_CELL:
        return
    if _count(cell) < THE_CELL * _count(nucleus):
        raise NucleusError(
            "the cell lies inside the nucleus: are the two masks swapped? Pass the cell's first, and then "
            "nucleus=…"
        )
    raise NucleusError(
        f"the nucleus covers {100 * covered:.0f} % of the cell: the same mask twice, or a cell's mask "
        "without cytoplasm? Pass the mask of the nucleus alone, and that of the whole cell"
    )


def _chosen(pieces: NucleusPieces, cell: BoolArray, several: SeveralPolicy) -> BoolArray:
    """Which pieces are taken, shape (n,)."""
    nuclei = pieces.nuclei
    if nuclei.sum() == 1:
        return nuclei
    within = nuclei & (2 * pieces.inside(cell) > pieces.areas)
    if several == "refuse":
        raise NucleusError(_several_words(pieces, within))
    candidates = within if within.any() else nuclei
    if several == "join":
        return candidates
    largest = np.zeros_like(candidates)
    largest[np.argmax(candidates)] = True  # they stand by area
    return largest


def _several_words(pieces: NucleusPieces, within: BoolArray) -> str:
    nuclei = pieces.nuclei
    elsewhere = int((nuclei & ~within).sum())
    if elsewhere:
        return (
            f"nucleus holds {nuclei.sum()} nuclei, {elsewhere} of them outside the cell: pass the cell's own "
            "alone, as nuclei == label; match_nuclei tells which it is"
        )
    return (
        f"the cell has {nuclei.sum()} nuclei, of {listed_areas(pieces.areas[nuclei])}: split it if it is "
        "several cells (guide 'Cells with their nuclei'), or take several='largest' (--several largest) or "
        "several='join'"
    )


def _check_inside(nucleus: BoolArray, cell: BoolArray) -> None:
    outside = _count(nucleus & ~cell) / _count(nucleus)
    if outside == 1 and (ndimage.binary_dilation(nucleus, _EIGHT, iterations=2) & cell).any():
        raise NucleusError(
            "the nucleus lies outside the cell, right beside it: if the mask is that of the cytoplasm, open "
            "where the nucleus is, pass cells | nuclei as the cell's mask; else correct the masks"
        )
    if outside == 1:
        raise NucleusError(
            "the nucleus lies outside the cell, no pixel in common: pass masks of one image and frame, and "
            "the cell's own nucleus; match_nuclei tells which it is"
        )
    if outside > MOST_OUTSIDE:
        raise NucleusError(
            f"{100 * outside:.0f} % of the nucleus lies outside the cell (at most {100 * MOST_OUTSIDE:.0f} % "
            "is clipped): correct the masks, or pass the cell's own nucleus; match_nuclei tells which it is"
        )


def _area_words(nucleus: BoolArray, cell: BoolArray) -> str:
    outside = _count(nucleus & ~cell) / _count(nucleus)
    return f", with {100 * outside:.1f} % of its area outside" if outside else ""


def _share_outside(nucleus: BoolArray, room: BoolArray) -> float:
    """Share of the edges of the nucleus' pixels along its outline whose pixel lies outside a room."""
    padded, sides = np.pad(nucleus, 1), np.zeros(nucleus.shape, dtype=np.int64)
    for beside in (padded[2:, 1:-1], padded[:-2, 1:-1], padded[1:-1, 2:], padded[1:-1, :-2]):
        sides += nucleus & ~beside
    return float(sides[~room].sum() / sides.sum())


def _one_piece(nucleus: BoolArray, room: BoolArray, several: SeveralPolicy) -> BoolArray:
    """A clipped nucleus without what clipping cut off, or several joined."""
    if has_one_outline(nucleus):
        return nucleus
    pieces = NucleusPieces.of(nucleus)
    nuclei = pieces.nuclei
    if several == "join":
        return joined(np.where(pieces.mask_of(nuclei), pieces.numbered, 0), room)
    if several == "refuse" and nuclei.sum() > 1:
        raise NucleusError(
            f"the cell's edge cuts the nucleus into {nuclei.sum()} parts, of "
            f"{listed_areas(pieces.areas[nuclei])}: correct the masks, or take the largest part with "
            "several='largest' (--several largest)"
        )
    largest: BoolArray = pieces.numbered == 1
    return largest
