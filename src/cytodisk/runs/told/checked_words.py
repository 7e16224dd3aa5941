"""What `cytodisk check` says of masks: each kind of fault once, with the places that have it, and totals."""

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from cytodisk.images.mask_names import without_name
from cytodisk.number_words import counted
from cytodisk.runs.told.map_words import without_cell_words
from cytodisk.runs.told.mask_faults import (
    BORDER,
    FLAG,
    NOT_USABLE,
    NOTE,
    WITHOUT,
    FaultPlace,
    MaskFault,
    leap_faults,
)
from cytodisk.runs.told.mask_sizes import scale_words, size_words
from cytodisk.runs.told.nuclei_words import nuclei_words, statuses_of
from cytodisk.runs.told.place_words import MOST_PLACES, ranges_words

if TYPE_CHECKING:
    from cytodisk.runs.cells.cell_inputs import CellInputs
    from cytodisk.runs.map.checked_cells import CheckedCell


class Checked:
    """What was seen of the masks of a file, or of a folder of them.

    Parameters
    ----------
    inputs : CellInputs
    """

    def __init__(self, inputs: "CellInputs"):
        self._inputs = inputs
        self._is_stack = inputs.sources[0].kind == "stack" and not inputs.is_folder
        file = inputs.sources[0].file
        self._named_time = file is not None and "T" in file.axes and file.said_by != "nobody"
        self._without: Counter[str] = Counter()
        self._kinds: dict[tuple[str, str], MaskFault] = {}
        self._areas: list[int] = []
        self._by_label: dict[tuple[str, int], list[tuple[int, FaultPlace]]] = {}  # area and place
        self._looked_at = self._unusable = self._on_border = 0
        self._flagged: set[tuple[str, int, int]] = set()
        self._nuclei: Counter[str] = Counter()
        given = inputs.groups
        self._groups = {} if given is None else given.found.texts

    @property
    def faults(self) -> int:
        """Number of cells, files and images that are at fault.

        An image without any cell is no fault in a folder, where such images are usual.
        """
        empty = self._without["no cell"] if self._inputs.is_folder else 0
        return self._unusable + self._without.total() - empty

    @property
    def header(self) -> str:
        """Names of the columns of `line`."""
        file, nuclei = ("file\t" * self._inputs.is_folder, "nuclei\t" * bool(self._inputs.nuclei))
        groups = "".join(f"{name}\t" for name in self._groups)
        return f"cell\t{file}frame\tlabel\t{groups}{nuclei}usable\tremarks"

    def line(self, checked: "CheckedCell") -> str:
        """One cell, with tabs between columns."""
        found, report = checked.found, checked.report
        remarks = [] if report is None else [*report.qc_flags, *report.notes]
        flagged = report is not None and (report.qc_flags or report.touches_border)
        if checked.nucleus_report is not None:
            remarks += [*checked.nucleus_report.qc_flags, *checked.nucleus_report.notes]
            flagged = flagged or checked.nucleus_report.qc_flags
        usable = "no" if checked.reason else "QC flag" if flagged else "yes"
        place = f"{found.cell}\t{found.source}" if self._inputs.is_folder else f"{found.cell}"
        said = self._reason(checked) or "; ".join(remarks)
        nucleus = checked.nucleus
        labels = "" if nucleus is None else "\t" + ("" if nucleus.match is None else nucleus.match.labels)
        groups = "".join(f"\t{self._groups[name][found.cell]}" for name in self._groups)
        return f"{place}\t{found.frame}\t{found.label}{groups}{labels}\t{usable}\t{said}"

    def add(self, checked: "CheckedCell") -> None:
        """Take a cell into account."""
        found, report = checked.found, checked.report
        is_cell = found.label != 0
        self._looked_at += is_cell
        if checked.reason:
            self._note(NOT_USABLE if is_cell else WITHOUT, self._reason(checked), checked)
            self._unusable += is_cell
        if not is_cell:
            self._without[checked.status] += 1
        if checked.nucleus is not None:
            self._nuclei.update(statuses_of(checked.nucleus))
        if report is None:
            return
        self._areas.append(report.area_px)
        self._by_label.setdefault((found.source, found.label), []).append(
            (report.outline_px, self._place(checked))
        )
        of_nucleus = () if checked.nucleus_report is None else checked.nucleus_report.qc_flags
        if report.qc_flags or report.touches_border or of_nucleus:
            self._flagged.add((found.source, found.frame, found.label))
        self._on_border += report.touches_border
        for flag in (*report.qc_flags, *of_nucleus):
            self._note(FLAG, flag, checked)
        for note in (*report.notes, *(checked.nucleus_report.notes if checked.nucleus_report else ())):
            self._note(BORDER if note.startswith("touches the image border") else NOTE, note, checked)

    def _reason(self, checked: "CheckedCell") -> str:
        is_folder = self._inputs.is_folder
        return without_name(checked.reason, checked.found.source) if is_folder else checked.reason

    def _note(self, what: str, words: str, checked: "CheckedCell") -> None:
        alike = re.sub(r"[0-9]+(\.[0-9]+)?", "N", words).replace("fragments", "fragment")
        known = self._kinds.setdefault((what, alike.replace("holes", "hole")), MaskFault(what, words))
        known.differs |= words != known.words
        known.places.append(self._place(checked, words))

    def _place(self, checked: "CheckedCell", words: str = "") -> FaultPlace:
        """Where a cell is: its number, in a stack that of its frame, or words where no number tells."""
        found, is_cell = checked.found, checked.found.label != 0
        shown: str | int
        file = self._inputs.sources[0].file
        if self._inputs.is_folder:
            shown = f"cell {found.cell} of {found.source}" if is_cell else found.source
        elif self._is_stack:
            shown = found.frame
        elif file is None or file.n_frames == 1:
            shown = found.cell
        else:
            shown = f"label {found.label} in frame {found.frame}" if is_cell else f"frame {found.frame}"
        pieces = "fragment" in words or "piece" in words
        yx = checked.pieces_yx if pieces and checked.pieces_yx is not None else checked.centre_yx
        return FaultPlace(shown, found.source, found.frame, found.label, words, yx)

    def faults_found(self) -> list[MaskFault]:
        """What is wrong, the gravest first; what makes no cell unusable comes last."""
        found: list[MaskFault] = []
        for wanted in (NOT_USABLE, WITHOUT, FLAG, BORDER, NOTE):
            if wanted == NOTE:
                found += self._between_frames()
            of_kind = [fault for (what, _), fault in self._kinds.items() if what == wanted]
            found += sorted(of_kind, key=lambda fault: -len(fault.places))
        return found

    def _between_frames(self) -> Iterator[MaskFault]:
        """Masks of one cell through time that leap."""
        for (_, label), rows in self._by_label.items():
            areas, places = zip(*rows, strict=True)
            of_label = "" if self._is_stack else f" of label {label}"
            yield from leap_faults(areas, places, of_label, named_time=self._named_time)

    def summary(self) -> Iterator[str]:
        """Lines on what is wrong, the gravest first, then on all masks together."""
        yield from self._fault_lines()
        yield from self.totals()

    def _fault_lines(self) -> Iterator[str]:
        for fault in self.faults_found():
            if fault.is_between_frames:
                yield f"{fault.kind} {fault.words}"
                continue
            more = ", and the like" if fault.differs else ""
            places = self._places([place.shown for place in fault.places])
            yield f"{fault.kind}: {places}: {fault.words}{more}"

    def totals(self, follow: str = "cytodisk movie") -> Iterator[str]:
        """Lines on all masks together; `follow` is what finds faults between frames."""
        what = counted(self._looked_at, "frame" if self._is_stack else "cell")
        usable = self._looked_at - self._unusable
        leaps = {place.key for fault in self._between_frames() for place in fault.places}
        flagged = len(self._flagged | leaps)
        words = f"{what}: {usable} usable ({flagged} with QC flags), {self._unusable} not usable"
        if self._inputs.is_folder:
            words = f"{counted(len(self._inputs.sources), 'file')}, {words}"
        yield f"{words}, {self._on_border} on the image border"
        yield from without_cell_words(self._without, self._inputs.is_folder)
        yield from nuclei_words(self._nuclei)
        if self._areas:
            yield size_words(self._areas, self._inputs.scale)
            diameters = 2.0 * np.sqrt(np.asarray(self._areas, dtype=np.float64) / np.pi)
            yield from scale_words(self._inputs.scale.length(diameters), self._inputs.scale)
        if self._is_stack:
            yield f"Masks were looked at one by one. Other faults between frames: {follow} finds them."

    def _places(self, places: Sequence[str | int]) -> str:
        what = "frame" if self._is_stack else "cell"
        numbers = [place for place in places if isinstance(place, int)]
        if len(numbers) == 1:
            return f"{what} {numbers[0]}"
        if numbers:
            return f"{counted(len(numbers), what)} ({ranges_words(numbers)})"
        listed = list(dict.fromkeys(map(str, places)))
        more = len(listed) - MOST_PLACES
        shown = ", ".join(listed[:MOST_PLACES]) + (f", … {more} more" if more > 0 else "")
        return f"{len(places)} ({shown})" if len(places) > 1 else shown
