"""QC flags of what came in: signals cut off at the ends of their range, masks scaled up."""

from __future__ import annotations

from typing import Any

from cytodisk.runs.qc_flags.column_flags import ColumnRule

LARGEST_CLIPPED = 0.1
"""Share of a cell's pixels at the smallest value from which on a signal is flagged."""
LARGEST_SATURATED = 0.01
"""Share of a cell's pixels at the largest value from which on a signal is flagged."""
LARGEST_OUTLINE_STEP_PX = 1
"""Steps of an outline that is not flagged, in px."""


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
