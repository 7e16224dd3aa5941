"""A raw mask → one cell without holes, and a report of every change that took."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from cytodisk.arrays import BoolArray
from cytodisk.errors import MaskError
from cytodisk.geometry.fragments import holes_in, largest_piece, pixels_around
from cytodisk.geometry.mask_parameters import CleaningParameters, Holes
from cytodisk.geometry.mask_values import parse_mask
from cytodisk.geometry.outline import has_one_outline, pixel_edges
from cytodisk.geometry.placed_mask import PlacedMask
from cytodisk.taking import takes

# Shares from which on a mask gets a QC flag: area in dropped pieces, area in holes, edge on the border.
_LARGE_DROPPED, _FLAGGED_DROPPED, _FLAGGED_FILLED, _FLAGGED_BORDER = 0.1, 0.005, 0.02, 0.5
_FLAGGED_EXCLUDED = 0.1  # of the area within the outline
_IF_CELLS = "if they are cells, number the pieces (--label)"


@dataclass(frozen=True)
class MaskReport:
    """What cleaning found and changed. Areas in pixels.

    Attributes
    ----------
    area_px : int
        Pixels of the cell: of the cleaned mask, without excluded holes.
    components : int
        Connected pieces (8-connected) that came.
    dropped_px : int
        Pixels of all pieces but the largest; they are not part of the cell any more.
    holes : int
        Holes (4-connected background) that came.
    filled_px : int
        Pixels of those holes that are part of the cell now.
    border_share : float
        Share of the cell's pixel edges that lie on the image border, 0 to 1; above 0 the cell may go
        on outside the image.
    excluded_px : int
        Pixels of the holes that are no part of the cell, though its map goes over them.
    nucleus_in_holes_px : int
        Pixels that count as cell of the holes that its nucleus lies in: many masks leave it out.

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
    excluded_px: int = 0
    nucleus_in_holes_px: int = 0

    @property
    def outline_px(self) -> int:
        """Pixels within the outline, those of all holes among them."""
        return self.area_px + self.excluded_px

    @property
    def excluded_share(self) -> float:
        """Share of these that are in excluded holes, 0 to 1."""
        return self.excluded_px / self.outline_px

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
        notes += self._hole_notes
        if self.touches_border:
            notes.append(f"touches the image border ({self.border_share:.1%} of its edge)")
        return tuple(notes)

    @property
    def _hole_notes(self) -> list[str]:
        filled = self.filled_px - self.nucleus_in_holes_px
        left = [
            (filled, "filled", filled / self.area_px),
            (self.excluded_px, "excluded", self.excluded_share),
        ]
        if not self.nucleus_in_holes_px:
            holes = _count(self.holes, "hole")
            return [f"{holes} {what} ({number} px, {share:.1%})" for number, what, share in left if number]
        notes = [f"the nucleus lies in a hole of the mask ({self.nucleus_in_holes_px} px)"]
        return notes + [
            f"{number} px of holes {what} ({share:.1%})" for number, what, share in left if number
        ]

    @property
    def qc_flags(self) -> tuple[str, ...]:
        """What speaks against this being the mask of one cell, in words; a user should look at it."""
        qc_flags = []
        if self.dropped_px > _LARGE_DROPPED * self.area_px:
            qc_flags.append(f"perhaps more than one cell: a large fragment was dropped; {_IF_CELLS}")
        elif self.dropped_px > _FLAGGED_DROPPED * self.area_px:
            found = _count(self.components - 1, "small piece")
            qc_flags.append(f"{found} dropped ({self.dropped_px} px): {_IF_CELLS}")
        if self.filled_px - self.nucleus_in_holes_px > _FLAGGED_FILLED * self.area_px:
            qc_flags.append(
                "perhaps several touching cells: what was a hole is measured as cell; a vacuole is left out "
                "by holes='exclude' (--holes exclude)"
            )
        if self.excluded_share > _FLAGGED_EXCLUDED:
            qc_flags.append(
                f"holes take {self.excluded_share:.0%} of the area within the outline: windows there hold "
                "less, or nothing"
            )
        if self.border_share > _FLAGGED_BORDER:
            qc_flags.append("perhaps inverted or cut off: most of its edge is the image border")
        return tuple(qc_flags)


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


