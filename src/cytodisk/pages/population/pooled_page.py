"""The figure of pooled correlations: curves by layer and condition, with what is beyond chance."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from cytodisk.pages.drawn_correlation import VELOCITY_NAMES, Heading
from cytodisk.pages.drawn_movie import LEFT_MM
from cytodisk.pages.population.pooled_figure import save_pooled
from cytodisk.pages.sheet import Sheet, broken_lines
from cytodisk.plot.correlation.curve_key import PARTIAL_LOOK
from cytodisk.plot.correlation.lag_axis import LagUnit
from cytodisk.plot.layer_looks import layer_word, shown_layers
from cytodisk.plot.population.condition_looks import condition_colours
from cytodisk.plot.population.condition_profiles import condition_key
from cytodisk.plot.population.pooled_curve_lines import draw_pooled_curves
from cytodisk.plot.style import LINE_COLOUR, SINGLE_COLUMN_MM
from cytodisk.population.significance import LEVEL
from cytodisk.runs.channel_names import shortened, shown_name
from cytodisk.store.populations.pooled_correlation import PooledCorrelation

FIGURE = "curves"
_CURVE, _GAP, _LEFT = 24.0, 5.5, 14.0  # mm
_LINE, _TITLE_MM = 3.6, 1.9
_LEAST_REACH, _ROOM = 0.1, 1.1
_DOTS_FROM, _DOT_STEP = 0.94, 0.075  # of the axes' reach: where dots of conditions stand
_PARTIAL, _BEYOND = "partial", "beyond chance"
_LONGEST = 18


def write_pooled_figure(pooled: PooledCorrelation, *, formats: Sequence[str] = ("png",)) -> list[Path]:
    """Draw the pooled curves into the folder `figures` of the correlation.

    Parameters
    ----------
    pooled : PooledCorrelation
        As of `run_batch_correlate`.
    formats : sequence of {"png", "pdf", "svg"}

    Returns
    -------
    list of Path

    Raises
    ------
    ParameterError
        A format is unknown.
    StudyError
        The folder cannot be written.

    See Also
    --------
    write_correlation_figures : One movie.

    Examples
    --------
    >>> import tifffile
    >>> from pathlib import Path
    >>> import cytodisk as cd
    >>> movie = cd.simulate.movie("fluctuating", frames=24, radius_px=14)
    >>> tifffile.imwrite("masks.tif", movie.masks.astype("uint8"), photometric="minisblack")
    >>> tifffile.imwrite("signal.ome.tif", movie.signal.to_numpy(), metadata={"axes": "TCYX"})
    >>> lines = ["[study]", "kind = 'movie'", "[parameters]", "channels = ['Rac1', 'RhoA']", "[[inputs]]"]
    >>> lines += ["masks = 'masks.tif'", "signal = 'signal.ome.tif'"]
    >>> _ = Path("batch.toml").write_text("\\n".join(lines))
    >>> _ = cd.run_batch("batch.toml", "all")
    >>> pooled = cd.run_batch_correlate("all", "Rac1", max_lag=3, surrogates=0)
    >>> [path.name for path in cd.pages.write_pooled_figure(pooled)]
    ['curves.png']
    """
    return save_pooled(pooled.path, FIGURE, lambda: pooled_page(pooled), formats)


def pooled_page(pooled: PooledCorrelation) -> Sheet:
    """Correlation against lag, a panel a layer: cells, experiments, and the mean of each condition.

    Parameters
    ----------
    pooled : PooledCorrelation

    Returns
    -------
    Sheet
        85 mm wide. A row of dots at the bottom marks the lags at which a condition's mean is beyond chance.
    """
    table = pooled.pooled
    count = int(table["layer"].nunique())
    layers = shown_layers(count)
    heading = _heading(pooled)
    key = _key(pooled)
    first = heading.height_mm + _LINE * (len(key) + 1) // 2 + 5.0
    sheet = Sheet(first + len(layers) * (_CURVE + _GAP) + 8.0, SINGLE_COLUMN_MM)
    heading.write(sheet)
    reach = _reach(pooled, layers)
    axes = []
    for place, layer in enumerate(layers):
        top = first + place * (_CURVE + _GAP)
        ax = sheet.axes(_LEFT, top, SINGLE_COLUMN_MM - _LEFT - 4.0, _CURVE)
        _draw_layer(ax, pooled, layer, reach)
        ax.set_title(layer_word(layer, count), loc="left", y=1.0, pad=2.0)
        axes.append(ax)
    for ax in axes[:-1]:
        ax.set_xlabel("")
        ax.tick_params(labelbottom=False)
    sheet.key(LEFT_MM, heading.height_mm - 1.0, key, 2, borderaxespad=0.0, handlelength=1.6)
    return sheet


def _heading(pooled: PooledCorrelation) -> Heading:
    signal, other = _names(pooled)
    title = broken_lines(f"{signal} with {other}".split(" "), " ", SINGLE_COLUMN_MM - 2 * LEFT_MM, _TITLE_MM)
    cells = pooled.cells[pooled.cells["status"] == "ok"]
    units = cells.loc[cells["experiment"] != "", ["condition", "experiment"]].drop_duplicates()
    facts = []
    for name in pooled.conditions:
        own = f"{int((cells['condition'] == name).sum())} cells"
        known = int((units["condition"] == name).sum())
        facts.append(f"{name}: {own}, " + (f"{known} experiments" if known else "experiments unknown"))
    return Heading(title, broken_lines(facts, " · ", SINGLE_COLUMN_MM - 2 * LEFT_MM))


def _names(pooled: PooledCorrelation) -> tuple[str, str]:
    """Signal and what it was correlated with, as pictures call them."""
    other = VELOCITY_NAMES.get(pooled.with_) or shown_name(pooled.with_, _LONGEST)
    return shown_name(pooled.signal, _LONGEST), other


def _key(pooled: PooledCorrelation) -> list[Any]:
    colours = condition_colours(list(pooled.conditions))
    lines = [
        Line2D([], [], color=colour, linewidth=1.6, label=shortened(name, _LONGEST))
        for name, colour in colours.items()
    ]
    handles = condition_key(lines, cells=True)
    table = pooled.pooled
    if (table["curve"] == "partial").any():
        handles.append(Line2D([], [], color=LINE_COLOUR, label="without geometry", **PARTIAL_LOOK))
    if (table["p_fwer"] <= LEVEL).any():
        words = f"beyond chance (p ≤ {LEVEL:g})"
        handles.append(
            Line2D([], [], color=LINE_COLOUR, marker=".", markersize=3.5, linewidth=0, label=words)
        )
    return handles


def _draw_layer(ax: Axes, pooled: PooledCorrelation, layer: int, reach: float) -> None:
    """Curves of one layer."""
    own = pooled.curves[pooled.curves["layer"] == layer]
    own = own[own["condition"] != ""]
    order = {name: place for place, name in enumerate(pooled.conditions)}
    own = own.sort_values("condition", key=lambda names: names.map(order), kind="stable")
    unit = LagUnit.of(own)
    own = unit.shown(own)
    places = ["condition", "experiment", "input", "cell"]
    wide = own.pivot_table(index=places, columns=unit.column, values="correlation", sort=False)
    wide = wide.sort_index(axis=1)
    lag = xr.DataArray(wide.columns.to_numpy(np.float64), dims="lag", attrs={"units": unit.unit})
    curves = xr.DataArray(wide.to_numpy(np.float64), dims=("cell", "lag"), coords={"lag": lag})
    signal, other = _names(pooled)
    draw_pooled_curves(ax, curves, wide.index.to_frame(index=False), signal=signal, with_=other)
    ax.set_ylim(-reach, reach)
    colours = condition_colours(list(pooled.conditions))
    rows = unit.shown(pooled.pooled[pooled.pooled["layer"] == layer])
    for place, (name, colour) in enumerate(colours.items()):
        _draw_tested(
            ax, rows[rows["condition"] == name], unit, colour, reach * (_DOTS_FROM - _DOT_STEP * place)
        )


def _draw_tested(ax: Axes, rows: pd.DataFrame, unit: LagUnit, colour: str, height: float) -> None:
    """The partial curve of a condition, and dots at lags at which its raw curve is beyond chance."""
    partial = rows[rows["curve"] == "partial"].sort_values("lag")
    if len(partial):
        (line,) = ax.plot(
            partial[unit.column], partial["correlation"], color=colour, zorder=3.2, **PARTIAL_LOOK
        )
        line.set_gid(_PARTIAL)
    beyond = rows[(rows["curve"] == "raw") & (rows["p_fwer"] <= LEVEL)]
    if len(beyond):
        (dots,) = ax.plot(
            beyond[unit.column], np.full(len(beyond), -height), ".", color=colour, markersize=3.5
        )
        dots.set(gid=_BEYOND, zorder=4.0)


def _reach(pooled: PooledCorrelation, layers: Sequence[int]) -> float:
    """Half of the correlations' axis: nearly all cells, and all means with their intervals."""
    means = pooled.pooled[pooled.pooled["layer"].isin(layers)][["correlation", "low", "high"]]
    cells = pooled.curves[pooled.curves["layer"].isin(layers)]["correlation"].abs()
    largest = [float(np.nanmax(means.abs().to_numpy(np.float64), initial=0.0)), float(cells.quantile(0.98))]
    return min(1.0, max(_ROOM * max(largest), _LEAST_REACH)) * (1.0 + _DOT_STEP * len(pooled.conditions))
