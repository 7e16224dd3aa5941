"""A raw mask → one cell without holes, and a report of every change that took."""

from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from scipy import ndimage

from cytodisk.arrays import BoolArray
from cytodisk.errors import EmptyMaskError, MaskError, ParameterError
from cytodisk.geometry.outline import has_one_outline, pixel_edges
from cytodisk.geometry.placed_mask import PlacedMask

# Shares from which on a mask gets a QC flag: area in dropped pieces, area in holes, edge on the border.
_LARGE_DROPPED, _FLAGGED_DROPPED, _FLAGGED_FILLED, _FLAGGED_BORDER = 0.1, 0.005, 0.02, 0.5
_IF_CELLS = "if they are cells, number the pieces (--label)"
_EIGHT = np.ones((3, 3), dtype=bool)
_FOUR = ndimage.generate_binary_structure(2, 1)


@dataclass(frozen=True)
class MaskReport:
    """What cleaning found and changed. Areas in pixels.

    Attributes
    ----------
    area_px : int
        Pixels of the cleaned mask.
    components : int
        Connected pieces (8-connected) that came.
    dropped_px : int
        Pixels of all pieces but the largest; they are not part of the cell any more.
    holes : int
        Holes (4-connected background) that were filled.
    filled_px : int
        Pixels of those holes; they are part of the cell now.
    border_share : float
        Share of the cell's pixel edges that lie on the image border, 0 to 1; above 0 the cell may go
        on outside the image.

    Examples
    --------
    >>> import cytodisk as cd
    >>> mask = cd.simulate.disk(20)
    >>> mask[20:25, 20:25] = False
    >>> _, report = cd.clean_mask(mask)
    >>> report.holes, report.filled_px
    (1, 25)
    >>> report.notes
    ('1 hole filled (25 px, 2.0%)',)
    """

    area_px: int
    components: int
    dropped_px: int
    holes: int
    filled_px: int
    border_share: float

    @property
    def touches_border(self) -> bool:
        """Whether any pixel of the cell lies on the image border."""
        return self.border_share > 0

    @property
    def notes(self) -> tuple[str, ...]:
        """What a user should know, in words; empty when nothing was changed or cut off."""
        notes = []
        if self.components > 1:
            share = self.dropped_px / (self.dropped_px + self.area_px - self.filled_px)
            notes.append(
                f"{_count(self.components - 1, 'fragment')} dropped ({self.dropped_px} px, {share:.1%})"
            )
        if self.holes:
            share = self.filled_px / self.area_px
            notes.append(f"{_count(self.holes, 'hole')} filled ({self.filled_px} px, {share:.1%})")
        if self.touches_border:
            notes.append(f"touches the image border ({self.border_share:.1%} of its edge)")
        return tuple(notes)

    @property
    def qc_flags(self) -> tuple[str, ...]:
        """What speaks against this being the mask of one cell, in words; a user should look at it."""
        qc_flags = []
        if self.dropped_px > _LARGE_DROPPED * self.area_px:
            qc_flags.append(f"perhaps more than one cell: a large fragment was dropped; {_IF_CELLS}")
        elif self.dropped_px > _FLAGGED_DROPPED * self.area_px:
            found = _count(self.components - 1, "small piece")
            qc_flags.append(f"{found} dropped ({self.dropped_px} px): {_IF_CELLS}")
        if self.filled_px > _FLAGGED_FILLED * self.area_px:
            qc_flags.append("perhaps several touching cells: what was a hole is measured as cell")
        if self.border_share > _FLAGGED_BORDER:
            qc_flags.append("perhaps inverted or cut off: most of its edge is the image border")
        return tuple(qc_flags)


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def parse_mask(mask: Any) -> BoolArray:
    """Check that an array is the mask of one cell and make it boolean.

    Parameters
    ----------
    mask : array_like of shape (H, W)
        Boolean, or numbers with at most one value beside 0 (for floats: exactly 0 and 1). Of a DataArray the
        dims y and x may come in any order.

    Returns
    -------
    ndarray of shape (H, W) and dtype bool

    Raises
    ------
    MaskError
        Not 2D, several labels, or floats other than 0 and 1.
    EmptyMaskError
        No pixel belongs to the cell.
    """
    if getattr(mask, "dims", None) == ("x", "y"):  # a DataArray goes by its names
        mask = mask.transpose("y", "x")
    try:
        array = np.asarray(mask)
    except ValueError as error:
        raise MaskError(f"mask must be an array of shape (H, W): {error}") from error
    if array.ndim != 2:
        raise MaskError(
            f"mask must be 2D, got shape {array.shape}: pass one image, for a stack one frame at a time"
        )
    if array.dtype == bool:
        parsed: BoolArray = array
    elif np.issubdtype(array.dtype, np.integer):
        parsed = _parse_integers(array)
    elif np.issubdtype(array.dtype, np.floating):
        parsed = _parse_floats(array)
    else:
        raise MaskError(f"mask must be boolean or numeric, got dtype {array.dtype}: pass mask > 0")
    if not parsed.any():
        raise EmptyMaskError(f"mask of shape {array.shape} is empty: no pixel belongs to the cell")
    return parsed