@dataclass(frozen=True, eq=False)
class FilledMask:
    """The mask of a cell without holes, and the holes.

    Attributes
    ----------
    filled : ndarray of shape (H, W) and dtype bool
        The largest piece, all holes filled: the mask that is mapped.
    holes : ndarray of shape (H, W) and dtype bool, or None
        Pixels of it that are holes; None if there are none.
    report : MaskReport
    """

    filled: BoolArray
    holes: BoolArray | None
    report: MaskReport

    @classmethod
    def of(cls, mask: Any) -> FilledMask:
        """The largest piece of a raw mask, and its holes; the report counts these as filled.

        Raises
        ------
        MaskError
            The mask is not one, or is empty (EmptyMaskError).
        """
        raw = parse_mask(mask)
        placed = PlacedMask.of(raw)
        piece, holes, report = _pieces(placed.box)
        solid = piece if holes is None else piece | holes
        if report.components > 1 or report.holes:
            raw = replace(placed, box=solid).whole
        report = replace(report, border_share=_border_share(raw, solid))
        return cls(raw, None if holes is None else replace(placed, box=holes).whole, report)

    def under(self, policy: Holes, nucleus: BoolArray | None = None) -> FilledMask:
        """The same where holes are treated by a policy.

        Parameters
        ----------
        policy : {"fill", "exclude", "error"}
        nucleus : ndarray of shape (H, W) and dtype bool, optional
            Pixels that are part of the cell even in a hole.

        Returns
        -------
        FilledMask
            Its holes are those that are excluded.

        Raises
        ------
        MaskError
            The policy is "error", and there are holes.
        """
        if self.holes is None:
            return self
        holes, in_nucleus, report = self.holes, 0, self.report
        if nucleus is not None:
            in_nucleus, holes = int((holes & nucleus).sum()), holes & ~nucleus
        left = report.filled_px - in_nucleus
        if policy == "fill" or not left:
            around = 0 if nucleus is None else pixels_around(self.holes, nucleus)
            return FilledMask(self.filled, None, replace(report, nucleus_in_holes_px=around))
        if policy == "error":
            found = f"{_count(report.holes, 'hole')} ({left} px)"
            if in_nucleus:
                found = f"holes beside the nucleus ({left} px)"
            raise MaskError(
                f"mask has {found}: fill them, or pass holes='fill', or 'exclude' to leave them out of all "
                "windows (--holes exclude)"
            )
        excluded = replace(report, area_px=report.area_px - left, filled_px=in_nucleus, excluded_px=left)
        excluded = replace(excluded, nucleus_in_holes_px=in_nucleus)
        return FilledMask(self.filled, holes, excluded)


@takes(CleaningParameters)
def clean_mask(mask: Any, **settings: Any) -> tuple[BoolArray, MaskReport]:
    """Reduce a mask to one piece without holes, and count every change.

    Nothing else is changed: no opening, no closing, since thin protrusions are data.

    Parameters
    ----------
    mask : array_like of shape (H, W)
        One cell: boolean, whole numbers with one value beside 0, or floats that are 0 and 1.
    **settings
        See `CleaningParameters`.

    Returns
    -------
    mask : ndarray of shape (H, W) and dtype bool
        With `holes="exclude"` it still has its holes.
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
    policies = CleaningParameters.of(**settings)
    found = FilledMask.of(mask)
    if policies.fragments == "error" and found.report.components > 1:
        raise MaskError(f"mask has {found.report.components} pieces: keep one, or pass fragments='largest'")
    found = found.under(policies.holes)
    if policies.border == "error" and found.report.touches_border:
        raise MaskError("mask touches the image border: leave the cell out, or pass border='flag'")
    return found.filled if found.holes is None else found.filled & ~found.holes, found.report


def _pieces(crop: BoolArray) -> tuple[BoolArray, BoolArray | None, MaskReport]:
    """The largest piece, its holes if it has any, and what that changed but for the border."""
    if has_one_outline(crop):
        return crop, None, MaskReport(int(crop.sum()), 1, 0, 0, 0, 0.0)
    piece, components, dropped = largest_piece(crop)
    holes, n_holes = holes_in(piece)
    filled = 0 if holes is None else int(holes.sum())
    return piece, holes, MaskReport(int(piece.sum()) + filled, components, dropped, n_holes, filled, 0.0)


def _border_share(mask: BoolArray, crop: BoolArray) -> float:
    on_border = sum(int(side.sum()) for side in (mask[0], mask[-1], mask[:, 0], mask[:, -1]))
    return on_border / pixel_edges(np.pad(crop, 1)) if on_border else 0.0
