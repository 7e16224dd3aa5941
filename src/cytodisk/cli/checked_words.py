"""What `cytodisk check` says of masks: each kind of fault once, with the places that have it, and totals."""

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from cytodisk.cli.console import count
from cytodisk.images.mask_names import without_name
from cytodisk.number_words import rounded
from cytodisk.runs.told.map_words import without_cell_words
from cytodisk.runs.told.nuclei_words import nuclei_words, statuses_of

if TYPE_CHECKING:
    from cytodisk.runs.cells.cell_inputs import CellInputs
    from cytodisk.runs.map.checked_cells import CheckedCell
    from cytodisk.scale import Scale

_MOST_PLACES = 8
_BORDER = "QC flag image border"
_NOT_USABLE, _WITHOUT, _FLAG, _NOTE = "not usable", "without a cell", "QC flag", "note"


@dataclass
class _Kind:
    """A kind of fault: what the first place says, all places, and whether others have other numbers."""

    words: str
    places: list[str | int] = field(default_factory=list)
    differs: bool = False


class Checked:
    """What was seen of the masks of a file, or of a folder of them.

    Parameters
    ----------
    inputs : CellInputs
    """

    def __init__(self, inputs: "CellInputs"):
        self._inputs = inputs
        self._is_stack = inputs.sources[0].kind == "stack" and not inputs.is_folder
        self._without: Counter[str] = Counter()
        self._kinds: dict[tuple[str, str], _Kind] = {}
        self._areas: list[int] = []
        self._by_label: dict[tuple[str, int], list[tuple[int, int]]] = {}  # frame and area
        self._looked_at = self._unusable = self._flagged = self._on_border = 0
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
            self._note(_NOT_USABLE if is_cell else _WITHOUT, self._reason(checked), checked)
            self._unusable += is_cell
        if not is_cell:
            self._without[checked.status] += 1
        if checked.nucleus is not None:
            self._nuclei.update(statuses_of(checked.nucleus))
        if report is None:
            return
        self._areas.append(report.area_px)
        self._by_label.setdefault((found.source, found.label), []).append((found.frame, report.outline_px))
        of_nucleus = () if checked.nucleus_report is None else checked.nucleus_report.qc_flags
        self._flagged += bool(report.qc_flags or report.touches_border or of_nucleus)
        self._on_border += report.touches_border
        for flag in (*report.qc_flags, *of_nucleus):
            self._note(_FLAG, flag, checked)
        for note in (*report.notes, *(checked.nucleus_report.notes if checked.nucleus_report else ())):
            self._note(_BORDER if note.startswith("touches the image border") else _NOTE, note, checked)

    def _reason(self, checked: "CheckedCell") -> str:
        is_folder = self._inputs.is_folder
        return without_name(checked.reason, checked.found.source) if is_folder else checked.reason

    def _note(self, what: str, words: str, checked: "CheckedCell") -> None:
        alike = re.sub(r"[0-9]+(\.[0-9]+)?", "N", words).replace("fragments", "fragment")
        known = self._kinds.setdefault((what, alike.replace("holes", "hole")), _Kind(words))
        known.differs |= words != known.words
        known.places.append(self._place(checked))

    def _place(self, checked: "CheckedCell") -> str | int:
        """Where a cell is: its number, in a stack that of its frame, or words where no number tells."""
        found, is_cell = checked.found, checked.found.label != 0
        if self._inputs.is_folder:
            return f"cell {found.cell} of {found.source}" if is_cell else found.source
        if self._is_stack:
            return found.frame
        file = self._inputs.sources[0].file
        if file is None or file.n_frames == 1:
            return found.cell
        return f"label {found.label} in frame {found.frame}" if is_cell else f"frame {found.frame}"

    def summary(self) -> Iterator[str]:
        """Lines on what is wrong, the gravest first, then on all masks together."""
        for wanted in (_NOT_USABLE, _WITHOUT, _FLAG, _BORDER, _NOTE):
            if wanted == _NOTE:
                yield from self._jumps()
            found = [kind for (what, _), kind in self._kinds.items() if what == wanted]
            for kind in sorted(found, key=lambda kind: -len(kind.places)):
                more = ", and the like" if kind.differs else ""
                yield f"{wanted}: {self._places(kind.places)}: {kind.words}{more}"
        what = count(self._looked_at, "frame" if self._is_stack else "cell")
        usable = self._looked_at - self._unusable
        words = f"{what}: {usable} usable ({self._flagged} with QC flags), {self._unusable} not usable"
        if self._inputs.is_folder:
            words = f"{count(len(self._inputs.sources), 'file')}, {words}"
        yield f"{words}, {self._on_border} on the image border"
        yield from without_cell_words(self._without, self._inputs.is_folder)
        yield from nuclei_words(self._nuclei)
        if self._areas:
            yield size_words(self._areas, self._inputs.scale)
            diameters = 2.0 * np.sqrt(np.asarray(self._areas, dtype=np.float64) / np.pi)
            yield from scale_words(self._inputs.scale.length(diameters), self._inputs.scale)
        if self._is_stack:
            yield "Masks were looked at one by one. Other faults between frames: cytodisk movie finds them."

    def _jumps(self) -> Iterator[str]:
        """Lines on masks of one cell through time whose area leaps."""
        from cytodisk.runs.qc_flags.area_jumps import area_steps, follows_one_cell, leaps, without_returns

        for (_, label), rows in self._by_label.items():
            frame, area = np.array(rows).T
            step = area_steps(frame, area.astype(np.float64))
            found = without_returns(leaps(step), step) if follows_one_cell(step) else []
            if not found:
                continue
            words = [f"frames {frame[k]} and {frame[k + 1]}: {np.expm1(step[k]):+.0%}" for k in found]
            more = f"; … {len(words) - _MOST_PLACES} more" if len(words) > _MOST_PLACES else ""
            of_label = "" if self._is_stack else f" of label {label}"
            listed = "; ".join(words[:_MOST_PLACES]).replace("-", "−")
            yield f"{_FLAG} area jumps: the mask's area{of_label} jumps ({listed}{more})"

    def _places(self, places: Sequence[str | int]) -> str:
        what = "frame" if self._is_stack else "cell"
        numbers = [place for place in places if isinstance(place, int)]
        if len(numbers) == 1:
            return f"{what} {numbers[0]}"
        if numbers:
            return f"{count(len(numbers), what)} ({ranges_words(numbers)})"
        listed = list(dict.fromkeys(map(str, places)))
        more = len(listed) - _MOST_PLACES
        shown = ", ".join(listed[:_MOST_PLACES]) + (f", … {more} more" if more > 0 else "")
        return f"{len(places)} ({shown})" if len(places) > 1 else shown


