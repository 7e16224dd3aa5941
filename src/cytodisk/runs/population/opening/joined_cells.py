"""The cells of all studies in one table, and those that cannot be in a population."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import pandas as pd

from cytodisk.errors import PopulationError
from cytodisk.population.group_columns import CONDITION, EXPERIMENT
from cytodisk.reading_files import reading_file
from cytodisk.runs.population.opening.found_studies import FoundStudy
from cytodisk.runs.population.opening.noted_cells import LeftOut
from cytodisk.runs.shapes.shape_tables import SHAPES
from cytodisk.store.nuclei.nucleus_columns import NUCLEUS_COLUMNS
from cytodisk.store.nuclei.summary_columns import PLACE_COLUMNS, channel_columns, channels_among
from cytodisk.store.table_file import REMEDY, opened_table, read_cells
from cytodisk.store.tables import SOURCE_COLUMNS, TRACK_COLUMNS, read_table
from cytodisk.store.window_columns import WINDOW_SIZE_COLUMNS

PLACES = ("cell", "input", "study", "source", "frame", "label", "number")
"""Which cell it is: its name, its study, and its number there."""

FRAMES = "frames"
_TAKEN = ("input", "study", "number", FRAMES)
_KEPT = (
    "qc_flags",
    "touches_border",
    "area",
    "perimeter",
    "centroid_y",
    "centroid_x",
    "area_distortion",
    "angle_distortion",
    "window_area_error",
    "nucleus_status",
    *(column.name for column in PLACE_COLUMNS),
)
_KNOWN = {
    column.name
    for columns in (SOURCE_COLUMNS, TRACK_COLUMNS, WINDOW_SIZE_COLUMNS, NUCLEUS_COLUMNS, PLACE_COLUMNS)
    for column in columns
}


def cell_rows(study: FoundStudy) -> pd.DataFrame:
    """Rows of a study's cells, of a movie those of all frames.

    Parameters
    ----------
    study : FoundStudy

    Returns
    -------
    DataFrame
        With `PLACES` but for the name, status, reason, what is known of them, and the user's columns; units
        in attrs.

    Raises
    ------
    ReadError
        The table is missing or damaged.
    PopulationError
        A column of the user has a name that populations need.
    """
    if study.run == "shapes":
        with reading_file(study.folder / SHAPES, "a table of shapes", REMEDY):
            with opened_table(study.folder / SHAPES):
                pass
            found = read_table(study.folder / SHAPES)
    else:
        found = read_cells(study.folder, study.provenance)
    units, found.attrs = found.attrs["units"], {}
    if "source" not in found:  # of a movie, which is one file
        found = found.assign(source=_mask_name(study))
    if study.run != "shapes":
        found = found[_kept([str(name) for name in found])]
    own = pd.DataFrame() if study.own is None else study.own
    for name in own:
        given = own[name].reindex(found["cell"]).set_axis(found.index)
        found[name] = found[name].where(is_given(found[name]), given) if name in found else given
    refuse_taken([str(name) for name in found], study.name)
    found = found.rename(columns={"cell": "number"})
    found = found.assign(input=study.name, study=str(study.folder.absolute()))
    found.attrs["units"] = units
    return found


def refuse_taken(names: Sequence[str], place: str) -> None:
    """Raise PopulationError where a user's column has a name that populations need.

    Parameters
    ----------
    names : sequence of str
        Columns of a study's cells, or of a table of groups.
    place : str
        Which it is, for the message.
    """
    taken = [name for name in names if name in _TAKEN]
    if taken:
        raise PopulationError(
            f"{place}: column {taken[0]!r} is one that the cells of a population have anyway: rename yours"
        )


def _kept(names: list[str]) -> list[str]:
    """Columns that a population has: what is measured of cells, and those of the user."""
    of_channels = {column.name for column in channel_columns(channels_among(names))}
    kept = {*PLACES, "status", "reason", *_KEPT, CONDITION, EXPERIMENT} | of_channels
    return [name for name in names if name in kept or name not in _KNOWN]


def _mask_name(study: FoundStudy) -> str:
    path = str(study.provenance.get("inputs", {}).get("masks", {}).get("path", study.name))
    return path.replace("\\", "/").rpartition("/")[2]


def joined_rows(studies: Sequence[FoundStudy]) -> pd.DataFrame:
    """Rows of the cells of all studies, one below the other; for movies those of all frames.

    Raises
    ------
    PopulationError
        A cell stands in two studies.
    """
    parts = [cell_rows(study) for study in studies]
    units = {name: unit for part in parts for name, unit in part.attrs["units"].items()}
    for part in parts:
        part.attrs = {}
    table = pd.concat([part for part in parts if len(part)], ignore_index=True)
    _refuse_a_cell_twice(table, studies)
    table.attrs["units"] = {name: unit for name, unit in units.items() if name in table}
    return table


def _refuse_a_cell_twice(table: pd.DataFrame, studies: Sequence[FoundStudy]) -> None:
    """Raise PopulationError where one cell of one file is in two studies."""
    if len(studies) < 2:
        return
    prints = {study.name: _Prints(study) for study in studies}
    places = table.loc[table["status"] == "ok", ["input", "source", "frame", "label"]].drop_duplicates()
    pairs = places[["input", "source"]].drop_duplicates()
    by_file = {place: prints[place[0]].of(place[1]) for place in pairs.itertuples(index=False, name=None)}
    places = places.assign(
        file=[by_file[place] for place in zip(places["input"], places["source"], strict=True)]
    )
    places = places[places["file"] != ""]
    alike = places[places.duplicated(["file", "frame", "label"], keep=False)]
    for (_, _, label), rows in alike.groupby(["file", "frame", "label"], sort=False):
        first = rows.iloc[0]
        for other in rows.iloc[1:].itertuples():
            if other.input != first["input"] and prints[first["input"]].is_of(prints[str(other.input)]):
                raise PopulationError(
                    f"cell {label} of {first['source']} is in {first['input']} and in {other.input}, which "
                    "have the same file of masks: each cell counts once; leave one of the studies out"
                )


class _Prints:
    """Hashes of the files that a study was made from."""

    def __init__(self, study: FoundStudy) -> None:
        inputs = study.provenance.get("inputs", {})
        self.masks: dict[str, Any] = inputs.get("masks", {})
        signal = inputs.get("signal", {})
        self.signals = {*signal.get("files", {}).values(), signal.get("sha256")} - {None, "unreadable"}

    def of(self, source: str) -> str:
        """Hash of a file of masks; empty where it is unknown."""
        files = self.masks.get("files")
        found = str(self.masks.get("sha256", "") if files is None else files.get(source, ""))
        return "" if found == "unreadable" else found

    def is_of(self, other: _Prints) -> bool:
        """Whether equal masks are one cell: of one file, or with one signal, not a shape that many have."""
        same_path = self.masks.get("path") == other.masks.get("path")
        return same_path or bool(self.signals & other.signals) or not (self.signals or other.signals)


def usable_rows(table: pd.DataFrame, studies: Sequence[FoundStudy], left_out: LeftOut) -> pd.DataFrame:
    """Those cells that have windows, a condition and an experiment; the others are noted with the reason.

    Parameters
    ----------
    table : DataFrame
        One row a cell.
    studies : sequence of FoundStudy
    left_out : LeftOut

    Returns
    -------
    DataFrame
    """
    reason = pd.Series("", table.index)
    for words in reversed([*_reasons(table, studies)]):  # the first one counts
        reason = words.where(words != "", reason)
    left_out.add_cells(table[reason != ""], reason[reason != ""])
    kept = table[reason == ""].drop(columns=["status", "reason"]).reset_index(drop=True)
    kept.attrs = dict(table.attrs)
    return kept


def _reasons(table: pd.DataFrame, studies: Sequence[FoundStudy]) -> Iterator[pd.Series[str]]:
    status, why = table["status"].fillna(""), table["reason"].fillna("")
    yield _words(status != "ok", np.where(why == "", status, status + ": " + why))
    if "nucleus_status" in table and studies[0].run == "map" and studies[0].has_nuclei:
        yield _words(
            table["nucleus_status"] == "none",
            "it was mapped without a nucleus (--missing plain), so its layers are not those of the others",
        )
    for name in (CONDITION, EXPERIMENT):
        if name in table and (known := is_given(table[name])).any():
            yield _words(~known, f"its {name} is empty")


def _words(chosen: pd.Series[bool], words: Any) -> pd.Series[str]:
    return pd.Series(np.where(chosen, words, ""), chosen.index, dtype=object)


def is_given(column: pd.Series[Any]) -> pd.Series[bool]:
    """Whether a column has a value, row by row; blanks are none."""
    return column.notna() & (column.astype(str).str.strip() != "")


def with_columns(cells: pd.DataFrame, columns: dict[str, Any] | pd.DataFrame) -> pd.DataFrame:
    """Cells with more columns, and the same attrs."""
    more = pd.DataFrame(columns, index=cells.index)
    if twice := [str(name) for name in more if name in cells]:
        raise PopulationError(
            f"column {twice[0]!r} of the cells is one that is measured here: rename yours, or leave it out"
        )
    found = pd.concat([cells, more], axis=1)
    found.attrs = dict(cells.attrs)
    return found
