"""Cases of correlations that biology did not make."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from case_study import cell_axes, correlated, draw_outline, flags_said, study_of
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.interpolate import CubicSpline

import cytodisk as cd
from cytodisk.arrays import FloatArray
from cytodisk.plot.style import CHANCE_COLOUR, INWARD_COLOUR, OUTWARD_COLOUR
from cytodisk.simulate.movie_signals import rasterised

SEED = 1000
ALPHA = 0.05
APART = 4.0  # standard deviations between two curves and the middle
Help = tuple[str, dict[str, Any]]
RANKS: Help = ("ranks", {"statistic": "spearman"})
SHIFTS: Help = ("shifts", {"null": "shift", "max_lag": 2})
SECTORS, LAYERS = 24, 5
RADIUS_PX, STEP_PX = 50.0, 0.25


def draw_curve(axes: Axes, study: cd.Study, signal: str, layer: int = 0) -> None:
    """Correlation of a layer's mean by lag, over the band that chance gives."""
    rows = study.correlation(signal, "velocity").layer_curves
    rows = rows[rows["layer"] == layer].sort_values("lag")
    height = rows["threshold"]
    axes.fill_between(rows["lag"], -height, height, color=CHANCE_COLOUR, linewidth=0, label="95 % of chance")
    axes.plot(rows["lag"], rows["correlation"], ".-", color=OUTWARD_COLOUR, markersize=3, label="correlation")
    if "correlation_partial" in rows:
        axes.plot(rows["lag"], rows["correlation_partial"], color=INWARD_COLOUR, label="without geometry")
    axes.legend(frameon=False)
    axes.axhline(0.0, color="0.6", linewidth=0.5)
    axes.set(xlabel="lag (frames)", ylabel=f"correlation, layer {layer}", ylim=(-1, 1))


def jitter(figure: Figure, folder: Path) -> list[str]:
    """Masks that waver by half a pixel over a fixed pattern."""
    truth = cd.simulate.movie("fluctuating", SEED, frames=120, radius_px=30.0, jitter_px=0.7, signals=False)
    signal = cd.simulate.passive_signal("still", truth.masks, SEED)
    study = correlated(study_of(folder, truth.masks, {"actin": signal}), "actin")
    cell, graph = figure.subplots(1, 2, width_ratios=(1, 1.4))
    for frame, shade in ((20, "0.6"), (21, "0")):
        draw_outline(cell, truth.masks[frame], color=shade)
    cell_axes(cell, "frames 20 and 21")
    draw_curve(graph, study, "actin")
    return flags_said(study, "jitter")


def _by_geometry(kind: Any, figure: Figure, folder: Path) -> list[str]:
    seed = SEED + (kind == "cortex")
    truth = cd.simulate.movie("fluctuating", seed, frames=100, radius_px=35.0, signals=False)
    signal = cd.simulate.passive_signal(kind, truth.masks, seed)
    study = correlated(study_of(folder, truth.masks, {"signal": signal}), "signal")
    cell, graph = figure.subplots(1, 2, width_ratios=(1, 1.4))
    shown = cell.imshow(signal[0], cmap="viridis")
    for frame in (0, 50):
        draw_outline(cell, truth.masks[frame], color="w" if kind == "still" else OUTWARD_COLOUR)
    cell_axes(cell, "frame 0, outline of frame 50 too")
    cell.invert_yaxis()
    figure.colorbar(shown, ax=cell, label="signal (a.u.)", shrink=0.8)
    layers = study.correlation("signal", "velocity").layers
    draw_curve(graph, study, "signal", int(layers.loc[layers["correlation"].abs().idxmax(), "layer"]))
    return flags_said(study, "geometry")


def drawn_series(kind: Any, frames: int = 120, seed: int = SEED) -> tuple[Any, FloatArray]:
    """A movie whose edge and whose signal follow independent series, each sector its own."""
    activity, velocity = cd.simulate.independent_series(kind, seed, frames, LAYERS, SECTORS)
    displacement = np.cumsum(STEP_PX * velocity.to_numpy(), axis=0)
    time = np.linspace(0.0, 1.0, frames)[:, None]
    displacement -= displacement[:1] + time * (displacement[-1:] - displacement[:1])  # stays where it is
    middle = (np.arange(SECTORS + 1) + 0.5) * 2 * np.pi / SECTORS
    angle = np.linspace(0.0, 2 * np.pi, 720, endpoint=False)
    around = CubicSpline(middle, displacement[:, [*range(SECTORS), 0]], axis=1, bc_type="periodic")
    radius = RADIUS_PX + around(angle)
    size = int(2 * radius.max() + 20)
    directions = np.stack([np.sin(angle), np.cos(angle)], axis=1)
    masks = np.stack([rasterised(size / 2 + r[:, None] * directions, (size, size)) for r in radius])
    row, column = np.indices((size, size)) - size / 2
    sector = (np.arctan2(row, column) % (2 * np.pi) * SECTORS / (2 * np.pi)).astype(int) % SECTORS
    layer = np.clip((np.hypot(row, column) / RADIUS_PX) ** 2 * LAYERS, 0, LAYERS - 1).astype(int)
    values = activity.to_numpy()[:, LAYERS - 1 - layer, sector]
    noise = np.random.default_rng(seed).normal(0.0, 5.0, values.shape)
    return masks, 200.0 + 20.0 * values + noise


