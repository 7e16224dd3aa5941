"""The tables of a run over shapes: what is measured of each cell, and what the names mean."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from cytodisk.analysis.shape.complexity import complexity_score, why_unscored
from cytodisk.analysis.shape.features import FEATURES, GROUPS, SCALE_FREE, feature_table
from cytodisk.analysis.shape.score_parameters import ScoreParameters
from cytodisk.errors import EarlierVersionWarning
from cytodisk.files import replacing
from cytodisk.runs.groups.given_groups import GivenGroups
from cytodisk.scale import Scale
from cytodisk.store.columns_file import write_columns_file
from cytodisk.store.csv_tables import write_csv
from cytodisk.store.provenance_file import other_maps, read_complete, writer_of
from cytodisk.store.study_folder import StudyFolder
from cytodisk.store.study_kind import CELLS, StudyKind
from cytodisk.store.tables import (
    CELL,
    FRAME,
    LABEL,
    NOTES,
    QC_FLAGS,
    REASON,
    SOURCE,
    STATUS,
    TOUCHES_BORDER,
    Columns,
    read_table,
    write_table,
)

SHAPES, SHAPES_CSV, FEATURES_CSV = "shapes.parquet", "shapes.csv", "features.csv"
SCORES = ("complexity", "umap_1", "umap_2")
_SCORE_WORDS = {
    "complexity": "place of the shape among those of the run, from plain to complex; empty if there are few",
    "umap_1": "first coordinate of the shape in the plane of the score",
    "umap_2": "second coordinate of the shape in the plane of the score",
}
_CELL: Columns = (CELL, SOURCE, FRAME, LABEL, STATUS, REASON, NOTES, QC_FLAGS, TOUCHES_BORDER)
SHAPE_STUDY = StudyKind(
    "shapes",
    "cytodisk shapes",
    "look at shapes.csv and the figures, or read it with open_shapes",
    _CELL,  # without features, which are in the table of shapes
    {},
    (SHAPES, SHAPES_CSV, FEATURES_CSV),
)

SHAPE_NAMES = {*SCORES, *(feature.name for feature in FEATURES)}
"""Of the columns of the table of shapes beside those of cells."""


def shape_table(rows: Iterable[dict[str, Any]], scale: Scale, parameters: ScoreParameters) -> pd.DataFrame:
    """The rows of all cells with their complexity.

    Parameters
    ----------
    rows : iterable of dict
        As `shape_row` returns them, with cell, source, frame and label before.
    scale : Scale
    parameters : ScoreParameters
        See `complexity_score`.

    Returns
    -------
    DataFrame
        As `shape_features` returns it, with "source", and "complexity", "umap_1" and "umap_2" before the
        features: NaN where cells cannot be scored, see `why_unscored`.
    """
    table = feature_table(list(rows), scale)
    attrs, first = table.attrs, table.columns.get_loc(GROUPS[0].features[0].name)
    if not why_unscored(table):
        score = complexity_score(table, **dict(parameters))
        attrs |= {name: score.attrs[name] for name in ("axis_share", "first_component")}
    else:
        score = pd.DataFrame(np.nan, table.index, SCORES)
    joined = pd.concat([table.iloc[:, :first], score[list(SCORES)], table.iloc[:, first:]], axis=1)
    joined.attrs = attrs | {"units": dict.fromkeys(SCORES, "1") | attrs["units"]}
    return joined


def write_shapes(table: pd.DataFrame, folder: Path) -> None:
    """Write the table of shapes.

    Parameters
    ----------
    table : DataFrame
        As `shape_table` returns it.
    folder : Path
    """
    with replacing(folder / SHAPES) as temporary:
        write_table(table, temporary)


def with_own(table: pd.DataFrame, groups: GivenGroups | None) -> pd.DataFrame:
    """The table of shapes with the columns of a table of groups behind the label, if there is one.

    Parameters
    ----------
    table : DataFrame
        As `shape_table` returns it.
    groups : GivenGroups, optional

    Returns
    -------
    DataFrame
    """
    if groups is None:
        return table
    place = list(table.columns).index(LABEL.name) + 1
    own = groups.match(table).values
    joined = pd.concat([table.iloc[:, :place], own, table.iloc[:, place:]], axis=1)
    joined.attrs = table.attrs | {"units": dict.fromkeys(own, "") | table.attrs["units"]}
    return joined


def write_shape_texts(folder: StudyFolder, groups: GivenGroups | None = None) -> None:
    """Write the table of shapes as CSV, and what its features and the columns of all tables are.

    Parameters
    ----------
    folder : StudyFolder
        All tables stand.
    groups : GivenGroups, optional
        Its columns are filled into the table of cells.
    """
    own: Columns = ()
    if groups is not None:
        groups.fill(folder)
        own = groups.groups.columns
    table = read_table(folder.path / SHAPES)
    units = table.attrs["units"]
    write_csv(table, folder.path / SHAPES_CSV)
    write_csv(describe_features(units), folder.path / FEATURES_CSV)
    meanings = {column.name: column.meaning for column in (*_CELL, *own)} | _SCORE_WORDS
    meanings |= {feature.name: feature.description for feature in FEATURES}
    told = [(SHAPES, name, unit, meanings[name]) for name, unit in units.items()]
    cells = [(CELLS, column.name, column.unit, column.meaning) for column in folder.kind.cells]
    write_columns_file(folder.path, [*cells, *told])


def describe_features(units: dict[str, str]) -> pd.DataFrame:
    """Name, group, unit, whether it is scale-free, and a line of description of each feature.

    Parameters
    ----------
    units : dict of str to str
        By name of the feature.

    Returns
    -------
    DataFrame
    """
    rows = [
        (feature.name, group.name, units[feature.name], feature.scale_free, feature.description)
        for group in GROUPS
        for feature in group.features
    ]
    return pd.DataFrame(rows, columns=["name", "group", "unit", "scale_free", "description"])


def open_shapes(path: str | os.PathLike[str]) -> pd.DataFrame:
    """Read what `cytodisk shapes` wrote.

    Parameters
    ----------
    path : path-like
        Its folder.

    Returns
    -------
    DataFrame
        A row a cell with its complexity and features; units by column in `attrs["units"]`.

    Raises
    ------
    ReadError
        The folder holds no complete run of `cytodisk shapes`.

    Warns
    -----
    EarlierVersionWarning
        Some features come from maps of another version.

    See Also
    --------
    run_shapes : Writes the table.
    open_study : Read what run_map or run_movie wrote.

    Examples
    --------
    >>> import tifffile
    >>> import cytodisk as cd
    >>> tifffile.imwrite("labels.tif", cd.simulate.label_image(cells=3))
    >>> _ = cd.run_shapes("labels.tif", "shapes")  # three cells: features, but no complexity
    >>> table = cd.open_shapes("shapes")
    >>> table["status"].tolist(), table.attrs["units"]["area"]
    (['ok', 'ok', 'ok'], 'px²')
    """
    folder = Path(path)
    provenance = read_complete(folder, SHAPE_STUDY.run)
    if other_maps(provenance):
        warnings.warn(
            f"shapes {folder}: features of distortion were measured on maps by {writer_of(provenance)}. Do "
            "not compare them, or the complexity, with those of tables made now.",
            EarlierVersionWarning,
            stacklevel=2,
        )
    table = read_table(folder / SHAPES)
    table.attrs["scale_free"] = list(SCALE_FREE)
    table.attrs["description"] = {feature.name: feature.description for feature in FEATURES}
    return table
