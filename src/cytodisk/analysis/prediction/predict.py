"""Does the past of one signal predict another? Layer by layer, against shifted sources."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.correlation.peaks import false_discovery
from cytodisk.analysis.correlation.prepared_series import DRIFTING_SHARE, drifting_share
from cytodisk.analysis.prediction.chance_gains import chance_gains
from cytodisk.analysis.prediction.lagged_design import rows_with_past
from cytodisk.analysis.prediction.layer_series import LayerSeries, Signals
from cytodisk.analysis.prediction.pooled_autoregression import (
    Held,
    SourceFit,
    best_gain,
    explained,
    fit_source,
    source_columns,
)
from cytodisk.analysis.prediction.prediction_orders import Orders, choose_orders, longest_past, penalty
from cytodisk.analysis.prediction.prediction_parameters import PredictionParameters
from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError, StationarityWarning
from cytodisk.taking import takes

_ALPHA = 0.05


@takes(PredictionParameters)
def predict(
    source: Any,
    target: Any,
    given: Any = (),
    *,
    progress: Callable[[int, int], None] | None = None,
    **settings: Any,
) -> xr.Dataset:
    """Whether the past of `source` predicts `target` beyond that of target, neighbours and given signals.

    Parameters
    ----------
    source, target : DataArray or array_like with dims (time), (time, sector) or (time, layer, sector)
        A target without layers, as edge velocity, serves all layers of the source, and the other way round.
        Frames must be evenly spaced; NaN where one is missing: no model looks across it.
    given : sequence of such signals, or mapping of str to them
        Others that may drive both: their past is in the model with and without the source.
    progress : callable, optional
        Called with (layers done, in all).
    **settings
        See `PredictionParameters`.

    Returns
    -------
    Dataset with the dim layer, where there are layers
        gain, ln of the sum of squared errors without the source over that with it, at least 0 (nats);
        gain_reversed, the same on reversed time, for `weaker_direction` (NaN where too few rows have a
        whole future);
        gain_excess, gain minus the surrogates' mean, which is 0 on average where nothing predicts;
        likelihood_ratio, rows times gain; order, of the target's and its neighbours' past; given_order;
        source_order; n, rows; sectors used; effect, the sum of the source's coefficients in standard
        deviations: its sign says whether more source means more or less target; spread_ratio, the standard
        deviation of the source over that of the target, which turns coefficients into such ones. coefficient
        with coefficient_low and coefficient_high (95 %, robust to sectors that move together), over lag = 1 …
        NaN beyond the order. With surrogates gain_null (layer, surrogate), threshold, which 5 % of them
        exceed, p, and q (Benjamini-Hochberg over layers). reason says why a layer has no values, "" where it
        has.

        A sector in which source or target is constant, or whose neighbours are not known, is not used.

        The attrs are the settings, the names in `given`, `surrogates`, how many were made at most, and
        drifting_source and drifting_target, the share of the series whose level drifts.

    Raises
    ------
    ParameterError
        Signals do not fit each other, are constant, empty or too short, frames are not evenly spaced, or a
        setting is out of its range. A layer among others that cannot be tested has a reason instead.

    Warns
    -----
    StationarityWarning
        The level of more than a quarter of the series of both source and target drifts.

    See Also
    --------
    weaker_direction : Whether a direction may be noise of measurement alone.
    cross_correlate : Correlation at every lag, which does not ask what predicts what.

    Notes
    -----
    One autoregression for a layer is pooled over its sectors, each sector's mean removed. The word is
    "predicts": a third signal that drives both, and is not given, makes one predict the other too.
    Surrogates are the source with what nothing else says of it shifted in time and around the cell; where it
    is the same all around, or there is one sector, half of them run backwards in time.

    References
    ----------
    Granger (1969), doi:10.2307/1912791; Noh et al. (2022), doi:10.1016/j.cels.2022.05.003.

    Examples
    --------
    >>> import numpy as np
    >>> import cytodisk as cd
    >>> random = np.random.default_rng(0)
    >>> source = random.normal(size=(100, 6))  # (time, sector)
    >>> target = 0.4 * np.roll(source, 2, axis=0) + random.normal(size=(100, 6))  # two frames later
    >>> found = cd.predict(source, target, surrogates=99)
    >>> found["p"].item(), found["source_order"].item(), bool(found["effect"] > 0)
    (0.01, 2, True)
    """
    how = PredictionParameters.of(**settings)
    signals = Signals.of(source, target, given)
    drifting = _drifting(signals)
    numbers = signals.layers
    count = 1 if numbers is None else len(numbers)
    found: list[_LayerResult | str] = []
    for place in range(count):
        try:
            found.append(_predict_layer(signals.layer(place, how.neighbours, how.edge_sectors), how))
        except ParameterError as error:
            if count == 1:
                raise
            found.append(str(error))
        if progress is not None:
            progress(place + 1, count)
    if all(isinstance(one, str) for one in found):
        raise ParameterError(f"no layer can be tested: {'; '.join(dict.fromkeys(map(str, found)))}")
    return _dataset(found, signals, how).assign_attrs(drifting)


def _drifting(signals: Signals) -> dict[str, float]:
    """Share of the series of source and target whose level drifts; warns where it is large in both."""
    both = {"source": signals.source, "target": signals.target}
    shares = {f"drifting_{name}": drifting_share(series) for name, series in both.items()}
    if min(shares.values()) > DRIFTING_SHARE:
        warnings.warn(
            f"the level of {shares['drifting_source']:.0%} of the series of source drifts, and of "
            f"{shares['drifting_target']:.0%} of target: one may seem to predict the other for that alone; "
            "take out what is slow with prepare_series(…, detrend='linear')",
            StationarityWarning,
            stacklevel=3,
        )
    return shares


@dataclass(frozen=True, eq=False)
class _LayerResult:
    gain: float
    gain_reversed: float
    orders: Orders
    rows: int
    sectors: int
    fit: SourceFit
    null: FloatArray

    def values(self) -> dict[str, float]:
        """Numbers of the layer, by name."""
        null = self.null
        known = {
            "gain": self.gain,
            "gain_reversed": self.gain_reversed,
            "likelihood_ratio": self.rows * self.gain,
            "order": self.orders.own,
            "given_order": self.orders.given,
            "source_order": self.orders.source,
            "n": self.rows,
            "sectors": self.sectors,
            "effect": self.fit.effect,
            "spread_ratio": self.fit.spread_ratio,
        }
        if null.size:
            known["gain_excess"] = self.gain - null.mean()
            known["threshold"] = np.quantile(null, 1.0 - _ALPHA)
            known["p"] = (1 + np.count_nonzero(null >= self.gain)) / (1 + null.size)
        return known


def _predict_layer(series: LayerSeries, how: PredictionParameters) -> _LayerResult:
    model = _fitted(series, how)
    held, order = model.held, model.orders.source
    values = held.rows.lagged(series.source, range(1, 2))[0]
    fit = fit_source(held, model.columns[:, :order], float(values @ values) / held.rows.size)
    null = np.zeros(0)
    if how.surrogates:
        past = model.columns.shape[1]
        null = chance_gains(
            held, series, model.orders, past, model.price, count=how.surrogates, seed=how.seed
        )
    try:
        back_in_time = _fitted(series.reversed, how).gain
    except ParameterError:  # other rows have a whole future than have a whole past
        back_in_time = np.nan
    return _LayerResult(model.gain, back_in_time, model.orders, held.rows.size, held.rows.sectors, fit, null)


@dataclass(frozen=True, eq=False)
class _Model:
    held: Held
    columns: FloatArray
    orders: Orders
    gain: float
    price: float | None


def _fitted(series: LayerSeries, how: PredictionParameters) -> _Model:
    """The model of a layer: what is held, what that leaves of the source, orders, gain."""
    rows = rows_with_past(series, longest_past(how, bool(series.given)))
    orders = choose_orders(series, rows, how)
    held = Held.of(series, rows, orders)
    most = how.max_order if how.source_order is None else how.source_order
    price = penalty(how.criterion, rows.size) if how.source_order is None else None
    columns = source_columns(held, series, most)
    squares = explained((columns.T @ columns)[None], (columns.T @ held.left)[None])
    gain, order = best_gain(held, squares, price)
    return _Model(held, columns, Orders(orders.own, orders.given, int(order[0])), float(gain[0]), price)


_WHOLE = ("order", "given_order", "source_order", "n", "sectors")
_UNITS = {"gain": "nat", "gain_reversed": "nat", "gain_excess": "nat", "threshold": "nat", "gain_null": "nat"}
_UNITS |= {"order": "frame", "given_order": "frame", "source_order": "frame", "lag": "frame", "lag_s": "s"}


def _dataset(found: list[_LayerResult | str], signals: Signals, how: PredictionParameters) -> xr.Dataset:
    """Numbers of all layers, by layer where there are some."""
    known = [one for one in found if isinstance(one, _LayerResult)]
    data: dict[str, Any] = {}
    for name in known[0].values():
        column = [one.values()[name] if isinstance(one, _LayerResult) else np.nan for one in found]
        whole = [0 if np.isnan(value) else int(value) for value in column]
        data[name] = ("layer", np.array(whole if name in _WHOLE else column))
    most = how.max_order if how.source_order is None else how.source_order
    for name, kept in (
        ("coefficient", "coefficient"),
        ("coefficient_low", "low"),
        ("coefficient_high", "high"),
    ):
        table = [getattr(one.fit, kept) if isinstance(one, _LayerResult) else () for one in found]
        data[name] = (("layer", "lag"), _padded(table, most))
    made = max(one.null.size for one in known)
    if made:
        nulls = [one.null if isinstance(one, _LayerResult) else () for one in found]
        data["gain_null"] = (("layer", "surrogate"), _padded(nulls, made))
        data["q"] = ("layer", false_discovery(np.asarray(data["p"][1], dtype=np.float64)))
    data["reason"] = ("layer", np.array([one if isinstance(one, str) else "" for one in found], dtype=object))
    lags = np.arange(1, most + 1)
    coords: dict[str, Any] = {"lag": lags}
    if signals.scale.frame_interval_s is not None:
        coords["lag_s"] = ("lag", lags * signals.scale.frame_interval_s)
    if signals.layers is not None:
        coords["layer"] = signals.layers
    attrs = {name: value for name, value in how.model_dump().items() if value is not None}
    out = xr.Dataset(data, coords, attrs | {"given": list(signals.given), "surrogates": made})
    for name, unit in _UNITS.items():
        if name in out.variables:
            out[name].attrs["units"] = unit
    return out if signals.layers is not None else out.isel(layer=0)


def _padded(lists: list[Any], size: int) -> FloatArray:
    """Lists of numbers as rows of a table, NaN behind the last."""
    table = np.full((len(lists), size), np.nan)
    for row, numbers in zip(table, lists, strict=True):
        row[: len(numbers)] = numbers
    return table
