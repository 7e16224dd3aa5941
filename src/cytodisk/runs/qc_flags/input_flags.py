"""QC flags of what came in: signals cut off at the ends of their range, masks scaled up, a wrong scale."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from cytodisk.runs.qc_flags.column_flags import ColumnRule
from cytodisk.runs.qc_flags.qc_flag import QCFlag, mapped_rows
from cytodisk.runs.qc_flags.remedy import run_again
from cytodisk.scale import Scale
from cytodisk.store.study import Study

LARGEST_CLIPPED = 0.1
"""Share of a cell's pixels at the smallest value from which on a signal is flagged."""
LARGEST_SATURATED = 0.01
"""Share of a cell's pixels at the largest value from which on a signal is flagged."""
LARGEST_OUTLINE_STEP_PX = 1
"""Steps of an outline that is not flagged, in px."""
SMALLEST_CELL_UM, LARGEST_CELL_UM = 1.0, 1000.0
"""Diameters of cells whose scale is not flagged, in µm."""
_OTHER_UNITS = ((1e-3, "nm"), (1e3, "mm"))  # which may have been taken for µm


def _clipped(share: float, row: Any) -> str:
    """Channel, share, and a note if there is one; studies of earlier versions have none."""
    note = row.get("clipped_note")
    share_of_cell = f"{row['clipped_channel']}: {share:.0%} of the cell"
    return f"{share_of_cell}; {note}" if isinstance(note, str) and note else share_of_cell


clipped_signal = ColumnRule(
    "clipped signal",
    "the signal is cut off at its smallest value in {frames}",
    "Many pixels of the cell are exactly at the smallest value: what was dimmer is lost, so means of dim "
    "windows are too high and their changes too small.",
    "Go back to the raw image: subtract less background, keep negative values, or raise the offset.",
    "clipped_share",
    lambda column, scale: column > LARGEST_CLIPPED,
    lambda value, row, scale: _clipped(value, row),
)
saturated_signal = ColumnRule(
    "saturated signal",
    "the signal is cut off at its largest value in {frames}",
    "Pixels pile up at the largest value: what was brighter is lost, so bright windows change less than the "
    "cell does.",
    "Record with less light, gain or exposure, or go back to an image of more bits; leave these windows out.",
    "saturated_share",
    lambda column, scale: column > LARGEST_SATURATED,
    lambda value, row, scale: f"{row['saturated_channel']}: {value:.1%} of the cell",
)
coarse_outline = ColumnRule(
    "coarse outline",
    "the outline goes in large steps in {frames}",
    "The mask was drawn at a lower resolution and scaled up: the edge moves in jumps of such a step, and "
    "velocity with it.",
    "Run with the masks as they were drawn, and the signal binned to their size; or segment at full size.",
    "outline_step_px",
    lambda column, scale: column > LARGEST_OUTLINE_STEP_PX,
    lambda value, row, scale: f"steps of {int(value)} px",
)


def implausible_scale(study: Study) -> Iterator[QCFlag]:
    """Cells that are smaller or larger than cells are; a single one of many is no fault of the scale."""
    rows = mapped_rows(study)
    if study.scale.pixel_size_um is None or "area" not in rows:
        return
    doubt = scale_doubt(2 * np.sqrt(rows["area"].to_numpy(dtype=np.float64) / np.pi), study.scale)
    if doubt is None:
        return
    advice = doubt.advice
    if doubt.likely is not None:
        again = run_again(study, "rescaled", pixel_size=f"{doubt.likely[0]:.4g}")
        advice += f" If the size was in {doubt.likely[1]}: {again}"
    yield QCFlag(
        "implausible scale",
        doubt.words,
        f"Cells are {SMALLEST_CELL_UM:g} to {LARGEST_CELL_UM:g} µm wide, so the pixel size is wrong, and "
        "with it all lengths, areas, depths and velocities.",
        advice,
    )


@dataclass(frozen=True)
class ScaleDoubt:
    """A scale that makes cells of a size that no cell has.

    Attributes
    ----------
    words, advice : str
        What was found, and what to do.
    likely : (float, str) or None
        Size of a pixel in µm if the given one was in another unit, and that unit.
    """

    words: str
    advice: str
    likely: tuple[float, str] | None


def scale_doubt(diameters: ArrayLike, scale: Scale) -> ScaleDoubt | None:
    """What speaks against a scale; None if nothing does.

    Parameters
    ----------
    diameters : array-like of float
        Of the cells, in the units of `scale`; their median counts.
    scale : Scale
    """
    pixel_um, found = scale.pixel_size_um, np.asarray(diameters, dtype=np.float64)
    if pixel_um is None or not len(found):
        return None
    width_um = float(np.median(found))
    if not width_um > 0 or SMALLEST_CELL_UM <= width_um <= LARGEST_CELL_UM:
        return None
    likely = (
        (factor * pixel_um, unit)
        for factor, unit in _OTHER_UNITS
        if SMALLEST_CELL_UM <= factor * width_um <= LARGEST_CELL_UM
    )
    return ScaleDoubt(
        f"cells are {_length(width_um)} wide, with pixels of {pixel_um:.4g} µm",
        "Find the size of a pixel in the microscope's own file, and run again with --pixel-size, in µm.",
        next(likely, None),
    )


def _length(width_um: float) -> str:
    if width_um >= LARGEST_CELL_UM:
        return f"{width_um / 1e3:.3g} mm"
    return f"{width_um:.3g} µm" if width_um >= 0.1 else f"{width_um * 1e3:.3g} nm"
