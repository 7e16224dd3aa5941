"""One link of a cell: whether a signal predicts another, with what was given, raw and without geometry."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.analysis.correlation.peaks import false_discovery
from cytodisk.analysis.prediction.direction_support import weaker_direction
from cytodisk.analysis.prediction.predict import predict
from cytodisk.analysis.prediction.prediction_parameters import PredictionParameters
from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.errors import ParameterError
from cytodisk.runs.partial_words import SIGNIFICANT
from cytodisk.runs.predict.prediction_columns import LINKS
from cytodisk.runs.run_options import Progress
from cytodisk.runs.used_series.jitter_of_series import drift_is_told

LEAST_LEFT = 0.25
"""Share of a gain that must be left without geometry: half of a partial correlation is a quarter of it."""

_NUMBERS = (
    "gain",
    "gain_excess",
    "likelihood_ratio",
    "order",
    "source_order",
    "effect",
    "n",
    "p",
    "threshold",
    "gain_reversed",
)
_WHOLE = ("order", "source_order", "n")
_ENDS = ("source", "target")
_PARTIAL = ("gain", "gain_excess", "p")


@dataclass(frozen=True, eq=False)
class TestedLink:
    """Result of one source and target in one cell.

    Attributes
    ----------
    source, target : str
    given : tuple of str
    raw : Dataset or None
        Of `predict`; None where it was refused.
    partial : Dataset or None
        The same without geometry.
    reason, partial_reason : str
        Why each was refused; empty if it was not, or not tried.
    stress : str
        What makes p of independent series too small, with commas between.
    """

    source: str
    target: str
    given: tuple[str, ...]
    raw: xr.Dataset | None
    partial: xr.Dataset | None = None
    reason: str = ""
    partial_reason: str = ""
    stress: str = ""

    __test__ = False

    @property
    def surrogates(self) -> int:
        """How many shifted sources there were; 0 where it was refused."""
        return 0 if self.raw is None else int(self.raw.sizes.get("surrogate", 0))

    @property
    def drifting(self) -> float:
        """Share of series that drift, of source or target, whichever is less; NaN where it was refused."""
        shares = [] if self.raw is None else [self.raw.attrs[f"drifting_{one}"] for one in _ENDS]
        return float(min(shares, default=np.nan))

    def rows(self, layers: IntArray) -> pd.DataFrame:
        """Rows of the table of links, one a layer, without q."""
        table = pd.DataFrame({"layer": layers})
        for name in _NUMBERS:
            table[name] = _by_layer(self.raw, name, layers)
        for name in _PARTIAL:
            table[f"{name}_partial"] = _by_layer(self.partial, name, layers)
        known = np.isfinite(table["gain"].to_numpy())
        for name in _WHOLE:
            table.loc[~known, name] = np.nan
        table["status"] = np.where(known, "ok", "refused")
        table["reason"] = [self._reason(int(layer)) for layer in layers]
        for place, (name, words) in enumerate(self._names().items()):
            table.insert(place, name, words)
        return table.assign(stress=self.stress, drifting=self.drifting)

    def lag_rows(self, interval_s: float | None) -> pd.DataFrame:
        """Rows of the table of lags: coefficients that the model has."""
        if self.raw is None:
            return pd.DataFrame()
        names = {"coefficient": "coefficient", "coefficient_low": "low", "coefficient_high": "high"}
        found = (self.raw[list(names)] * self.raw["spread_ratio"]).rename(names).reset_coords(drop=True)
        table = found.to_dataframe(dim_order=["layer", "lag"]).reset_index()
        table = table[table["coefficient"].notna()].reset_index(drop=True)
        lag_s = table["lag"] * interval_s if interval_s is not None else np.nan
        table.insert(2, "lag_s", np.asarray(lag_s, dtype=np.float64) + np.zeros(len(table)))
        for place, name in enumerate(_ENDS):
            table.insert(place, name, getattr(self, name))
        return table

    def _reason(self, layer: int) -> str:
        """Why a layer was refused; of one that was not, why it was without geometry."""
        if whole := _reason_of(self.raw, self.reason, layer):
            return whole
        partial = _reason_of(self.partial, self.partial_reason, layer)
        return f"without geometry: {partial}" if partial else ""

    def _names(self) -> dict[str, str]:
        return {"source": self.source, "target": self.target, "given": ", ".join(self.given)}


def tested_link(
    source: str,
    target: str,
    given: tuple[str, ...],
    series: tuple[Mapping[str, xr.DataArray], Mapping[str, xr.DataArray]],
    how: PredictionParameters,
    progress: list[Progress | None],
) -> TestedLink:
    """Test a source and a target of a cell.

    Parameters
    ----------
    source, target : str
    given : tuple of str
    series : (mapping, mapping)
        Signals by name: as they are, and without geometry, which may be empty.
    how : PredictionParameters
    progress : list of two callables or None
    """
    names = (source, target, *given)
    (raw, reason), (partial, partial_reason) = (
        _predicted(some, names, how, report) for some, report in zip(series, progress, strict=True)
    )
    if raw is None:
        return TestedLink(source, target, given, None, None, reason)
    return TestedLink(source, target, given, raw, partial, "", partial_reason)


def _predicted(
    series: Mapping[str, xr.DataArray],
    names: tuple[str, ...],
    how: PredictionParameters,
    progress: Progress | None,
) -> tuple[xr.Dataset | None, str]:
    """What `predict` finds of source, target and what is given, or why it refuses; nothing of no series."""
    if not series:
        return None, ""
    source, target, *given = names
    beside = {name: series[name] for name in given}
    try:
        with drift_is_told():
            return predict(series[source], series[target], beside, progress=progress, **how.model_dump()), ""
    except ParameterError as error:
        return None, str(error)


def _reason_of(found: xr.Dataset | None, whole: str, layer: int) -> str:
    """Why a layer was refused, by itself or with all others."""
    return whole if found is None else str(found["reason"].sel(layer=layer).item())


def links_table(rows: pd.DataFrame) -> pd.DataFrame:
    """Rows of all links of a cell, with q over all of them and whether they survive without geometry."""
    table = rows.copy()
    for name in ("", "_partial"):
        table[f"q{name}"] = false_discovery(table[f"p{name}"].to_numpy(dtype=np.float64))
    columns = {
        name: table[name].to_numpy(dtype=np.float64) for name in table if table[name].dtype.kind == "f"
    }
    table["geometry"] = does_not_survive(columns)
    table["weaker"] = (table["q"] < SIGNIFICANT).to_numpy() & weaker_links(table)
    for name in _WHOLE:
        table[name] = table[name].round().astype("Int64")
    known = [column.name for column in LINKS if column.name in table]
    return table[known]


def weaker_links(table: pd.DataFrame, within: Sequence[str] = ()) -> BoolArray:
    """Rows that noise of measurement alone would make, by what the other direction has in the same layer.

    Parameters
    ----------
    table : DataFrame
        source, target, layer, gain and gain_reversed; each link and layer once.
    within : sequence of str
        Columns in which both directions must be alike, too.

    Returns
    -------
    ndarray of dtype bool
        See `weaker_direction`.
    """
    keys, gains = ["source", "target", "layer", *within], ["gain", "gain_reversed"]
    back = table[[*keys, *gains]].rename(columns={"source": "target", "target": "source"})
    both = table[[*keys, *gains]].merge(back, "left", keys, suffixes=("", "_back"))
    return weaker_direction(
        both["gain"], both["gain_back"], both["gain_reversed"], both["gain_reversed_back"]
    )


def does_not_survive(columns: Mapping[Any, FloatArray]) -> BoolArray:
    """Whether a significant link is gone, or mostly gone, without geometry.

    Parameters
    ----------
    columns : mapping of str to ndarray
        q, q_partial, gain_excess and gain_excess_partial.

    Returns
    -------
    ndarray of dtype bool
        q < 0.05, and either q_partial ≥ 0.05 or less than a quarter of the gain left. False where it is not
        known without geometry.
    """
    mostly = columns["gain_excess_partial"] < LEAST_LEFT * columns["gain_excess"]
    gone = (columns["q_partial"] >= SIGNIFICANT) | mostly
    return np.asarray((columns["q"] < SIGNIFICANT) & np.isfinite(columns["q_partial"]) & gone)


def _by_layer(found: xr.Dataset | None, name: str, layers: IntArray) -> FloatArray:
    if found is None or name not in found:
        return np.full(len(layers), np.nan)
    values = found[name]
    by_layer = values.reindex(layer=layers) if "layer" in values.dims else values.expand_dims(layer=layers)
    return np.asarray(by_layer.to_numpy(), dtype=np.float64)
