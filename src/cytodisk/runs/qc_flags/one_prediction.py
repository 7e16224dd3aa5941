"""A study with one of its predictions alone, for the flags of that one."""

from __future__ import annotations

from dataclasses import dataclass, field

import pandas as pd

from cytodisk.runs.qc_flags.one_correlation import StudyOfNone
from cytodisk.store.predictions.prediction_store import Prediction
from cytodisk.store.study import Study


@dataclass(frozen=True, repr=False)
class UnwrittenPrediction(Prediction):
    """A prediction whose tables are in memory.

    Attributes
    ----------
    tables : dict of str to DataFrame
    """

    tables: dict[str, pd.DataFrame] = field(default_factory=dict)

    def _table(self, name: str) -> pd.DataFrame:
        return self.tables[name]


@dataclass(frozen=True, repr=False)
class StudyOfOnePrediction(StudyOfNone):
    """A study that knows of one prediction.

    Attributes
    ----------
    found : Prediction
    """

    found: Prediction

    @property
    def predictions(self) -> list[tuple[str, ...]]:
        """The one there is."""
        one = self.found
        names = (one.source, one.target, one.name)
        return [names if one.name else names[:2] if one.source else ()]

    def prediction(self, source: str = "", target: str = "", name: str = "") -> Prediction:
        """The one there is."""
        return self.found


def with_one_prediction(study: Study, found: Prediction) -> Study:
    """The study as if nothing else had been computed from it.

    Parameters
    ----------
    study : Study
    found : Prediction

    Returns
    -------
    Study
    """
    return StudyOfOnePrediction(study.path, study.cells, study.provenance, found)
