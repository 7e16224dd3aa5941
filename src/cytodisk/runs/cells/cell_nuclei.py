"""The nucleus of a cell as it comes out of its file: matched, cut out as its cell is, or refused."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from cytodisk.errors import CytodiskError, NucleusError, ReadError, as_data
from cytodisk.images.label_boxes import Box
from cytodisk.images.mask_files import SourceCell
from cytodisk.images.nuclei.frame_matches import FrameMatches
from cytodisk.images.nuclei.nucleus_match import NucleusMatch
from cytodisk.runs.frame_rows import FramePlace


@dataclass(frozen=True)
class CellNucleus:
    """What a file of nuclei says of a cell.

    Attributes
    ----------
    match : NucleusMatch or None
        None where the file, or the cell's mask, cannot be used.
    labels : ndarray of shape (h, w), or None
        Labels of the cell's nuclei alone, cut out as the cell's mask is.
    fault : CytodiskError or None
        Why the file cannot be used.
    strays : tuple of NucleusMatch
        Nuclei of the image that no cell holds, with its first cell.
    """

    match: NucleusMatch | None = None
    labels: np.ndarray[Any, Any] | None = None
    fault: CytodiskError | None = None
    strays: tuple[NucleusMatch, ...] = ()

    def refusal(self, missing: Literal["refuse", "plain", "no choice"]) -> CytodiskError | None:
        """Why the cell is not mapped, as far as the match tells.

        Parameters
        ----------
        missing : {"refuse", "plain", "no choice"}
            What to do with a cell without a nucleus; "no choice" refuses it where no run could do else.
        """
        if self.fault is not None or self.match is None:
            return self.fault
        if self.match.status == "shared":
            return NucleusError(
                f"the cell shares a nucleus ({self.match.reason}): the border of the cells cuts it, or two "
                "nuclei touch and count as one: correct the masks"
            )
        if self.match.status == "none" and missing != "plain":
            without = ", or map such cells without (--missing plain)" if missing == "refuse" else ""
            return NucleusError(f"{self.match.reason}: correct the masks{without}")
        return None

    def rows(self, found: SourceCell | FramePlace) -> Iterator[dict[str, Any]]:
        """Rows of the table of nuclei: that of the cell, and those of nuclei without a cell.

        Parameters
        ----------
        found : SourceCell or FramePlace
            The cell.
        """
        place = {"source": found.source, "frame": found.frame}
        if self.match is not None:
            yield {"cell": found.cell, **place, "label": found.label} | _columns(self.match)
        elif self.fault is not None and found.label:
            told = {"nuclei": "", "n_nuclei": 0, "overlap": None, "status": "unusable"}
            yield {"cell": found.cell, **place, "label": found.label} | told | {"reason": str(self.fault)}
        for stray in self.strays:
            yield {"cell": None, **place, "label": None} | _columns(stray)


def _columns(match: NucleusMatch) -> dict[str, Any]:
    return {
        "nuclei": match.labels,
        "n_nuclei": len(match.nuclei),
        "overlap": match.overlap,
        "status": match.status,
        "reason": match.reason,
    }


def with_nucleus(
    found: SourceCell, matches: FrameMatches | CytodiskError, is_first: bool
) -> tuple[SourceCell, CellNucleus]:
    """A cell with its nuclei cut out of their frame.

    Parameters
    ----------
    found : SourceCell
    matches : FrameMatches or CytodiskError
        Of its frame; the error says why the nuclei cannot be used.
    is_first : bool
        The first cell of its image.

    Returns
    -------
    found : SourceCell
        Its mask has room for all of the nuclei, also where they lie outside the cell.
    nucleus : CellNucleus
    """
    if isinstance(matches, CytodiskError):
        return found, CellNucleus(fault=matches)
    strays = matches.without_cell if is_first else ()
    match = matches.by_cell.get(found.label)
    if match is None or found.mask is None or not match.nuclei:
        return found, CellNucleus(match, strays=strays)
    labels = (*match.nuclei, *match.specks)
    found = _with_room(found, [matches.boxes[label] for label in labels])
    try:
        cut = matches.nuclei.cut(*_box(found))[0]
    except ReadError as fault:
        return found, CellNucleus(match, fault=as_data(fault), strays=strays)
    return found, CellNucleus(match, np.where(np.isin(cut, labels), cut, 0), strays=strays)


def _box(found: SourceCell) -> Box:
    assert found.mask is not None
    (y, x), (height, width) = found.corner, found.mask.shape
    return slice(y, y + height), slice(x, x + width)


def _with_room(found: SourceCell, boxes: list[Box]) -> SourceCell:
    """The same cell with a larger box, if need be; outside of its own box is nothing of it."""
    assert found.mask is not None
    own = _box(found)
    rows, columns = (
        slice(min(side.start for side in sides), max(side.stop for side in sides))
        for sides in zip(own, *boxes, strict=True)
    )
    if (rows, columns) == own:
        return found
    mask = np.zeros((rows.stop - rows.start, columns.stop - columns.start), dtype=found.mask.dtype)
    (y, x), (height, width) = found.corner, found.mask.shape
    top, left = y - rows.start, x - columns.start
    mask[top : top + height, left : left + width] = found.mask
    return replace(found, mask=mask, corner=(rows.start, columns.start))
