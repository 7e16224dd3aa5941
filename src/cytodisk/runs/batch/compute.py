"""One input → its study, and what a row says of it."""

from __future__ import annotations

import platform
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from cytodisk.errors import OtherRunError
from cytodisk.runs.batch.inputs import BatchInput
from cytodisk.runs.map.map_inputs import open_inputs
from cytodisk.runs.map.map_run import run_map
from cytodisk.runs.movie.movie_inputs import open_movie
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.movie.movie_run import run_movie
from cytodisk.store.study import Study


def compute_input(item: BatchInput, folder: Path) -> dict[str, Any]:
    """Run `cytodisk movie` or `cytodisk map` over an input.

    Parameters
    ----------
    item : BatchInput
    folder : Path
        An unfinished study of the same run is finished, one of another run is replaced.

    Returns
    -------
    dict
        Fields of `InputRow`.

    Raises
    ------
    CytodiskError
        The input cannot be used, or results cannot be written.
    """
    run = _run_of(item, folder)
    try:
        return _facts(run(resume=True))
    except OtherRunError:
        return _facts(run(overwrite=True))


def _run_of(item: BatchInput, folder: Path) -> Callable[..., Study]:
    if isinstance(item.parameters, MovieParameters):
        return partial(run_movie, open_movie(item.masks, item.signal, item.parameters), folder)
    return partial(run_map, open_inputs(item.masks, item.signal, item.parameters), folder)


def _facts(study: Study) -> dict[str, Any]:
    rows, provenance = study.cells, study.provenance
    mapped = int((rows["status"] == "ok").sum())
    facts = {
        "complete": True,
        "cells": int(rows.loc[rows["label"] != 0, "cell"].nunique()),
        "frames": len(rows),
        "mapped": mapped,
        "qc_flags": int((rows["qc_flags"].fillna("") != "").sum()),
        "pixel_size_um": provenance["pixel_size_um"],
        "frame_interval_s": provenance["frame_interval_s"],
        "length_unit": provenance["length_unit"],
        "velocity_unit": provenance["velocity_unit"] if study.is_movie else "",
        "worker": {"host": platform.node(), "versions": provenance["versions"]},
    }
    if not mapped:
        reason = rows["reason"].iloc[0] if len(rows) else "the file holds no cell"
        facts |= {"status": "refused", "reason": f"nothing could be mapped: {reason}"}
    return facts