def _parse_integers(array: np.ndarray[Any, Any]) -> BoolArray:
    if array.min(initial=0) < 0:
        raise MaskError(f"mask has negative values (down to {array.min()}): set what is no cell to 0")
    inside: BoolArray = array != 0
    values = array[inside]
    if values.size and values.min() != values.max():
        labels = np.unique(values)
        raise MaskError(
            f"mask holds {len(labels)} labels ({labels[0]} … {labels[-1]}): pass one cell, as mask == label, "
            "or where each label is a cell, kind='labels' (--kind labels)"
        )
    return inside


def _parse_floats(array: np.ndarray[Any, Any]) -> BoolArray:
    if np.isin(array, (0.0, 1.0)).all():
        return np.asarray(array == 1.0)
    if not np.isfinite(array).all():
        raise MaskError(
            f"mask is {array.dtype} with values that are NaN or infinite: set what is no cell to 0"
        )
    raise MaskError(
        f"mask is {array.dtype} with values other than 0 and 1 "
        f"({array.min():g} … {array.max():g}): "
        "threshold it first, as image > threshold"
    )


def clean_mask(
    mask: Any,
    *,
    holes: Literal["fill", "error"] = "fill",
    fragments: Literal["largest", "error"] = "largest",
    border: Literal["flag", "error"] = "flag",
) -> tuple[BoolArray, MaskReport]:
    """Reduce a mask to one piece without holes, and count every change.

    Nothing else is changed: no opening, no closing, since thin protrusions are data.

    Parameters
    ----------
    mask : array_like of shape (H, W)
        One cell: boolean, whole numbers with one value beside 0, or floats that are 0 and 1.
    holes : {"fill", "error"}
        What to do with background enclosed by the cell (4-connected).
    fragments : {"largest", "error"}
        What to do with several pieces (8-connected): keep the largest (the first of equals), or raise.
    border : {"flag", "error"}
        What to do with a cell at the image border: note it in the report, or raise.

    Returns
    -------
    mask : ndarray of shape (H, W) and dtype bool
    report : MaskReport

    Raises
    ------
    MaskError
        The mask is not one, is empty (EmptyMaskError), or a policy is "error" and its case came.
    ParameterError
        An unknown policy.

    See Also
    --------
    map_to_disk : Cleans its mask in the same way.

    References
    ----------
    u-Unwrap, section 2: a map exists for any shape without holes, which filling makes sure of.

    Examples
    --------
    >>> import cytodisk as cd
    >>> mask = cd.simulate.disk(10)
    >>> mask[1, 1] = True  # a speck
    >>> cleaned, report = cd.clean_mask(mask)
    >>> report.dropped_px, int(mask.sum() - cleaned.sum())
    (1, 1)
    """
    _check_policies(holes, fragments, border)
    raw = parse_mask(mask)
    placed = PlacedMask.of(raw)
    solid, report = _cleaned(placed.box)
    if report.components > 1 or report.holes:
        raw = replace(placed, box=solid).whole
    report = replace(report, border_share=_border_share(raw, solid))
    if fragments == "error" and report.components > 1:
        raise MaskError(f"mask has {report.components} pieces: keep one, or pass fragments='largest'")
    if holes == "error" and report.holes:
        found = f"{report.holes} holes ({report.filled_px} px)"
        raise MaskError(f"mask has {found}: fill them, or pass holes='fill'")
    if border == "error" and report.touches_border:
        raise MaskError("mask touches the image border: leave the cell out, or pass border='flag'")
    return raw, report


def _cleaned(crop: BoolArray) -> tuple[BoolArray, MaskReport]:
    if has_one_outline(crop):
        return crop, MaskReport(int(crop.sum()), 1, 0, 0, 0, 0.0)
    piece, components, dropped = _largest_piece(crop)
    solid, n_holes = _filled(piece)
    filled = int(solid.sum() - piece.sum())
    return solid, MaskReport(int(solid.sum()), components, dropped, n_holes, filled, 0.0)


def _check_policies(holes: str, fragments: str, border: str) -> None:
    known = (("holes", holes, "fill"), ("fragments", fragments, "largest"), ("border", border, "flag"))
    for name, value, other in known:
        if value not in (other, "error"):
            raise ParameterError(f"{name} must be {other!r} or 'error', got {value!r}")


def _largest_piece(raw: BoolArray) -> tuple[BoolArray, int, int]:
    labels, count = ndimage.label(raw, structure=_EIGHT)
    if count == 1:
        return raw, 1, 0
    areas = np.bincount(labels.ravel())[1:]
    piece: BoolArray = labels == 1 + int(areas.argmax())
    return piece, int(count), int(areas.sum() - areas.max())


def _filled(piece: BoolArray) -> tuple[BoolArray, int]:
    # Background is 4-connected where the cell is 8-connected, so that a diagonal contact closes a hole.
    labels, count = ndimage.label(np.pad(~piece, 1, constant_values=True), structure=_FOUR)
    if count == 1:
        return piece, 0
    solid: BoolArray = (labels != labels[0, 0])[1:-1, 1:-1]
    return solid, int(count) - 1


def _border_share(mask: BoolArray, crop: BoolArray) -> float:
    on_border = sum(int(side.sum()) for side in (mask[0], mask[-1], mask[:, 0], mask[:, -1]))
    return on_border / pixel_edges(np.pad(crop, 1)) if on_border else 0.0
