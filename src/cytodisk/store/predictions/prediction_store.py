"""Predictions of a study on disk: a folder for each pair of names, or for a network, with its tables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar

import pandas as pd

from cytodisk.errors import ReadError
from cytodisk.store.derived.derived_folder import DerivedFolder, folder_name, read_settings, write_derived
from cytodisk.store.json_shapes import prediction_settings
from cytodisk.store.tables import Columns

PREDICTION = "prediction"
NETWORK = "network"
"""Name of the folder in which all signals are tested against each other."""

_COMMAND = "cytodisk predict"


@dataclass(frozen=True)
class Prediction(DerivedFolder):
    """Which signals of a study predict which, read from disk; tables are read when asked for.

    Every table has its units by column in `attrs["units"]`.

    Attributes
    ----------
    path : Path
        Its folder.
    source, target : str
        What was tested, in both directions; both empty for a network of all signals.
    name : str
        Name of a variant; empty for none.
    settings : dict
        What was asked for, and the version of cytodisk.

    See Also
    --------
    run_predict : Writes one.
    """

    path: Path
    source: str
    target: str
    name: str
    settings: dict[str, Any]
    command: ClassVar[str] = _COMMAND
    needed: ClassVar[Mapping[str, tuple[str, ...]]] = {"links": ("weaker",)}

    def __repr__(self) -> str:
        return f"<Prediction {self.path}: {titled_prediction(self.source, self.target, self.name)}>"

    @property
    def is_network(self) -> bool:
        """Whether all signals were tested against each other."""
        return not self.source

    @property
    def signals(self) -> tuple[str, ...]:
        """Names of what was tested: channels, then the velocity of the edge."""
        return tuple(self.settings["signals"])

    @cached_property
    def links(self) -> pd.DataFrame:
        """One row a cell, source, target and layer: gain, p, q, and the same without geometry."""
        return self._table("links")

    @cached_property
    def lags(self) -> pd.DataFrame:
        """One row a cell, source, target, layer and lag: the coefficient of the source with its interval."""
        return self._table("lags")

    @cached_property
    def pooled(self) -> pd.DataFrame:
        """One row a source, target and layer: gain over all cells of the study, p and q."""
        return self._table("pooled")

    @cached_property
    def cells(self) -> pd.DataFrame:
        """One row a cell of the study: status, the reason if it was left out, QC flags."""
        return self._table("cells")


def prediction_path(study: Path, source: str = "", target: str = "", name: str = "") -> Path:
    """Folder of a prediction, SOURCE~TARGET or network; what no file name can hold is written with %."""
    if not source:
        return study / PREDICTION / (f"{NETWORK}~{folder_name([name])}" if name else NETWORK)
    folder = folder_name([source, target, name] if name else [source, target])
    if folder.startswith(f"{NETWORK}~"):  # a channel that is called so
        folder = f"%{ord(folder[0]):02X}{folder[1:]}"
    return study / PREDICTION / folder


def write_prediction(
    study: Path,
    names: tuple[str, str, str],
    tables: Mapping[str, pd.DataFrame],
    columns: Mapping[str, Columns],
    settings: Mapping[str, Any],
    csv: bool = False,
) -> Prediction:
    """Write a prediction whole, in place of the one that was there.

    Parameters
    ----------
    study : Path
    names : (str, str, str)
        Source, target and the name of a variant; the first two are empty for a network.
    tables : dict of str to DataFrame
        With units in `attrs`.
    columns : dict of str to tuple of Column
        What the columns of these tables mean.
    settings : dict
        With "signals", the names of what was tested.
    csv : bool
        Write every table as CSV too.

    Returns
    -------
    Prediction

    Raises
    ------
    StudyError
        The folder cannot be written, or is a link: what lies behind it may be another's.
    """
    source, target, name = names
    content = {"source": source, "target": target, "name": name, **settings}
    write_derived(study, prediction_path(study, *names), tables, columns, content, csv)
    return read_prediction(study, source, target, name)


def read_prediction(study: Path, source: str = "", target: str = "", name: str = "") -> Prediction:
    """Open a prediction; the network of all signals where there are no names.

    Raises
    ------
    ReadError
        It is not there; the message lists those that are.
    """
    path = prediction_path(study, source, target, name)
    settings = _settings(path)
    if settings is None:
        there = [titled_prediction(*names) for names in list_predictions(study)]
        advice = f"it has {'; '.join(there)}" if there else "run cytodisk predict first"
        raise ReadError(
            f"study {study} has no prediction {titled_prediction(source, target, name)}: {advice}"
        )
    return Prediction(path, source, target, name, settings)


def list_predictions(study: Path) -> list[tuple[str, ...]]:
    """What was tested, in the order of the folders.

    Parameters
    ----------
    study : Path

    Returns
    -------
    list of tuple of str
        (source, target) or (source, target, name) of pairs; () or ("", "", name) of networks. Each opens
        what it names: `study.prediction(*names)`.
    """
    found = [_settings(path) for path in sorted((study / PREDICTION).glob("[!.]*"))]
    names = [(one["source"], one["target"], one.get("name", "")) for one in found if one is not None]
    return [one if one[2] else one[:2] if one[0] else () for one in names]


def titled_prediction(source: str = "", target: str = "", name: str = "") -> str:
    """A prediction in words, as "Rac1 and velocity (early)" or "network"."""
    return (f"{source} and {target}" if source else NETWORK) + (f" ({name})" if name else "")


def _settings(path: Path) -> dict[str, Any] | None:
    return read_settings(path, prediction_settings, "a prediction", _COMMAND)
