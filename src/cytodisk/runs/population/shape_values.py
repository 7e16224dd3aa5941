"""What a cell of `cytodisk shapes` contributes to a population: its features, and the complexity score."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pandas as pd

from cytodisk.analysis.shape.complexity import complexity_score, why_unscored
from cytodisk.analysis.shape.features import FEATURES, TOO_SMALL, split_qc_flags
from cytodisk.analysis.shape.score_parameters import ScoreParameters
from cytodisk.errors import PopulationError
from cytodisk.images.short_lists import shortened

COMPLEXITY = "complexity"
"""Column of the score."""
_SCORES = (COMPLEXITY, "umap_1", "umap_2")


class ShapeScalars(NamedTuple):
    """Columns of a table of shapes that are compared between conditions.

    Attributes
    ----------
    names : tuple of str
        The complexity first, where there is one, then the features.
    units : dict of str to str
    sentences : tuple of str
        What a reader must know: how the score was made, which features are left out and why.
    """

    names: tuple[str, ...]
    units: dict[str, str]
    sentences: tuple[str, ...]


def joined_shapes(tables: Sequence[pd.DataFrame], parameters: ScoreParameters | None = None) -> pd.DataFrame:
    """Tables of shapes of several runs as one, whose cells are scored together.

    A score is a place among the cells that were scored with it, so the scores of several runs cannot be
    compared: they are made anew. One table stays as it is.

    Parameters
    ----------
    tables : sequence of DataFrame
        Each as `open_shapes` returns it.
    parameters : ScoreParameters, optional

    Returns
    -------
    DataFrame
        Rows under each other, numbered from 0; the score is NaN where cells cannot be scored.

    Raises
    ------
    PopulationError
        There is no table, or lengths are in different units.
    """
    if not tables:
        raise PopulationError("there are no tables of shapes: pass what cytodisk shapes wrote")
    first = tables[0]
    if len(tables) == 1:
        return first
    units = [table.attrs["units"] for table in tables]
    lengths = sorted({one["area"] for one in units})
    if len(lengths) > 1:
        raise PopulationError(
            f"areas of shapes are in {' and '.join(lengths)}: run cytodisk shapes with --pixel-size on all"
        )
    attrs = {name: value for name, value in first.attrs.items() if name != "axis_share"}
    joined = pd.concat(_plain(tables), ignore_index=True)
    joined.attrs = attrs
    score = pd.DataFrame(np.nan, joined.index, list(_SCORES))
    if not why_unscored(joined):
        score = complexity_score(joined, **dict(parameters or ScoreParameters()))
    for name in _SCORES:
        joined[name] = score[name].to_numpy()
    return joined


def shape_scalars(table: pd.DataFrame) -> ShapeScalars:
    """The columns of a table of shapes that can be compared between conditions.

    Parameters
    ----------
    table : DataFrame
        As `open_shapes` or `joined_shapes` returns it.

    Returns
    -------
    ShapeScalars

    Notes
    -----
    The complexity score is made of all cells of all conditions together, without their conditions. So it is
    the same number whatever the labels are, and a test that permutes labels keeps its level. Its axis has no
    sign of its own and is turned so that circularity falls along it: a higher score means more edge for its
    area, in every run. Its size has no unit and depends on which cells are scored together.

    All columns are tested together (max-T over them): a hundred features cost power, but not the level.
    """
    measured = table[table["status"] == "ok"]
    known = [feature for feature in FEATURES if feature.name in table]
    fixed = [feature.name for feature in known if not _varies(measured[feature.name])]
    names = [feature.name for feature in known if feature.name not in fixed]
    sentences = []
    if COMPLEXITY in table and _varies(measured[COMPLEXITY]):
        names.insert(0, COMPLEXITY)
        sentences.append(
            f"The complexity score was made of all {int(measured[COMPLEXITY].notna().sum())} cells together, "
            "without their conditions, so its test keeps its level. Higher means more edge for the area."
        )
    else:
        sentences.append(f"There is no complexity score: {why_unscored(table) or 'it was not made'}.")
    if fixed:
        sentences.append(
            f"{len(fixed)} features are equal in all cells and not compared: {shortened(fixed)}."
        )
    small = int(split_qc_flags(measured["qc_flags"])[0].sum()) if "qc_flags" in measured else 0
    if small:
        sentences.append(
            f"{small} of {len(measured)} cells are {TOO_SMALL}: a difference in size may look like "
            "one in shape."
        )
    units = {name: str(table.attrs["units"].get(name, "1")) for name in names}
    return ShapeScalars(tuple(names), units, tuple(sentences))


def _varies(values: pd.Series) -> bool:
    finite = values[np.isfinite(values.astype(np.float64))]
    return len(finite) > 1 and bool(finite.max() > finite.min())


def _plain(tables: Sequence[pd.DataFrame]) -> list[pd.DataFrame]:
    """The tables without attrs, which pandas compares one by one."""
    copies = [table.copy() for table in tables]
    for copy in copies:
        copy.attrs = {}
    return copies
