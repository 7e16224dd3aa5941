"""What the columns of a comparison's summaries are."""

from __future__ import annotations

from collections.abc import Iterable

import pandas as pd

BY_LAYER, BY_METHOD, THROUGH_TIME = "comparison.csv", "comparison_methods.csv", "comparison_movie.csv"
COLUMNS_FILE = "comparison_columns.csv"
_ALL = (BY_LAYER, BY_METHOD, THROUGH_TIME)
_MEASURED = (BY_LAYER, BY_METHOD)

# Name, tables, unit, what it is.
_COLUMNS: tuple[tuple[str, Iterable[str], str, str], ...] = (
    (
        "method",
        _ALL,
        "",
        "newton (cytodisk's default), newton-triangles, harmonic, advection (u-Unwrap's), edge, springs, "
        "registered (movies), or rings; "
        "with nuclei newton, nucleus-rings (by distance), or interpolated-rings",
    ),
    ("layer", (BY_LAYER,), "", "0 at the edge"),
    ("channel", (THROUGH_TIME,), "", "channel of the signal; empty without a signal"),
    ("layer", (THROUGH_TIME,), "", "0 at the edge; empty: the mean over layers of each frame"),
    ("tried", _MEASURED, "", "cells (in a movie: frames) whose mask is that of a cell"),
    ("mapped", _MEASURED, "", "those that got windows"),
    ("frames", (THROUGH_TIME,), "", "frames whose windows are in the next frame too"),
    ("invalid_maps", (BY_METHOD,), "", "maps or interpolated rings that are not one to one; empty where "
     "windows need neither"),
    ("flipped", (BY_METHOD,), "", "triangles that maps or interpolated rings turned over, in all"),
    ("area_error", (BY_METHOD,), "1", "mean |log area ratio| of a map; in a movie median over "
     "a cell's frames; median over cells"),
    ("coverage", (BY_METHOD,), "1", "share of the cells' area that lies in windows"),
    ("lost_px", (BY_METHOD,), "px²", "area of cells in no window or off their map, in all"),
    ("empty_windows", (BY_METHOD,), "", "windows without any part of the cell, in all"),
    ("folded", (BY_METHOD,), "1", "share of the cell where the field of a registration folds; median over "
     "a cell's frames, mean over cells"),
    ("carried_outside", (BY_METHOD,), "1", "share of the windows' area that a registration carries out of "
     "the cell, likewise"),
    ("completeness", _MEASURED, "1", "share of windows that are filled, that is have a part of the cell; "
     "what was not mapped counts as empty"),
    ("completeness_mapped", _MEASURED, "1", "the same, of what was mapped alone"),
    ("area_cv", (BY_LAYER,), "1", "coefficient of variation of the area of a layer's windows, median"),
    ("eccentricity_cv", (BY_LAYER,), "1", "coefficient of variation of their eccentricity, median"),
    ("eccentricity", (BY_LAYER,), "1", "mean eccentricity of a layer's windows (0 round, 1 a line), median"),
    ("area_cv", (BY_METHOD,), "1", "coefficient of variation of the area of a layer's windows, median over "
     "layers and cells (in a movie: frames)"),
    ("eccentricity_cv", (BY_METHOD,), "1", "coefficient of variation of their eccentricity, median likewise"),
    ("layer_pieces", (BY_LAYER,), "1", "pieces that a layer as a whole is in, median"),
    ("pieces", (BY_LAYER,), "1", "pieces that a filled window is in, mean"),
    ("one_piece", (BY_LAYER,), "1", "share of filled windows that are in one piece, mean"),
    ("outside", (BY_METHOD,), "1", "share of the points of interpolated rings outside the cell, mean"),
    ("overlap", (BY_METHOD,), "1", "share of a cell's area in several interpolated windows, mean"),
    ("area_error_cytoplasm", (BY_METHOD,), "1", "mean |ln| of the areas of windows of the cytoplasm over "
     "their mean, median; empty windows count in the mean alone"),
    ("area_error_nucleus", (BY_METHOD,), "1", "the same of the nucleus"),
    ("outer_fifth", (BY_METHOD,), "1", "share of the cytoplasm in the outermost of five layers, mean; a "
     "fifth where all layers are equal"),
    ("nearness", (BY_METHOD,), "1", "rank correlation of layers of the cytoplasm with the nearness of their "
     "pixels to the nucleus, mean"),
    ("compartment", (BY_LAYER,), "", "cytoplasm or nucleus"),
    ("relative_area", (BY_LAYER,), "1", "mean area of a layer's windows over that of all windows of the "
     "compartment, median"),
    ("seconds", (BY_METHOD,), "s", "time for one cell (in a movie: a frame, tracking included), median"),
    ("correlation", (THROUGH_TIME,), "1", "Pearson correlation of the means of a layer's windows with "
     "those in the next frame, median over frames"),
    ("centroid_displacement", (THROUGH_TIME,), "length", "how far a layer's window centroids move to the "
     "next frame, mean over windows, median over frames"),
)  # fmt: skip
_OVER = {
    BY_LAYER: "over cells (in a movie: frames)",
    BY_METHOD: "over cells; empty for a single one",
    THROUGH_TIME: "over frames",
}
_SHARES = {"q25": "a quarter lies below", "q75": "a quarter lies above"}


def units_of(table: pd.DataFrame, name: str, length_unit: str) -> dict[str, str]:
    """Unit of each column of a summary.

    Parameters
    ----------
    table : DataFrame
    name : {"comparison.csv", "comparison_methods.csv", "comparison_movie.csv"}
        Its file.
    length_unit : {"µm", "px"}

    Returns
    -------
    dict of str to str
        "" for counts and names, "1" for what has no unit.
    """
    return {column: _told(column, name, length_unit)[0] for column in table.columns}


def describe_columns(tables: dict[str, pd.DataFrame], length_unit: str) -> pd.DataFrame:
    """Table, name, unit, and a line of description of each column.

    Parameters
    ----------
    tables : dict of str to DataFrame
        Summaries by their files.
    length_unit : {"µm", "px"}

    Returns
    -------
    DataFrame
    """
    rows = [
        (column, name, *_told(column, name, length_unit))
        for name, table in tables.items()
        for column in table.columns
    ]
    return pd.DataFrame(rows, columns=["name", "table", "unit", "description"])


def _told(column: str, table: str, length_unit: str) -> tuple[str, str]:
    """Unit and description of a column; a quartile's are those of its measure."""
    measure, _, end = column.rpartition("_")
    if end in _SHARES:
        measure = "completeness_mapped" if measure == "completeness" else measure
        unit, _ = _told(measure, table, length_unit)
        return unit, f"quartile of {measure} {_OVER[table]}: {_SHARES[end]}"
    ((unit, words),) = [
        (unit, words) for name, tables, unit, words in _COLUMNS if name == column and table in tables
    ]
    return unit.replace("length", length_unit), words