def _stressed(kind: Any, flag: str, help_: Help, figure: Figure, folder: Path) -> list[str]:
    masks, signal = drawn_series(kind)
    study = correlated(study_of(folder, masks, {"signal": signal}), "signal")
    said = flags_said(study, flag)
    windows = study.correlation("signal", "velocity").windows
    name, settings = help_
    with_help = correlated(study, "signal", name="helped", **settings)
    helped = with_help.correlation("signal", "velocity", "helped").windows
    series, bars = figure.subplots(1, 2, width_ratios=(1.6, 1))
    _draw_window(series, study, windows.loc[windows["correlation"].abs().idxmax()])
    shares = [100.0 * float((table["p"] < ALPHA).mean()) for table in (windows, helped)]
    drawn = bars.bar(["values", name], shares, color=(OUTWARD_COLOUR, INWARD_COLOUR), width=0.6)
    bars.bar_label(drawn, fmt="%.0f %%")
    bars.axhline(100.0 * ALPHA, color="0.3", linewidth=0.7, linestyle="--", label="chance: 5 %")
    bars.set(ylabel="windows with p < 0.05 (%)", ylim=(0, max(20.0, 1.35 * max(shares))))
    bars.legend(frameon=False, loc="upper right")
    return said


def _draw_window(axes: Axes, study: cd.Study, row: Any) -> None:
    """Velocity and signal of a window, one above the other, each in its own standard deviations."""
    layer, sector = int(row["layer"]), int(row["sector"])
    activity = study.activity(0).isel(sector=sector)
    pair = {
        "velocity": (activity["velocity"], OUTWARD_COLOUR, APART),
        "signal": (activity["mean"].isel(channel=0, layer=layer), INWARD_COLOUR, -APART),
    }
    for name, (values, colour, offset) in pair.items():
        axes.plot((values - values.mean()) / values.std() + offset, color=colour, linewidth=0.7, label=name)
    p = f"{row['correlation']:+.2f} at lag {row['lag']:.0f}, p = {row['p']:.2g}"
    axes.set(xlabel="frame", ylabel="velocity and signal", yticks=[], title=f"one window: {p}")
    axes.margins(y=0.25)
    axes.legend(frameon=False, ncols=2, loc="upper left")


def little_power(figure: Figure, folder: Path) -> list[str]:
    """Windows that follow the edge at r = 0.3, one by one and in clusters."""
    patch = np.zeros((LAYERS, 60), dtype=bool)
    patch[:3, 12:30] = True
    settings = {"frames": 120, "layers": LAYERS, "sectors": 60, "lag_frames": 3, "strength": 0.3}
    signal, velocity = cd.simulate.coupled_series("ar1", SEED, windows=patch, **settings)
    lags = cd.cross_correlate(signal, velocity, max_lag=10, surrogates=999, clusters=True)
    alone = (cd.peak_correlation(lags)["q"] < 0.05).transpose("layer", "sector")
    clusters = cd.correlation_clusters(lags)
    member = clusters["member"].any("cluster").transpose("layer", "sector")
    panels = figure.subplots(2, 1, sharex=True)
    titles = ("windows with q < 0.05", "windows in a cluster")
    for axes, values, title in zip(panels, (alone, member), titles, strict=True):
        axes.pcolormesh(values, cmap="Reds", vmin=0, vmax=1.4)
        axes.plot([12, 30, 30, 12, 12], [0, 0, 3, 3, 0], color=INWARD_COLOUR, linewidth=1.0)
        axes.set(ylabel="layer", title=title, yticks=np.arange(LAYERS) + 0.5, yticklabels=range(LAYERS))
    panels[1].set_xlabel("sector; the blue frame: where the signal follows the edge")
    columns = [clusters[name].values for name in ("cluster", "size", "lag", "p")]
    found = [
        f"cluster {number}: {size} windows at lag {lag:+d} frames, p = {p:.2g}"
        for number, size, lag, p in zip(*columns, strict=True)
    ]
    share = f"{int(alone.values[patch].sum())} of {patch.sum()} windows that follow the edge have q < 0.05"
    return [share, *found]


Case = Callable[[Figure, Path], list[str]]
CASES: dict[str, Case] = {
    "jitter": jitter,
    "still_pattern": partial(_by_geometry, "still"),
    "moving_cortex": partial(_by_geometry, "cortex"),
    "common_pulse": partial(_stressed, "pulse", "common pulse", RANKS),
    "restless_episode": partial(_stressed, "restless", "restless episode", RANKS),
    "changing_variance": partial(_stressed, "rising", "variance change", RANKS),
    "oscillators": partial(_stressed, "steady", "steady oscillation", SHIFTS),
    "little_power": little_power,
    "heavy_tails": partial(_stressed, "heavy tails", "heavy tails", RANKS),
}
