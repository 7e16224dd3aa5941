"""`StudyResults`: the part of a study that opens what was computed from it afterwards."""

from __future__ import annotations

from pathlib import Path

from cytodisk.store.correlation_store import (
    CORRELATION,
    Correlation,
    list_correlations,
    read_correlation,
)
from cytodisk.store.predictions.prediction_store import (
    PREDICTION,
    Prediction,
    list_predictions,
    read_prediction,
)
from cytodisk.store.waves.waves_store import WAVES, Waves, list_waves, read_waves

DERIVED = (CORRELATION, PREDICTION, WAVES)
"""Folders of a study that hold what was computed from it afterwards."""


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

    @property
    def predictions(self) -> list[tuple[str, ...]]:
        """What was tested for prediction: (source, target), () for the network; a variant's name comes third.

        `study.prediction(*names)` opens each.
        """
        return list_predictions(self.path)

    def prediction(self, source: str = "", target: str = "", name: str = "") -> Prediction:
        """Read which signals predict which.

        Parameters
        ----------
        source, target, name : str
            As they were given to `cytodisk predict`; without source and target the network of all signals.

        Returns
        -------
        Prediction

        Raises
        ------
        ReadError
            It is not there; the message lists those that are.
        """
        return read_prediction(self.path, source, target, name)

    @property
    def wave_signals(self) -> list[tuple[str, ...]]:
        """What waves were looked for in: (signal,), or (signal, name) for a variant."""
        return list_waves(self.path)

    def waves(self, signal: str = "velocity", name: str = "") -> Waves:
        """Read the waves of the edge's velocity, or of a signal.

        Parameters
        ----------
        signal, name : str
            As they were given to `cytodisk waves`.

        Returns
        -------
        Waves

        Raises
        ------
        ReadError
            They are not there; the message lists those that are.
        """
        return read_waves(self.path, signal, name)
