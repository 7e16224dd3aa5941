"""Summaries of a comparison: what its tables say over all cells and frames."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

_TRIED = ("ok", "no map", "partly")  # what the others are is no cell
_SPREAD = ("area_cv", "eccentricity_cv")
_THROUGH_TIME = ("correlation", "centroid_displacement")
_WITH_NUCLEI = (
    "outside",
    "overlap",
    "area_error_cytoplasm",
    "area_error_nucleus",
    "outer_fifth",
    "nearness",
)


def layer_summary(cells: pd.DataFrame, layers: pd.DataFrame, methods: tuple[str, ...]) -> pd.DataFrame:
    """Measures of each method and layer over all cells, or all frames of a movie.

    Parameters
    ----------
    cells, layers : DataFrame
        Tables of a comparison.
    methods : tuple of str

    Returns
    -------
    DataFrame
        completeness is the share of filled windows of all cells that were tried, so that a cell that could
        not be mapped counts as empty; completeness_mapped that of the mapped ones alone, with its quartiles
        over cells. Of area_cv, eccentricity_cv and eccentricity the median and quartiles over cells; of
        layer_pieces the median; of pieces and one_piece the mean. In a movie "cells" are frames. With nuclei
        compartment, and of relative_area the median and quartiles.
    """
    rows = []
    for method in methods:
        tried, mapped = _counts(cells, method)
        own = layers[layers["method"] == method]
        for layer, group in own.groupby("layer"):
            row: dict[str, Any] = {"method": method, "layer": layer, "tried": tried, "mapped": mapped}
            row["completeness"] = group["completeness"].sum() / tried
            row["completeness_mapped"] = group["completeness"].mean()
            row |= _quartiles(group["completeness"], "completeness")
            more: tuple[str, ...] = ()
            if "compartment" in group:
                row["compartment"], more = group["compartment"].iloc[0], ("relative_area",)
            for name in (*_SPREAD, "eccentricity", *more):
                row[name] = group[name].median()
                row |= _quartiles(group[name], name)
            row["layer_pieces"] = group["layer_pieces"].median()
            row |= {name: group[name].mean() for name in ("pieces", "one_piece")}
            rows.append(row)
    return pd.DataFrame(rows)


def method_summary(cells: pd.DataFrame, layers: pd.DataFrame, methods: tuple[str, ...]) -> pd.DataFrame:
    """What each method made of all cells, or all frames of a movie.

    Parameters
    ----------
    cells, layers : DataFrame
        Tables of a comparison.
    methods : tuple of str

    Returns
    -------
    DataFrame
        tried, mapped, invalid_maps (null where there is no map), flipped triangles, area error (mean |log λ|,
        of a movie's cell its median over frames; median over cells with quartiles, which are null for one
        cell), coverage (of all mapped cells' area), lost_px, empty_windows,
        completeness over all windows of all cells tried and of those mapped, medians of area_cv and
        eccentricity_cv over cells and layers, median seconds. With a registration means over cells of folded
        and carried_outside. With nuclei means over cells of outside, overlap, outer_fifth and nearness,
        medians of area_error_cytoplasm and area_error_nucleus; quartiles.
    """
    rows = []
    for method in methods:
        tried, mapped = _counts(cells, method)
        own = layers[layers["method"] == method]
        done = cells[(cells["method"] == method) & (cells["mapped"] > 0)]
        row: dict[str, Any] = {"method": method, "tried": tried, "mapped": mapped}
        row |= {name: done[name].sum(min_count=1) for name in ("invalid_maps", "flipped")}
        row["area_error"] = done["area_distortion"].median()
        spread = done["area_distortion"] if len(done) > 1 else done["area_distortion"].iloc[:0]
        row |= _quartiles(spread, "area_error")
        row["coverage"] = np.average(done["coverage"], weights=done["area_px"]) if len(done) else np.nan
        row |= {name: done[name].sum() for name in ("lost_px", "empty_windows")}
        n_layers = own["layer"].nunique()
        row["completeness"] = own["completeness"].sum() / (tried * n_layers) if n_layers else 0.0
        row["completeness_mapped"] = own["completeness"].mean()
        row |= {name: own[name].median() for name in _SPREAD}
        row |= {name: done[name].mean() for name in _registered(cells)}
        for name in _WITH_NUCLEI if "outer_fifth" in done else ():
            error = name.startswith("area_error")
            row[name] = done[name].median() if error else done[name].mean()
            row |= _quartiles(done[name] if len(done) > 1 else done[name].iloc[:0], name)
        row["seconds"] = done["seconds"].median()
        rows.append(row)
    return pd.DataFrame(rows)


def movie_summary(consistency: pd.DataFrame, methods: tuple[str, ...]) -> pd.DataFrame:
    """Likeness of consecutive frames and motion of window centroids over all frames of all cells.

    Parameters
    ----------
    consistency : DataFrame
        Table of a comparison.
    methods : tuple of str

    Returns
    -------
    DataFrame
        One row a method, channel and layer, and before them one for all layers, whose `layer` is null. Frames
        with a next one; median and quartiles over them of correlation and centroid_displacement, for all
        layers of a frame's mean over layers.

    References
    ----------
    u-Unwrap, Fig. 4C and D.
    """
    frame = ["cell", "frame"]
    rows = []
    for method in methods:
        own = consistency[consistency["method"] == method]
        for channel, group in own.groupby("channel", dropna=False, sort=False):
            in_all = group.groupby(frame)[list(_THROUGH_TIME)].mean()
            parts = [(None, in_all), *group.groupby("layer")]
            for layer, part in parts:
                row: dict[str, Any] = {"method": method, "channel": channel, "layer": layer}
                row["frames"] = int(part["centroid_displacement"].notna().sum())
                for name in _THROUGH_TIME:
                    row[name] = part[name].median()
                    row |= _quartiles(part[name], name)
                rows.append(row)
    found = pd.DataFrame(rows)
    return found.astype({"layer": "Int64"}) if rows else found


def _registered(cells: pd.DataFrame) -> list[str]:
    """Columns of a registration, if there was one."""
    return [name for name in ("folded", "carried_outside") if name in cells and cells[name].notna().any()]


def _counts(cells: pd.DataFrame, method: str) -> tuple[int, int]:
    """Cells, or frames, that were tried, and those mapped."""
    own = cells[(cells["method"] == method) & cells["status"].isin(_TRIED)]
    return int(own["frames"].sum()), int(own["mapped"].sum())


def _quartiles(values: pd.Series[float], name: str) -> dict[str, float]:
    return {f"{name}_q25": float(values.quantile(0.25)), f"{name}_q75": float(values.quantile(0.75))}
