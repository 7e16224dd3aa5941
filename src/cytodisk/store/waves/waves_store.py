"""Waves of a study on disk: a folder for each signal, with its tables and settings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar

import pandas as pd

from cytodisk.errors import ReadError
from cytodisk.store.derived.derived_folder import DerivedFolder, folder_name, read_settings, write_derived
from cytodisk.store.json_shapes import wave_settings
from cytodisk.store.tables import Columns

WAVES = "waves"
_COMMAND = "cytodisk waves"


@dataclass(frozen=True)
class Waves(DerivedFolder):
    """Waves of the edge's velocity or of a signal in a study, read from disk; tables are read when asked for.

    Every table has its units by column in `attrs["units"]`. Speeds are positive towards higher sectors, which
    is clockwise in the cell's image, and inwards.

    Attributes
    ----------
    path : Path
        Its folder.
    signal : str
        "velocity", "velocity_cell_frame" or a channel.
    name : str
        Name of a variant; empty for none.
    settings : dict
        What was asked for, and the version of cytodisk.
    """

    path: Path
    signal: str
    name: str
    settings: dict[str, Any]
    command: ClassVar[str] = _COMMAND
    may_be_empty: ClassVar[tuple[str, ...]] = ("layer",)

    @cached_property
    def cells(self) -> pd.DataFrame:
        """One row a cell: the numbers of the chosen layer, status, reason if it was left out, QC flags."""
        return self._table("cells")

    @cached_property
    def layers(self) -> pd.DataFrame:
        """One row a cell and layer, of velocity one a cell: kind of wave, number, period, speed, p and q."""
        return self._table("layers")

    @cached_property
    def modes(self) -> pd.DataFrame:
        """One row a cell, layer and number of waves around the cell: its power, and what chance gives."""
        return self._table("modes")

    @cached_property
    def spectrum(self) -> pd.DataFrame:
        """One row a cell, layer, number of waves with its direction, and frequency: its power."""
        return self._table("spectrum")

    @cached_property
    def phase(self) -> pd.DataFrame:
        """One row a cell, layer, frame and sector: phase of the wave and its amplitude."""
        return self._table("phase")

    @cached_property
    def depths(self) -> pd.DataFrame | None:
        """One row a cell and layer: speed inwards and around at its depth; None of velocity."""
        return self._optional("depths")


def waves_path(study: Path, signal: str, name: str = "") -> Path:
    """Folder of the waves of a signal; what no file name can hold is written with %."""
    return study / WAVES / folder_name((signal, name) if name else (signal,))


def write_waves(
    study: Path,
    signal: str,
    tables: Mapping[str, pd.DataFrame],
    columns: Mapping[str, Columns],
    settings: Mapping[str, Any],
    name: str = "",
    csv: bool = False,
) -> Waves:
    """Write the waves of a signal whole, in place of those that were there.

    Parameters
    ----------
    study : Path
    signal : str
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
    Waves

    Raises
    ------
    StudyError
        The folder cannot be written, or is a link: what lies behind it may be another's.
    """
    content = {"signal": signal, "name": name} | dict(settings)
    write_derived(study, waves_path(study, signal, name), tables, columns, content, csv)
    return read_waves(study, signal, name)


def read_waves(study: Path, signal: str = "velocity", name: str = "") -> Waves:
    """Open the waves of a signal.

    Raises
    ------
    ReadError
        They are not there; the message lists those that are.
    """
    path = waves_path(study, signal, name)
    settings = _settings(path)
    if settings is None:
        there = [waves_title(*names) for names in list_waves(study)]
        advice = f"it has those of {'; '.join(there)}" if there else f"run {_COMMAND} first"
        raise ReadError(f"study {study} has no waves of {waves_title(signal, name)}: {advice}")
    return Waves(path, signal, name, settings)


def list_waves(study: Path) -> list[tuple[str, ...]]:
    """What waves were looked for in, in the order of the folders: (signal,), or (signal, name)."""
    found = [_settings(path) for path in sorted((study / WAVES).glob("[!.]*"))]
    names = [(known["signal"], known.get("name", "")) for known in found if known is not None]
    return [one if one[1] else one[:1] for one in names]


def waves_title(signal: str, name: str = "") -> str:
    """A signal with the name of a variant in words, such as "Rac1 (early)"."""
    return signal + (f" ({name})" if name else "")


def _settings(path: Path) -> dict[str, Any] | None:
    return read_settings(path, wave_settings, "waves", _COMMAND)
