"""The table of groups of a run: checked against the cells before the run, filled into the tables after it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from cytodisk.errors import ParameterError
from cytodisk.files import replacing
from cytodisk.runs.groups.groups import GroupedCells, Groups
from cytodisk.store.merging import repeating
from cytodisk.store.study_folder import StudyFolder
from cytodisk.store.study_kind import CELLS, StudyKind

_NEEDED = ("cell", "source", "frame", "label")


@dataclass(frozen=True, eq=False)
class GivenGroups:
    """A table of groups that fits the cells of a run.

    Attributes
    ----------
    groups : Groups
    cells : DataFrame
        Of the run, as far as files tell: `source`, `label` and `frame`.
    paths : dict of str to Path
        The mask files by their name; a movie has one.

    Raises
    ------
    ParameterError
        It does not fit them; see `Groups.match`.
    """

    groups: Groups
    cells: pd.DataFrame
    paths: Mapping[str, Path]

    def __post_init__(self) -> None:
        self.found  # noqa: B018  raises where the table does not fit

    @cached_property
    def found(self) -> GroupedCells:
        """What it says of the cells."""
        return self.match(self.cells)

    @property
    def words(self) -> str:
        """What the table was read as."""
        return self.found.words

    def match(self, cells: pd.DataFrame) -> GroupedCells:
        """What it says of cells of the run, in the order of their table."""
        named = cells[[name for name in _NEEDED if name in cells]]
        named = named if "source" in named else named.assign(source=next(iter(self.paths)))
        path = named["source"].map({name: str(path) for name, path in self.paths.items()})
        return self.groups.match(named.assign(path=path))

    def kind(self, kind: StudyKind) -> StudyKind:
        """A kind of study whose cells have the columns of the table.

        Raises
        ------
        ParameterError
            A column has a name that the tables of the study have anyway.
        """
        taken = {column.name for columns in kind.tables.values() for column in columns}
        self.refuse(taken)
        return kind.with_own(self.groups.columns)

    def refuse(self, taken: set[str]) -> None:
        """Raise ParameterError if a column has one of these names."""
        for name in self.groups.names:
            if name in taken:
                raise ParameterError(
                    f"table of groups {self.groups.path}: column {name!r} is one that the tables of this run "
                    "have anyway: choose another name"
                )

    def fill(self, folder: StudyFolder) -> None:
        """Write the columns into the table of cells of a study.

        Parameters
        ----------
        folder : StudyFolder
            All tables stand, of a kind that `kind` returned.
        """
        path = folder.path / CELLS
        table = pq.read_table(path)
        cells = table.select([name for name in _NEEDED if name in table.column_names]).to_pandas()
        table = with_values(table, self.match(cells).values)
        with replacing(path) as temporary:
            pq.write_table(table, temporary, use_dictionary=repeating(table.schema))


def with_values(table: pa.Table, values: pd.DataFrame) -> pa.Table:
    """An Arrow table whose columns of these names have these values."""
    for name in values:
        place = table.schema.get_field_index(name)
        field = table.schema.field(place)
        table = table.set_column(place, field, pa.array(values[name], field.type, from_pandas=True))
    return table
