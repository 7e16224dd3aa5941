"""Correlations of a study on disk: a folder for each pair of names, with its tables and settings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar

import pandas as pd

from cytodisk.errors import ReadError
from cytodisk.store.derived.derived_folder import DerivedFolder, folder_name, read_settings, write_derived
from cytodisk.store.json_shapes import correlation_settings
from cytodisk.store.tables import Columns

CORRELATION = "correlation"
_COMMAND = "cytodisk correlate"


@dataclass(frozen=True)
class CorrelationFolder(DerivedFolder):
    """A folder with the tables of a correlation, which are read when asked for.

    Attributes
    ----------
    path : Path
    signal, with_, name : str
        See `Correlation`.
    settings : dict
    """

    path: Path
    signal: str
    with_: str
    name: str
    settings: dict[str, Any]
    command: ClassVar[str] = _COMMAND


@dataclass(frozen=True)
class Correlation(CorrelationFolder):
    """A correlation of a study, read from disk; tables are read when asked for.

    Every table has its units by column in `attrs["units"]`.

    Attributes
    ----------
    path : Path
        Its folder.
    signal, with_ : str
        What was correlated. Positive lag: `with_` comes after `signal`.
    name : str
        Name of a variant; empty for none.
    settings : dict
        What was asked for, and the version of cytodisk.
    """

    @cached_property
    def cells(self) -> pd.DataFrame:
        """One row a cell of the study: status, the reason if it was left out, share of drifting series."""
        return self._table("cells")

    @cached_property
    def windows(self) -> pd.DataFrame:
        """One row a window: correlation at the peak, its lag, n, confidence, p and q."""
        return self._table("windows")

    @cached_property
    def layers(self) -> pd.DataFrame:
        """One row a layer: the peak of the mean over sectors, its lag, p, q and threshold."""
        return self._table("layers")

    @cached_property
    def clusters(self) -> pd.DataFrame | None:
        """One row a cluster: lag, sign, p, its layers and sectors in words; None when they were not made."""
        return self._optional("clusters")

    @cached_property
    def curves(self) -> pd.DataFrame:
        """One row a window and lag."""
        return self._table("curves")

    @cached_property
    def layer_curves(self) -> pd.DataFrame:
        """One row a layer and lag: mean over sectors, quartiles, threshold."""
        return self._table("layer_curves")

    @cached_property
    def pairs(self) -> pd.DataFrame | None:
        """One row a kind of distance, distance and lag; None when pairs were not asked for."""
        return self._optional("pairs")

    @cached_property
    def events(self) -> pd.DataFrame | None:
        """One row for each event of the edge; None unless `with_` is a velocity."""
        return self._optional("events")

    @cached_property
    def event_averages(self) -> pd.DataFrame | None:
        """One row for each kind of event, layer and delay: the signal around onsets; None as for `events`."""
        return self._optional("event_averages")


def correlation_path(study: Path, signal: str, with_: str, name: str = "") -> Path:
    """Folder of a correlation; what no file name can hold is written with %, and long names are cut."""
    names = (signal, with_, name) if name else (signal, with_)
    return study / CORRELATION / folder_name(names)


def write_correlation(
    study: Path,
    signal: str,
    with_: str,
    tables: Mapping[str, pd.DataFrame],
    columns: Mapping[str, Columns],
    settings: dict[str, Any],
    name: str = "",
    csv: bool = False,
) -> Correlation:
    """Write a correlation whole, in place of the one that was there.

    Parameters
    ----------
    study : Path
    signal, with_ : str
    tables : dict of str to DataFrame
        With units in `attrs`.
    columns : dict of str to tuple of Column
        What the columns of these tables, and perhaps of others, mean.
    settings : dict
    name : str
        Name of a variant, which stands beside the others.
    csv : bool
        Write every table as CSV too.

    Returns
    -------
    Correlation

    Raises
    ------
    StudyError
        The folder cannot be written, or is a link: what lies behind it may be another's.
    """
    target = correlation_path(study, signal, with_, name)
    content = {"signal": signal, "with": with_, "name": name} | settings
    write_derived(study, target, tables, columns, content, csv)
    return read_correlation(study, signal, with_, name)


def read_correlation(study: Path, signal: str, with_: str, name: str = "") -> Correlation:
    """Open a correlation.

    Raises
    ------
    ReadError
        It is not there; the message lists those that are.
    """
    path = correlation_path(study, signal, with_, name)
    settings = _settings(path)
    if settings is None:
        there = [titled(*names) for names in list_correlations(study)]
        advice = f"it has {'; '.join(there)}" if there else "run cytodisk correlate first"
        raise ReadError(f"study {study} has no correlation of {titled(signal, with_, name)}: {advice}")
    return Correlation(path, signal, with_, name, settings)


def list_correlations(study: Path) -> list[tuple[str, ...]]:
    """What was correlated, in the order of the folders: (signal, with), or (signal, with, name)."""
    found = [_settings(path) for path in sorted((study / CORRELATION).glob("[!.]*~*"))]
    names = [(known["signal"], known["with"], known.get("name", "")) for known in found if known is not None]
    return [one if one[2] else one[:2] for one in names]


def titled(signal: str, with_: str, name: str = "") -> str:
    """A correlation in words, such as "Rac1 with velocity (linear)"."""
    return f"{signal} with {with_}" + (f" ({name})" if name else "")


def _settings(path: Path) -> dict[str, Any] | None:
    return read_settings(path, correlation_settings, "a correlation", _COMMAND)
