"""Columns of the table of cells on the place of a nucleus, and on each channel in nucleus and cytoplasm."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import pyarrow as pa

from cytodisk.store.tables import Column, Columns

PLACE_COLUMNS: Columns = (
    Column("nucleus_area", pa.float64(), "length²", "area of the nucleus"),
    Column(
        "nucleus_offset",
        pa.float64(),
        "length",
        "distance from the centroid of the nucleus to that of the cell",
    ),
    Column(
        "nucleus_polarity",
        pa.float64(),
        "1",
        "nucleus_offset over the radius of a disk of the cell's area: 0 for a nucleus in the middle",
    ),
    Column(
        "nucleus_direction",
        pa.float64(),
        "°",
        "direction from the centroid of the nucleus to that of the cell, from +x of the image towards +y; "
        "empty if the offset is below 1 px",
    ),
)
"""Of every study with nuclei."""

SIGNAL_REMARKS = Column(
    "nucleus_signal_remarks", pa.string(), "", "why numbers of nucleus and cytoplasm are empty, by channel"
)
DARKEST_AROUND, CYTOPLASM_MEAN, RATIO = "darkest_around", "cytoplasm_mean", "nucleus_to_cytoplasm"
PERINUCLEAR_SHARE, PERIPHERAL_SHARE = "perinuclear_share", "peripheral_share"

_OF_A_CHANNEL: Columns = (
    Column("nucleus_mean", pa.float64(), "a.u.", "mean of {channel} in the nucleus"),
    Column(CYTOPLASM_MEAN, pa.float64(), "a.u.", "mean of {channel} in the cytoplasm"),
    Column(
        RATIO,
        pa.float64(),
        "1",
        "nucleus_mean over cytoplasm_mean of {channel}; no background is subtracted, which draws it to 1",
    ),
    Column(
        "ratio_of_totals", pa.float64(), "1", "total of {channel} in the nucleus over that in the cytoplasm"
    ),
    Column(
        PERINUCLEAR_SHARE,
        pa.float64(),
        "1",
        "share of the cytoplasm's {channel} in the third of its area at the nucleus; 1/3 if it is even",
    ),
    Column(
        PERIPHERAL_SHARE,
        pa.float64(),
        "1",
        "share of the cytoplasm's {channel} in the third of its area at the membrane; 1/3 if it is even",
    ),
    Column(
        "signal_polarity",
        pa.float64(),
        "1",
        "how one-sided {channel} is in the cytoplasm: 0 if all sectors are alike, 1 if one holds all",
    ),
    Column(
        "signal_direction",
        pa.float64(),
        "°",
        "direction of that polarity from nucleus_direction on: near 0 away from the nucleus, near ±180 on "
        "its side; empty within noise",
    ),
    Column(
        DARKEST_AROUND,
        pa.float64(),
        "a.u.",
        "5th percentile of {channel} around the cell, in the box that holds it: hardly below the background",
    ),
)


def column_of(number: str, channel: str) -> str:
    """Name of the column that holds a number of a channel, as "nucleus_to_cytoplasm_GFP"."""
    return f"{number}_{channel}"


def channel_columns(channels: Sequence[str]) -> Columns:
    """Columns on these channels; none without a signal.

    Parameters
    ----------
    channels : sequence of str
        Their names.
    """
    found = tuple(
        column._replace(
            name=column_of(column.name, channel), meaning=column.meaning.replace("{channel}", channel)
        )
        for channel in channels
        for column in _OF_A_CHANNEL
    )
    return (SIGNAL_REMARKS, *found) if found else ()


def channels_among(names: Iterable[str]) -> list[str]:
    """Names of the channels that some names of columns are about, in their order."""
    head = column_of(RATIO, "")
    return [name.removeprefix(head) for name in names if name.startswith(head)]
