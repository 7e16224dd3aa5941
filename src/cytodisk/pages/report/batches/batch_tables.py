"""The tables of a batch as its page lists them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd

from cytodisk.pages.report.listed import MOST_ROWS, listed
from cytodisk.runs.batch.input_columns import INPUT, INPUT_COLUMNS
from cytodisk.runs.batch.input_row import STUDIES
from cytodisk.store.nuclei.summary_columns import channels_among, column_of
from cytodisk.store.table_file import opened_table

REPORT = "report.html"
_OF_CELLS = ("input", "cell", "source", "label", "frame", "status", "reason", "qc_flags", "area")
_LABELS = {"source": "file", "qc_flags": "QC flags", "flags": "QC flags by name", "n_frames": "frames"}
_RATIO = "nucleus_to_cytoplasm"


def read_inputs(folder: Path) -> pd.DataFrame:
    """The table of a batch's inputs."""
    return _read(folder / "inputs.parquet")


def listed_inputs(inputs: pd.DataFrame, folder: Path) -> dict[str, Any]:
    """Rows of the table of inputs for `page.list`, with "links" to the pages of their studies."""
    own = own_columns(inputs)
    main = ["input", *own, "kind", "status", "cells", "mapped", "qc_flags", "flags", "reason"]
    table = inputs.drop(columns=[name for name in ("length_unit", "velocity_unit") if name in inputs])
    meanings = {column.name: f"{column.meaning[:1].upper()}{column.meaning[1:]}." for column in INPUT_COLUMNS}
    found = listed(table, main=main, labels=_LABELS, meanings=meanings)
    return found | {"links": [page_of(folder, str(name)) for name in inputs["input"].iloc[:MOST_ROWS]]}


def listed_cells(folder: Path, inputs: pd.DataFrame) -> tuple[dict[str, Any], int]:
    """Rows of the table of cells, one a cell also of movies, with links; and how many there are in all."""
    path = folder / "cells.parquet"
    if not path.exists():
        return {"columns": [], "rows": [], "links": []}, 0
    own = own_columns(inputs)
    with opened_table(path) as file:
        names = file.schema_arrow.names
    ratios = [column_of(_RATIO, name) for name in channels_among(names)]
    cells = _read(path, [name for name in (*_OF_CELLS, *own, *ratios) if name in names])
    rows = _one_a_cell(cells) if cells.duplicated(["input", "cell"]).any() else cells
    rows.attrs = cells.attrs
    if "frame" in rows and not rows["frame"].any():
        rows = rows.drop(columns="frame")
    main = [
        "input",
        "cell",
        "source",
        "label",
        *own,
        "n_frames",
        "status",
        "qc_flags",
        "area",
        *ratios,
        "reason",
    ]
    shown = rows.iloc[:MOST_ROWS]
    pages = {name: page_of(folder, str(name)) for name in shown["input"].unique()}
    places = zip(shown["input"], shown["cell"], strict=True)
    links = [f"{pages[name]}#cell-{cell}" if pages[name] else None for name, cell in places]
    return listed(rows, main=main, labels=_LABELS) | {"links": links}, len(rows)


def _one_a_cell(cells: pd.DataFrame) -> pd.DataFrame:
    """Rows of movies, which have one a frame, as one a cell: means of numbers, the first of texts."""
    keys = ["input", "cell"]
    how = {
        name: "mean" if pd.api.types.is_float_dtype(cells[name]) else "first"
        for name in cells
        if name not in (*keys, "status", "frame", "qc_flags")
    }
    grouped = cells.groupby(keys, sort=False)
    rows = grouped.agg(how)
    mapped = (cells["status"] == "ok").groupby([cells[key] for key in keys], sort=False)
    rows["n_frames"] = grouped.size()
    rows["status"] = [
        f"{ok} of {count} mapped" for ok, count in zip(mapped.sum(), mapped.size(), strict=True)
    ]
    rows["qc_flags"] = grouped["qc_flags"].agg(_joined)
    return rows.reset_index()


def _joined(flags: pd.Series) -> str:
    return "; ".join(dict.fromkeys(name for words in flags.dropna() for name in words.split("; ") if name))


def own_columns(inputs: pd.DataFrame) -> list[str]:
    """Columns that the user gave."""
    known = {INPUT.name, *(column.name for column in INPUT_COLUMNS)}
    return [str(name) for name in inputs if name not in known]


def page_of(folder: Path, name: str) -> str | None:
    """Address of the page of an input's study, from that of the batch; None if it has none."""
    from urllib.parse import quote

    path = f"{STUDIES}/{name}/{REPORT}"
    return quote(path) if (folder / path).is_file() else None


def _read(path: Path, columns: list[str] | None = None) -> pd.DataFrame:
    with opened_table(path) as file:
        table = file.read(columns=columns)
        frame: pd.DataFrame = table.to_pandas()
        frame.attrs["units"] = {
            one.name: (one.metadata or {}).get(b"unit", b"").decode() for one in table.schema
        }
    return frame