def ranges_words(numbers: Iterable[int]) -> str:
    """As "0–4, 7, … 3 more" for numbers in ascending order."""
    given = sorted(numbers)
    breaks = [0, *(k + 1 for k, (one, two) in enumerate(pairwise(given)) if two > one + 1), len(given)]
    runs = [(given[first], given[last - 1]) for first, last in pairwise(breaks)]
    words = [f"{first}" if first == last else f"{first}–{last}" for first, last in runs[:_MOST_PLACES]]
    rest = sum(last - first + 1 for first, last in runs[_MOST_PLACES:])
    return ", ".join([*words, f"… {rest} more"] if rest else words)


def size_words(areas_px: Sequence[int], scale: "Scale") -> str:
    """How large cells are: a wrong scale shows here.

    Parameters
    ----------
    areas_px : sequence of int
        In square pixels.
    scale : Scale
    """
    median = float(np.median(areas_px))
    least, most = min(areas_px), max(areas_px)
    diameter = scale.length(2.0 * np.sqrt(median / np.pi))
    area = f"{median:.0f} px²"
    if scale.pixel_size_um is not None:
        area += f", {rounded(scale.area(median))} {scale.area_unit}"
    spread = f" (from {least} to {most} px²)" if len(areas_px) > 1 else ""
    of = "median area" if len(areas_px) > 1 else "area"
    return f"{of} {area}{spread}, as a circle of {rounded(diameter)} {scale.length_unit} across"


def scale_words(diameters: ArrayLike, scale: "Scale") -> Iterator[str]:
    """A line where the scale makes cells of a size that no cell has.

    Parameters
    ----------
    diameters : array-like of float
        Of the cells, in the units of `scale`.
    scale : Scale
    """
    from cytodisk.runs.qc_flags.input_flags import scale_doubt

    doubt = scale_doubt(diameters, scale)
    if doubt is not None:
        yield f"implausible scale: {doubt.words}. {doubt.advice}"
