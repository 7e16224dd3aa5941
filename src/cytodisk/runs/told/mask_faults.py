"""A kind of fault of masks with all places that have it; and what leaps from frame to frame."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.runs.qc_flags.area_jumps import (
    JUMP_ADVICE,
    JUMP_MEANING,
    area_steps,
    follows_one_cell,
    leaps,
    without_returns,
)
from cytodisk.runs.qc_flags.column_flags import WITHOUT_MAP, flagged_masks, image_border
from cytodisk.runs.told.place_words import MOST_PLACES

NOT_USABLE, WITHOUT, FLAG, NOTE = "not usable", "without a cell", "QC flag", "note"
BORDER = "QC flag image border"
"""Kinds of faults, as `cytodisk check` heads its lines."""

_FAR = 1.0  # diameters that a cell does not move by from a frame to the next
_NEAR, _LARGEST_STEP = 0.25, float(np.log1p(0.25))  # most steps of one cell are smaller, in place and in area

_ADVICE = {
    NOT_USABLE: WITHOUT_MAP["refused"],
    WITHOUT: WITHOUT_MAP["missing"],
    FLAG: (flagged_masks.meaning, flagged_masks.advice),
    BORDER: (image_border.meaning, image_border.advice),
    NOTE: ("", ""),
}


@dataclass(frozen=True)
class FaultPlace:
    """Where a fault is.

    Attributes
    ----------
    shown : str or int
        As a line of `cytodisk check` names it: the number of a cell or frame, or words.
    source : str
        Name of the file.
    frame, label : int
        The label is 0 where there is no cell.
    words : str
        What was found there.
    yx : (float, float) or None
        (row, column) to look at, in pixels of the image.
    """

    shown: str | int
    source: str
    frame: int
    label: int
    words: str = ""
    yx: tuple[float, float] | None = None

    @property
    def key(self) -> tuple[str, int, int]:
        """Source, frame and label."""
        return self.source, self.frame, self.label


@dataclass
class MaskFault:
    """A kind of fault.

    Attributes
    ----------
    kind : str
        As "not usable".
    words : str
        What the first place says.
    places : list of FaultPlace
    differs : bool
        Whether others have other numbers.
    name : str
        Of a leap between frames, as "area jumps"; such a fault has all its places in its words.
    """

    kind: str
    words: str
    places: list[FaultPlace] = field(default_factory=list)
    differs: bool = False
    name: str = ""

    @property
    def is_between_frames(self) -> bool:
        """Whether frames were compared."""
        return bool(self.name)

    @property
    def meaning(self) -> str:
        """What it means for results."""
        return JUMP_MEANING if self.name else _ADVICE[self.kind][0]

    @property
    def advice(self) -> str:
        """What to do, beside what the words say."""
        return JUMP_ADVICE if self.name else _ADVICE[self.kind][1]


def leap_faults(
    areas: Sequence[int], places: Sequence[FaultPlace], of_label: str, *, named_time: bool
) -> Iterator[MaskFault]:
    """Frames in which the area of a mask leaps, and frames in which it stands elsewhere.

    Parameters
    ----------
    areas : sequence of int
        Of one label, in px.
    places : sequence of FaultPlace
        Its frames.
    of_label : str
        As " of label 3"; empty where there is one.
    named_time : bool
        Whether the file or the user calls the frames a time series. Masks that nobody calls so are compared
        only if most of them differ by 5 % of their area at most.

    Yields
    ------
    MaskFault
        None for masks of different cells.
    """
    step, moved = _steps(areas, places), _moved(areas, places)
    known = np.abs(step[np.isfinite(step)])
    near = bool(known.size and np.nanmedian(moved) <= _NEAR and np.median(known) <= _LARGEST_STEP)
    if not (follows_one_cell(step) or (named_time and near)):
        return
    if found := without_returns(leaps(step), step):
        changes = [f"{np.expm1(one):+.0%}".replace("-", "−") if np.isfinite(one) else "" for one in step]
        yield _between("area jumps", f"the mask's area{of_label} jumps", changes, found, places)
    if found := _far_places(moved, places, areas):
        words = [f"by {value:.1f} of its diameters" for value in moved]
        yield _between("place jumps", f"the mask{of_label} jumps to another place", words, found, places)


def _far_places(moved: FloatArray, places: Sequence[FaultPlace], areas: Sequence[int]) -> list[int]:
    """Steps by more than a diameter, without those that lead back; none where most steps are long."""
    typical = float(np.nanmedian(moved)) if np.isfinite(moved).any() else 0.0
    found = [int(k) for k in np.flatnonzero(moved > max(_FAR, 3 * typical))]
    back = [
        k for k in found if k - 1 in found and _distances(areas, (places[k - 1], places[k + 1]))[0] < _FAR
    ]
    return [k for k in found if k not in back]


def _moved(areas: Sequence[int], places: Sequence[FaultPlace]) -> FloatArray:
    """By how many diameters a mask moves from each frame to the next; NaN where a frame is missing."""
    frame = np.array([place.frame for place in places])
    return np.where(np.diff(frame) == 1, _distances(areas, places), np.nan)


def _distances(areas: Sequence[int], places: Sequence[FaultPlace]) -> FloatArray:
    centre = np.array([(np.nan, np.nan) if place.yx is None else place.yx for place in places])
    diameter = 2.0 * np.sqrt(np.median(areas) / np.pi)
    return np.asarray(np.hypot(*np.diff(centre, axis=0).T) / diameter)


def _steps(areas: Sequence[int], places: Sequence[FaultPlace]) -> FloatArray:
    frame = np.array([place.frame for place in places])
    return area_steps(frame, np.array(areas, dtype=np.float64))


def _between(
    name: str, what: str, changes: Sequence[str], found: Sequence[int], places: Sequence[FaultPlace]
) -> MaskFault:
    words = [f"frames {places[k].frame} and {places[k + 1].frame}: {changes[k]}" for k in found]
    more = f"; … {len(words) - MOST_PLACES} more" if len(words) > MOST_PLACES else ""
    there = [places[k + 1] for k in found]
    told = [
        FaultPlace(place.shown, place.source, place.frame, place.label, said, place.yx)
        for place, said in zip(there, words, strict=True)
    ]
    return MaskFault(FLAG, f"{name}: {what} ({'; '.join(words[:MOST_PLACES])}{more})", told, name=name)
