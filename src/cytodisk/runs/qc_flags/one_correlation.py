"""A study with one of its correlations alone, for the flags of that one."""

from __future__ import annotations

from dataclasses import dataclass, field

import pandas as pd

from cytodisk.store.correlation_store import Correlation
from cytodisk.store.study import Study


@dataclass(frozen=True)
class UnwrittenCorrelation(Correlation):
    """A correlation whose tables are in memory.

    Attributes
    ----------
    tables : dict of str to DataFrame
    """

    tables: dict[str, pd.DataFrame] = field(default_factory=dict)

    def _optional(self, name: str) -> pd.DataFrame | None:
        return self.tables.get(name)

    def _table(self, name: str) -> pd.DataFrame:
        return self.tables[name]


@dataclass(frozen=True)
class StudyOfNone(Study):
    """A study that knows of nothing that was computed from it."""

    @property
    def correlations(self) -> list[tuple[str, ...]]:
        """None."""
        return []

    @property
    def predictions(self) -> list[tuple[str, ...]]:
        """None."""
        return []

    @property
    def wave_signals(self) -> list[tuple[str, ...]]:
        """None."""
        return []


@dataclass(frozen=True)
class StudyOfOne(StudyOfNone):
    """A study that knows of one correlation.

    Attributes
    ----------
    found : Correlation
    """

    found: Correlation

    @property
    def correlations(self) -> list[tuple[str, ...]]:
        """The one there is."""
        one = self.found
        return [(one.signal, one.with_, one.name) if one.name else (one.signal, one.with_)]

    def correlation(self, signal: str, with_: str = "velocity", name: str = "") -> Correlation:
        """The one there is."""
        return self.found


def with_one(study: Study, found: Correlation) -> Study:
    """The study as if it had no other correlation.

    Parameters
    ----------
    study : Study
    found : Correlation

    Returns
    -------
    Study
    """
    return StudyOfOne(study.path, study.cells, study.provenance, found)
