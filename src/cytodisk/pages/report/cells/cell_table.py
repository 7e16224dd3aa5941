"""The table of a study's cells as its page lists it."""

from __future__ import annotations

from typing import Any

import pandas as pd

from cytodisk.pages.report.cells.window_numbers import WindowNumbers
from cytodisk.pages.report.listed import listed
from cytodisk.pages.report.shown_names import without_folders
from cytodisk.runs.channel_names import shown_name
from cytodisk.runs.map.map_kind import MAP
from cytodisk.store.nuclei.summary_columns import RATIO, channel_columns, channels_among, column_of
from cytodisk.store.study import Study

CONDITION, EXPERIMENT = "condition", "experiment"
_MEAN = "mean {channel}"
_LABELS = {"source": "file", "qc_flags": "QC flags", "area_distortion": "area distortion"}
_LEFT_OUT = ("time_s", "seconds", "frame")
_LONGEST = 24


def listed_cells(study: Study, numbers: WindowNumbers) -> dict[str, Any]:
    """Rows of the table of cells for `page.list`, with the mean of each channel.

    Parameters
    ----------
    study : Study
    numbers : WindowNumbers

    Returns
    -------
    dict
        See `listed`; the first column is the number of the cell.
    """
    rows = study.cells
    means = {_MEAN.format(channel=name): rows["cell"].map(numbers.means[name]) for name in numbers.channels}
    single = [name for name in _LEFT_OUT if name != "frame" or not rows["frame"].any()]
    table = rows.drop(columns=[*single]).assign(**means)
    for name in ("reason", "notes"):
        table[name] = [
            without_folders(str(words), study) if pd.notna(words) else None for words in table[name]
        ]
    table.attrs = {"units": rows.attrs["units"] | dict.fromkeys(means, "a.u.")}
    ratios = [column_of(RATIO, name) for name in channels_among(map(str, rows))]
    own = own_columns(study)
    main = ["cell", "source", "label", "frame", *own, "status", "qc_flags", "area", *means, *ratios]
    labels = _LABELS | {
        column_of(RATIO, name): f"nucleus/cytoplasm {_short(name)}" for name in _channels(rows)
    }
    labels |= {_MEAN.format(channel=name): f"mean {_short(name)}" for name in numbers.channels}
    return listed(
        table, main=[*main, "area_distortion", "reason"], labels=labels, meanings=meanings_of(study)
    )


def own_columns(study: Study) -> list[str]:
    """Columns that the user gave, condition and experiment first."""
    known = {column.name for column in _known(study)}
    own = [str(name) for name in study.cells if name not in known]
    first = [name for name in (CONDITION, EXPERIMENT) if name in study.cells]
    return [*first, *(name for name in own if name not in first)]


def meanings_of(study: Study) -> dict[str, str]:
    """What stands in each column, as a sentence."""
    return {column.name: f"{column.meaning[:1].upper()}{column.meaning[1:]}." for column in _known(study)}


def _known(study: Study) -> Any:
    return (*MAP.with_nuclei.cells, *channel_columns(_channels(study.cells)))


def _channels(rows: pd.DataFrame) -> list[str]:
    return channels_among(map(str, rows))


def _short(name: str) -> str:
    return shown_name(name, _LONGEST)
