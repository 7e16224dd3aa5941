"""`StudyResults`: the part of a study that opens what was computed from it afterwards."""

from __future__ import annotations

from pathlib import Path

from cytodisk.store.correlation_store import Correlation, list_correlations, read_correlation


class StudyResults:
    """Correlations and the other results of commands that work on a study."""

    path: Path

    @property
    def correlations(self) -> list[tuple[str, ...]]:
        """What was correlated: (signal, with), or (signal, with, name) for a variant."""
        return list_correlations(self.path)

    def correlation(self, signal: str, with_: str = "velocity", name: str = "") -> Correlation:
        """Read a correlation.

        Parameters
        ----------
        signal, with_, name : str
            As they were given to `cytodisk correlate`.

        Returns
        -------
        Correlation

        Raises
        ------
        ReadError
            It is not there; the message lists those that are.
        """
        return read_correlation(self.path, signal, with_, name)
