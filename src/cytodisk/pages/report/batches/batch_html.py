"""The page of a batch."""

from __future__ import annotations

import re
import shlex
from pathlib import Path
from typing import Any

import pandas as pd

from cytodisk.errors import ReadError
from cytodisk.files import real_path
from cytodisk.number_words import counted
from cytodisk.pages.report.batches.batch_tables import listed_cells, listed_inputs, own_columns, read_inputs
from cytodisk.pages.report.batches.pooled import pooled_results
from cytodisk.pages.report.encode import json_for_script
from cytodisk.pages.report.listed import MOST_ROWS
from cytodisk.pages.report.provenance_words import version_of
from cytodisk.pages.report.template import rendered
from cytodisk.store.provenance_file import read_complete

_SCRIPTS = ("decode", "elements", "numbers", "list", "batch")
_MOST_NAMED = 20


def batch_page(folder: Path) -> str:
    """The page of a batch, as text.

    Parameters
    ----------
    folder : Path

    Returns
    -------
    str

    Raises
    ------
    ReadError
        It is no complete batch.
    """
    provenance = read_complete(folder, "batch")
    inputs = read_inputs(folder)
    if inputs.empty:
        raise ReadError(f"batch {folder} has no inputs")
    cells, count = listed_cells(folder, inputs)
    data = {"inputs": listed_inputs(inputs, folder), "cells": cells}
    words = {
        "title": real_path(folder).name,
        "finding": [_finding(inputs)],
        "groups": _groups(inputs),
        "lost": _lost(inputs),
        "flags": _flags(inputs),
        "left_out": list(_left_out(folder, inputs, count, data)),
        "command": _command(folder, inputs),
        "pooled": pooled_results(folder),
        "version": version_of(provenance),
        "facts": [("batch", ""), ("cytodisk", version_of(provenance))],
        "settings": [],
        "texts": [("data", json_for_script(data))],
    }
    return rendered("batch", ["page", "cells"], _SCRIPTS, words)


def _finding(inputs: pd.DataFrame) -> str:
    done = int((inputs["status"] == "ok").sum())
    mapped, cells = int(inputs["mapped"].sum()), int(inputs["cells"].sum())
    frames = int(inputs.loc[inputs["kind"] == "movie", "frames"].sum())
    what = "mapped" if not frames else f"mapped, frames of movies counted one by one ({frames})"
    lost = inputs.loc[inputs["status"] != "ok", "status"].value_counts()
    parts = [
        f"{done} of {counted(len(inputs), 'input')} done",
        *(f"{n} {status}" for status, n in lost.items()),
    ]
    parts.append(f"{counted(cells, 'cell')}, {mapped} {what}")
    flagged = int(inputs["qc_flags"].sum())
    parts.append(f"{flagged} with QC flags" if flagged else "none with a QC flag")
    return "; ".join(parts) + "."


def _groups(inputs: pd.DataFrame) -> str:
    if "condition" not in own_columns(inputs):
        return ""
    words = []
    for name, part in inputs.groupby("condition", sort=False):
        repeats = part["experiment"].dropna().nunique() if "experiment" in part else 0
        among = f", {counted(repeats, 'experiment')}" if repeats else ""
        words.append(
            f"{name}: {counted(len(part), 'input')}{among}, {counted(int(part['cells'].sum()), 'cell')}"
        )
    return "; ".join(words)


def _command(folder: Path, inputs: pd.DataFrame) -> str:
    names = list(inputs["condition"].dropna().unique()) if "condition" in own_columns(inputs) else []
    if len(names) < 2:
        return ""
    compared = ",".join(map(str, names))
    return shlex.join(
        ["cytodisk", "population", str(folder), "--compare", compared, "-o", f"{folder}_population"]
    )


def _lost(inputs: pd.DataFrame) -> list[dict[Any, str]]:
    rows = inputs[inputs["status"] != "ok"]
    lost = rows[["input", "status", "reason"]].head(_MOST_NAMED).astype(str)
    lost["reason"] = [re.sub(r"/\S*/(?=[^\s/])", "", words) for words in lost["reason"]]  # folders
    return lost.to_dict("records")


def _flags(inputs: pd.DataFrame) -> list[tuple[str, int]]:
    """QC flags by the number of inputs that have them."""
    names = inputs["flags"].fillna("").str.split("; ").explode()
    return [(str(name), int(count)) for name, count in names[names != ""].value_counts().items()]


def _left_out(folder: Path, inputs: pd.DataFrame, cells: int, data: dict[str, Any]) -> Any:
    more = int((inputs["status"] != "ok").sum()) - _MOST_NAMED
    if more > 0:
        yield f"{more} more inputs have no result: sort the list of inputs by status."
    if cells > MOST_ROWS:
        yield f"The list of cells holds the first {MOST_ROWS} of {cells}: all are in cells.parquet."
    there = (inputs["mapped"] > 0).tolist()
    without = sum(link is None and has for link, has in zip(data["inputs"]["links"], there, strict=False))
    if without:
        yield (
            f"{counted(without, 'input')} {'has' if without == 1 else 'have'} no page of "
            f"{'its' if without == 1 else 'their'} own yet, on which a click opens a cell: "
            f"cytodisk report {shlex.quote(str(folder))} writes them"
        )
