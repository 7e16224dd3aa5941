"""A population's numbers as the scripts of its page take them."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any
from urllib.parse import quote

import numpy as np
import pandas as pd

from cytodisk.pages.population.curve_page import lag_label
from cytodisk.pages.population.drawn_population import DrawnPopulation
from cytodisk.pages.report.boxes import box_between
from cytodisk.pages.report.encode import pack_floats, pack_labels
from cytodisk.pages.report.palettes import palette
from cytodisk.pages.report.pictures import OUTSIDE, window_labels
from cytodisk.plot.layer_looks import layer_place
from cytodisk.plot.population.condition_looks import condition_colours
from cytodisk.plot.style import DIVERGING_COLOURS, SIGNAL_COLOURS
from cytodisk.population.significance import LEVEL
from cytodisk.store.study_kind import CELLS
from cytodisk.windows.study_grid import polar_grid_of

REPORT = "report.html"
_OF_WINDOWS = (
    "difference",
    "difference_low",
    "difference_high",
    "effect_size",
    "low",
    "high",
    "p",
    "p_fwer",
    "p_holm",
    "q",
    "cluster",
    "n_control",
    "n_treated",
)
_OF_ATLAS = ("mean", "sd", "sem", "n_cells", "n_experiments")
_LONGEST_SIDE = 400


def population_data(one: DrawnPopulation) -> dict[str, Any]:
    """What the scripts need to know.

    Parameters
    ----------
    one : DrawnPopulation

    Returns
    -------
    dict
    """
    study = one.study
    channels = one.channels if not study.is_curves else list(study.channels)
    return {
        "conditions": one.conditions,
        "colours": condition_colours(one.conditions),
        "control": study.control,
        "level": LEVEL,
        "correction": one.correction,
        "tested": any(np.isfinite(one.study.comparisons["smallest_p"])),
        "curves": study.is_curves,
        "lag_label": lag_label(one) if study.is_curves else "",
        "unit": one.unit,
        "depth_unit": study.profiles.attrs.get("units", {}).get("depth", ""),
        "channels": [
            {"name": name, "label": one.channel_words(name), "value": one.value_label(name)}
            for name in channels
        ],
        "comparisons": [_comparison(one, name, channels) for name in one.compared],
        **(_atlas(one, channels) if channels else {"atlas": None}),
        "disk": _disk(one) if channels and not study.is_curves else None,
        "profiles": [] if study.is_curves else _profiles(study.profiles),
        "scalars": _scalars(one),
        "cells": _cells(one),
        "signed": one.is_signed,
        "palettes": {
            "signal": palette(DIVERGING_COLOURS if one.is_signed else SIGNAL_COLOURS),
            "difference": palette(DIVERGING_COLOURS),
        },
    }


def _comparison(one: DrawnPopulation, condition: str, channels: list[str]) -> dict[str, Any]:
    """A comparison in words, and arrays by channel and window where there are windows."""
    told: dict[str, Any] = {"condition": condition, "words": one.comparison_words(condition)}
    if not channels:
        return told
    found = one.study.window_arrays(condition).reindex(channel=channels)
    shape = (len(channels), -1)
    windows = {
        key: pack_floats(found[key].to_numpy().astype(float).reshape(shape))
        for key in _OF_WINDOWS
        if key in found
    }
    return told | {
        "windows": windows,
        "status": found["status"].to_numpy().reshape(shape).astype(str).tolist(),
    }


def _atlas(one: DrawnPopulation, channels: list[str]) -> dict[str, Any]:
    """Means by condition; arrays by condition, channel and window."""
    atlas = one.study.atlas_arrays.sel(channel=channels)
    whole = (len(one.conditions), len(channels), -1)
    values = {key: pack_floats(atlas[key].to_numpy().astype(float).reshape(whole)) for key in _OF_ATLAS}
    lags = atlas["lag"].to_numpy().tolist() if one.study.is_curves else None
    return {"atlas": values, "layers": atlas.sizes["layer"], "lags": lags}


def _disk(one: DrawnPopulation) -> dict[str, Any]:
    grid = one.grid
    outer = grid.cytoplasm_layers if grid.nucleus_layers else None
    return {
        "radii": grid.radii.tolist(),
        "sectors": grid.sectors,
        "cytoplasm_layers": outer,
        "layer_places": [layer_place(layer, grid.layers, outer) for layer in range(grid.layers)],
        "note": one.sources.note,
        "cell": _representative(one),
        "no_cell": one.sources.missing,
    }


def _representative(one: DrawnPopulation) -> dict[str, Any] | None:
    """The window of each pixel of the cell with the most usual shape; sectors as in the atlas."""
    row = one.sources.representative
    if row is None:
        return None
    disk = one.sources.disk(row)
    outline = disk.outline_yx
    box = box_between(outline.min(axis=0), outline.max(axis=0), disk.placed_mask.image_shape, _LONGEST_SIDE)
    grid = polar_grid_of(one.sources.study(row).provenance)
    labels = window_labels(disk, grid, box)
    layer, sector = np.divmod(labels.astype(np.int64), grid.sectors)
    turned = layer * grid.sectors + (sector - one.sources.shift(row)) % grid.sectors
    return {
        "name": one.sources.name(row),
        "shape": list(box.shape),
        "labels": pack_labels(np.where(labels == OUTSIDE, OUTSIDE, turned)),
    }


def _profiles(profiles: pd.DataFrame) -> list[dict[str, Any]]:
    """A line an experiment and channel: depth of its layers, and means."""
    lines: list[dict[str, Any]] = []
    if profiles["layer"].nunique() < 2:  # the edge alone, such as its velocity
        return lines
    keys = ["condition", "experiment", "channel"]
    for (condition, experiment, channel), part in profiles.groupby(keys, sort=False, dropna=False):
        ordered = part.sort_values("layer")
        lines.append(
            {
                "condition": condition,
                "experiment": "" if experiment is None or experiment != experiment else str(experiment),
                "channel": channel,
                "layer": ordered["layer"].tolist(),
                "depth": _numbers(ordered["depth"]),
                "mean": _numbers(ordered["mean"]),
            }
        )
    return lines


def _scalars(one: DrawnPopulation) -> list[dict[str, Any]]:
    """What can be shown cell by cell: the scalars that were compared, those that differ first."""
    table = one.study.scalars
    units = one.study.cells.attrs.get("units", {})
    first = table.sort_values("p_holm", kind="stable", na_position="last")
    ranked = list(dict.fromkeys([*first["scalar"], *one.study.scalar_names]))
    known = table.drop_duplicates("scalar").set_index("scalar")
    found = []
    for name in ranked:
        if name not in one.study.cells:
            continue
        told = known.loc[name, "what"] if name in known.index and "what" in known else ""
        what = told if isinstance(told, str) else ""  # nothing is told where nothing was tested
        unit = str(known.loc[name, "unit"]) if name in known.index else units.get(name, "")
        found.append({"name": name, "unit": "" if unit == "1" else unit, "what": what})
    return found


def _cells(one: DrawnPopulation) -> dict[str, Any]:
    """The used cells, with the values of all scalars and the address of each cell's picture."""
    cells = one.used
    names = [scalar["name"] for scalar in _scalars(one)]
    return {
        "name": cells["cell"].astype(str).tolist(),
        "condition": cells["condition"].tolist(),
        "experiment": cells["experiment"].tolist(),
        "link": cell_links(cells, one.study.path),
        "values": {name: pack_floats(pd.to_numeric(cells[name], errors="coerce")) for name in names},
    }


def cell_links(cells: pd.DataFrame, folder: Path) -> list[str | None]:
    """Address of each cell on the page of its study, from a folder; None where there is no page."""
    if "study" not in cells or "number" not in cells:
        return [None] * len(cells)
    pages = {path: page_link(str(path), folder) for path in cells["study"].dropna().unique()}
    pairs = zip(cells["study"], cells["number"], strict=True)
    return [f"{page}#cell-{int(number)}" if (page := pages.get(path)) else None for path, number in pairs]


def page_link(study: str, folder: Path) -> str | None:
    """Address of the page of a study, from a folder; None if it has none."""
    page = Path(study) / REPORT
    if not (page.is_file() and (Path(study) / CELLS).is_file()):
        return None
    try:
        return quote(Path(os.path.relpath(page.resolve(), folder.resolve())).as_posix())
    except ValueError:  # on another drive
        return page.resolve().as_uri()


def _numbers(values: Any) -> list[float | None]:
    return [float(f"{value:.6g}") if np.isfinite(value) else None for value in values]
