"""Correlation of one study of a batch: done, or kept from before, and its curves."""

from __future__ import annotations

from typing import Any

import pandas as pd

from cytodisk.errors import CytodiskError
from cytodisk.runs.correlate.correlate_parameters import CorrelateParameters
from cytodisk.runs.correlate.correlate_study import correlate_study
from cytodisk.runs.population.opening.found_studies import FoundStudy
from cytodisk.runs.run_options import Progress
from cytodisk.runs.versions import installed
from cytodisk.store.correlation_store import Correlation, read_correlation
from cytodisk.store.study import open_study

DONE, KEPT, REFUSED = "ok", "kept", "refused"
CURVE = ("cell", "layer", "lag", "lag_s", "correlation", "correlation_partial")
_CELLS = ("cell", "status", "reason", "qc_flags", "frames", "geometry_not_tested")


def correlated(
    study: FoundStudy,
    names: tuple[str, str],
    parameters: CorrelateParameters,
    *,
    resume: bool,
    csv: bool,
    progress: Progress | None,
) -> tuple[Correlation | None, dict[str, Any]]:
    """Correlate a study, or keep what is there.

    Parameters
    ----------
    study : FoundStudy
    names : (str, str)
        Signal, and what it is correlated with.
    parameters : CorrelateParameters
        With the longest lag.
    resume : bool
        Keep a correlation that has the same settings.
    csv : bool
    progress : callable or None

    Returns
    -------
    correlation : Correlation or None
        None where there is none.
    row : dict
        input, status (ok, kept or refused) and reason.
    """
    row: dict[str, Any] = {"input": study.name, "status": DONE, "reason": ""}
    try:
        if resume and (there := _kept(study, names, parameters)) is not None:
            return there, row | {"status": KEPT}
        opened = open_study(study.folder)
        found = correlate_study(opened, *names, progress=progress, parameters=parameters, csv=csv)
    except CytodiskError as error:
        return None, row | {"status": REFUSED, "reason": str(error)}
    return found, row


def curves_of(study: FoundStudy, correlation: Correlation) -> pd.DataFrame:
    """Curve of each cell by layer: what `layer_curves` holds, with the name of the input."""
    return _own(correlation.layer_curves, CURVE, study.name)


def cells_of(study: FoundStudy, correlation: Correlation) -> pd.DataFrame:
    """How each cell of a study went, with the name of the input."""
    return _own(correlation.cells, _CELLS, study.name)


def _own(table: pd.DataFrame, names: tuple[str, ...], name: str) -> pd.DataFrame:
    found = table.reindex(columns=list(names))
    found.attrs = {}
    found.insert(0, "input", name)
    return found


def _kept(study: FoundStudy, names: tuple[str, str], parameters: CorrelateParameters) -> Correlation | None:
    """The correlation that is there, if it can be read and was made with these settings."""
    try:
        found = read_correlation(study.folder, *names, parameters.name)
        wanted = parameters.model_dump(mode="json") | {"cytodisk": installed(("cytodisk",))["cytodisk"]}
        settings = found.settings | {"cells": None}
        alike = all(settings.get(name) == value for name, value in wanted.items())
        whole = found.settings.get("cells") is None and len(found.layer_curves) and len(found.cells)
    except CytodiskError:  # it is not there, or damaged: it is made anew
        return None
    return found if alike and whole else None
