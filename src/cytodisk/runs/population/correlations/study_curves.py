"""Correlation of one study of a batch: its curves, and whether it can be kept from before."""

from __future__ import annotations

import pandas as pd

from cytodisk.runs.correlate.correlate_parameters import CorrelateParameters
from cytodisk.runs.population.opening.found_studies import FoundStudy
from cytodisk.runs.population.pooling.movie_by_movie import made_alike, of_input
from cytodisk.store.correlation_store import Correlation, read_correlation

CURVE = ("cell", "layer", "lag", "lag_s", "correlation", "correlation_partial")
_CELLS = ("cell", "status", "reason", "qc_flags", "frames", "geometry_not_tested")


def curves_of(study: FoundStudy, correlation: Correlation) -> pd.DataFrame:
    """Curve of each cell by layer: what `layer_curves` holds, with the name of the input."""
    return of_input(correlation.layer_curves, CURVE, study.name)


def cells_of(study: FoundStudy, correlation: Correlation) -> pd.DataFrame:
    """How each cell of a study went, with the name of the input."""
    return of_input(correlation.cells, _CELLS, study.name)


def kept(study: FoundStudy, names: tuple[str, str], parameters: CorrelateParameters) -> Correlation | None:
    """The correlation that is there, if it was made with these settings.

    Raises
    ------
    CytodiskError
        It is not there, or damaged.
    """
    found = read_correlation(study.folder, *names, parameters.name)
    alike = made_alike(found.settings, parameters.model_dump(mode="json"))
    return found if alike and len(found.layer_curves) and len(found.cells) else None
