"""The page of a population."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import quote

import pandas as pd

from cytodisk.files import file_name, real_path
from cytodisk.pages.population.drawn_population import DrawnPopulation
from cytodisk.pages.report.encode import json_for_script
from cytodisk.pages.report.listed import listed, rows_words
from cytodisk.pages.report.populations.population_data import cell_links, page_link, population_data
from cytodisk.pages.report.populations.population_words import (
    curves_note,
    facts,
    figure_files,
    finding,
    methods,
    warning_groups,
)
from cytodisk.pages.report.provenance_words import run_words, value_words, version_of
from cytodisk.pages.report.template import jinja, rendered
from cytodisk.store.populations.population_columns import TABLES
from cytodisk.store.populations.population_study import PopulationStudy

_SCRIPTS = (
    "decode",
    "elements",
    "numbers",
    "chart",
    "disk",
    "pixels",
    "list",
    "atlas",
    "superplot",
    "population",
)
_MAIN = {
    "scalars": "scalar what condition mean_control mean_treated unit difference effect_size low high p "
    "p_fwer p_holm",
    "clusters": "condition channel layers sectors n_windows difference p p_holm",
    "experiments": "condition experiment cells used reason",
    "left_out": "condition left_out result difference difference_without p p_without",
    "excluded": "input source frame label reason",
    "trends": "channel layer sector slope p p_fwer",
    "scalar_trends": "scalar slope slope_low slope_high p p_fwer",
}
_LABELS = {"effect_size": "effect size g", "low": "g low", "high": "g high", "what": "what it is"}


def population_page(study: PopulationStudy) -> str:
    """The page of a population, as text.

    Parameters
    ----------
    study : PopulationStudy

    Returns
    -------
    str

    Raises
    ------
    MissingPartError
        Jinja2 is not installed.
    """
    jinja()
    one = DrawnPopulation(study)
    data = population_data(one)
    data["tables"] = {name: table for name in _MAIN if (table := _listed(study, name))["rows"]}
    data["tables"]["cells"] = _listed_cells(study)
    found = finding(one)
    words = {
        "title": real_path(study.path).name,
        "facts": list(facts(one)),
        "finding": found,
        "sentences": [told for told in study.sentences if told not in found],
        "warnings": warning_groups(one),
        "notes": [str(note) for note in study.provenance.get("warnings", ())],
        "left_out": list(filter(None, [rows_words(study.cells, "cells.parquet"), curves_note(one)])),
        "methods": methods(one),
        "sector_0": one.direction_words,
        "undrawn": one.undrawn_words,
        "studies": _studies(study.cells, study.path),
        "figures": [{**one_file, "link": quote(one_file["link"])} for one_file in figure_files(one)],
        "settings": list(_settings(study)),
        "version": version_of(study.provenance),
        "data": data,
        "texts": [("data", json_for_script(data))],
    }
    return rendered("population", ["page", "cells", "population"], _SCRIPTS, words)


def _listed(study: PopulationStudy, name: str) -> dict[str, Any]:
    table: pd.DataFrame = getattr(study, name)
    if "unit" in table and name == "scalars":
        table = table.assign(unit=table["unit"].replace("1", ""))
    several = len(study.compared) > 1
    alone = {"p_holm"} if name == "experiments" else {"condition", "p_holm"}
    main = [one for one in _MAIN[name].split() if several or one not in alone]
    if name == "scalars" and len(table) and (table["status"] != "ok").any():
        main.append("status")
    labels = _LABELS | ({"sectors": "lags", "n_windows": "n lags"} if study.is_curves else {})
    return listed(table, main=main, labels=labels, meanings=_meanings(name))


def _listed_cells(study: PopulationStudy) -> dict[str, Any]:
    cells = study.cells
    table = cells.drop(columns=[name for name in ("study", "number") if name in cells])
    table.attrs = cells.attrs
    scalars = [name for name in study.scalar_names if name in table]
    scalars = sorted(scalars, key=lambda name: name.startswith("layer_"))[:6]  # ratios first
    main = [
        "cell",
        "condition",
        "experiment",
        "distance_to_mean",
        *scalars,
        "alignment",
        "qc_flags",
        "left_out",
    ]
    return listed(table, main=main, meanings=_meanings("cells")) | {"links": cell_links(cells, study.path)}


def _meanings(name: str) -> dict[str, str]:
    columns = TABLES.get(name, ())
    return {column.name: f"{column.meaning[:1].upper()}{column.meaning[1:]}." for column in columns}


def _studies(cells: pd.DataFrame, folder: Path) -> list[dict[str, Any]]:
    """The studies that cells are from, with their pages."""
    if "study" not in cells:
        return []
    counts = cells["study"].value_counts(sort=False)
    return [
        {
            "name": file_name(str(path)),
            "cells": int(count),
            "link": page_link(str(path), folder),
            "path": str(path),
        }
        for path, count in counts.items()
    ]


def _settings(study: PopulationStudy) -> Iterator[tuple[str, str]]:
    for name, value in study.parameters.items():
        if value not in (None, [], ""):
            yield name, value_words(value)
    yield from run_words(study.provenance)
