"""What the table of cells says of a cell's nucleus, and of the signals in it and around it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from cytodisk.analysis.compartments.channel_summary import NUMBERS, channel_summary
from cytodisk.analysis.compartments.nucleus_place import direction_in_disk, nucleus_place
from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.store.nuclei.summary_columns import DARKEST_AROUND, SIGNAL_REMARKS, column_of
from cytodisk.windows.polar_windows import CellWindows

_DARK = 5.0  # percentile


def place_row(windows: CellWindows) -> dict[str, Any]:
    """Size and place of the nucleus; nothing without one."""
    disk = windows.disk
    if disk.nucleus is None:
        return {}
    place = nucleus_place(disk)
    return {
        "nucleus_area": disk.scale.area(place.area_px),
        "nucleus_offset": disk.scale.length(place.offset_px),
        "nucleus_polarity": place.polarity,
        "nucleus_direction": place.direction,
    }


def signal_row(
    windows: CellWindows, columns: Mapping[str, Any], channels: Sequence[str], box: FloatArray
) -> dict[str, Any]:
    """Numbers of each channel in nucleus and cytoplasm; nothing without a nucleus.

    Parameters
    ----------
    windows : CellWindows
    columns : mapping of str to array
        Of the table of windows: for each channel every window, layers first.
    channels : sequence of str
    box : ndarray of shape (C, h, w)
        The signal in the box of the cell.
    """
    disk = windows.disk
    if disk.nucleus is None:
        return {}
    shape = len(channels), *windows.areas.shape
    mean, sd, n_pixels = (np.reshape(columns[name], shape) for name in ("mean", "sd", "n_pixels"))
    nuclear, towards = windows.grid.compartments == "nucleus", direction_in_disk(disk)
    row: dict[str, Any] = {}
    remarks = []
    for k, channel in enumerate(channels):
        found = channel_summary(mean[k], sd[k], n_pixels[k], windows.areas, nuclear, towards)
        row |= {column_of(name, channel): getattr(found, name) for name in NUMBERS}
        remarks += [f"{channel}: {found.reason}"] if found.reason else []
    dark = _darkest(box, ~disk.placed_mask.box)
    row |= {column_of(DARKEST_AROUND, channel): value for channel, value in zip(channels, dark, strict=True)}
    return row | {SIGNAL_REMARKS.name: "; ".join(remarks)}


def _darkest(box: FloatArray, around: BoolArray) -> list[float]:
    """A low percentile of each channel around the cell; NaN where its box has nothing around it."""
    values = [channel[around] for channel in box]
    known = [value[np.isfinite(value)] for value in values]
    return [float(np.percentile(value, _DARK)) if len(value) else np.nan for value in known]
