"""The pages of a cell's correlation: what goes where on paper."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

from cytodisk.pages.drawn_correlation import DrawnCorrelation
from cytodisk.pages.drawn_movie import LEFT_MM
from cytodisk.pages.settings_words import detrending
from cytodisk.pages.sheet import Sheet, broken_lines
from cytodisk.plot.correlation.correlation_curves import draw_correlation_curves, draw_map_pair
from cytodisk.plot.correlation.correlation_peaks import PeakMap, Shown
from cytodisk.plot.correlation.curve_key import curve_key
from cytodisk.plot.correlation.event_curves import band_key, draw_event_average, draw_events
from cytodisk.plot.correlation.lag_axis import sides
from cytodisk.plot.correlation.pair_curves import draw_pairs
from cytodisk.plot.correlation.pair_table import PairTable, drawn_kinds
from cytodisk.plot.correlation.peak_maps import draw_peaks_on_cell, draw_peaks_on_disk, peak_key
from cytodisk.plot.layer_looks import shown_layers
from cytodisk.plot.movie.activity_maps import share_labels
from cytodisk.plot.style import SINGLE_COLUMN_MM, WIDE_MM, colour_bar
from cytodisk.plot.time_axis import time_stamp
from cytodisk.plot.time_raster import bar_beside, cut_off
from cytodisk.runs.channel_names import shortened
from cytodisk.runs.correlate.cluster_words import cluster_line
from cytodisk.runs.partial_words import region_left, windows_lost

_CURVE, _CURVE_GAP, _CURVE_LEFT = 17.0, 5.5, 14.0  # mm
_PANEL, _PANEL_GAP, _TALLEST = 29.5, 4.0, 1.45  # mm, mm, height over width
_MAP_LEFT, _MAP, _MAP_HEIGHT, _MAP_GAP = 13.0, 87.0, 34.0, 7.0  # mm
_AVERAGE, _AVERAGE_ABOVE = 34.0, 19.0  # mm, height of the average, and room above for labels and its key
_PAIR_LEFT, _PAIR_GAP, _PAIR, _PAIR_HEIGHT, _PAIR_STEP = 14.0, 13.0, 36.0, 26.0, 43.0  # mm
_KEY_STYLE: Any = {"borderaxespad": 0.0, "handlelength": 1.6, "columnspacing": 1.2, "labelspacing": 0.3}
_LINE = 3.6  # mm
_LONGEST_LABELS = 53  # characters of two labels beside each other in one column
_LONGEST_SIGNAL = 12  # characters of its name beside the average
_MOST_CLUSTERS = 3  # that are told below the peaks


def curves_page(one: DrawnCorrelation) -> Sheet | None:
    """Mean correlation against lag by layer; None when no window has a correlation."""
    curves = one.rows(one.correlation.layer_curves)
    if curves.empty or not curves["correlation"].notna().any():
        return None
    heading = one.heading(SINGLE_COLUMN_MM, f"{one.signal_name} with {one.with_words}")
    head = heading.height_mm
    outer = one.movie.cytoplasm_layers
    count = len(shown_layers(int(curves["layer"].nunique()), outer))
    chance = "threshold" in curves and bool(curves["threshold"].notna().any())
    lost, jittered = bool(one.lost.any()), bool(one.jittered[one.lost.index].any())
    key = curve_key(
        chance=chance,
        partial=one.partial_words,
        lost=lost,
        jittered=jittered,
        cytoplasm_layers=outer,
    )
    columns = _columns(key)
    first = head + 3.4 + _LINE * -(-len(key) // columns)
    sheet = Sheet(first + count * (_CURVE + _CURVE_GAP) + 7.5, SINGLE_COLUMN_MM)
    heading.write(sheet)
    axes = [
        sheet.axes(_CURVE_LEFT, first + k * (_CURVE + _CURVE_GAP), SINGLE_COLUMN_MM - _CURVE_LEFT - 4, _CURVE)
        for k in range(count)
    ]
    draw_correlation_curves(
        axes,
        curves,
        cell=one.cell,
        peaks=one.correlation.layers.assign(jittered=one.jittered),
        signal=one.first_names[0],
        with_=one.first_names[1],
        depths=one.movie.depths,
    )
    sheet.key(LEFT_MM, head - 2.0, key, columns, **_KEY_STYLE)
    return sheet


def _columns(key: list[Any]) -> int:
    """Two columns of a key, which are filled downwards, or one where two are wider than the page."""
    labels = [len(str(handle.get_label())) for handle in key]
    half = -(-len(labels) // 2)
    return 2 if max(labels[:half], default=0) + max(labels[half:], default=0) <= _LONGEST_LABELS else 1


def maps_page(one: DrawnCorrelation) -> Sheet:
    """The signal in the outermost layer, and below it what it was correlated with, by time and sector."""
    heading = one.heading(WIDE_MM, f"{one.signal_name} and {one.with_words}", *_map_notes(one))
    top = heading.height_mm + 3.0
    sheet = Sheet(top + 2 * _MAP_HEIGHT + _MAP_GAP + 9.0)
    heading.write(sheet)
    axes = [sheet.axes(_MAP_LEFT, top + k * (_MAP_HEIGHT + _MAP_GAP), _MAP, _MAP_HEIGHT) for k in range(2)]
    other = one.correlation.with_
    title = f"{one.with_words}: protrusion red, retraction blue"
    if not one.by_velocity:
        title = f"{one.movie.shown_name(one.movie.channels.index(other))}, layer 0 (edge)"
    draw_map_pair(
        axes,
        one.activity(one.correlation.signal),
        one.velocity if one.by_velocity else one.activity(other),
        by_velocity=one.by_velocity,
        scale=one.movie.scale,
    )
    share_labels(axes)
    axes[1].tick_params(labelleft=True)
    for ax, name in zip(axes, (f"{one.signal_name}, layer 0 (edge)", title), strict=True):
        ax.set_title(name, loc="left", y=1.0, pad=2.5, parse_math=False)
    return sheet


def peaks_page(one: DrawnCorrelation) -> Sheet | None:
    """Peak correlation and its lag, on the disk and on the cell; None when no window has one."""
    peaks, movie = one.peaks, one.movie
    if not movie.mapped or not np.isfinite(peaks.correlation).any():
        return None
    heading = one.heading(SINGLE_COLUMN_MM, f"{one.signal_name} with {one.with_words}: peaks")
    head = heading.height_mm
    time = one.drawn_time
    windows = movie.windows(time)
    high, wide = np.ptp(windows.disk.outline_yx, axis=0)
    height = _PANEL * float(np.clip(high / wide, 1.0, _TALLEST))
    key = peak_key(peaks, partial=one.partial_words)
    row = height + 9.0
    key_rows = -(-len(key) // _columns(key))
    notes = _notes_on_peaks(one)
    sheet = Sheet(head + 2 * row + 7.5 + 4.0 * key_rows + _LINE * len(notes), SINGLE_COLUMN_MM)
    heading.write(sheet)
    lefts = (LEFT_MM + 1.5, LEFT_MM + _PANEL + _PANEL_GAP)
    stamp = f"on the cell, {time_stamp(time, movie.scale)}"
    for left, words in zip(lefts, ("on the disk", stamp), strict=True):
        sheet.text(left + 0.5 * _PANEL, head, words, ha="center")
    for number, (shown, label) in enumerate(_shown(peaks)):
        top = head + 4.0 + number * row
        disk, cell = (sheet.axes(left, top, _PANEL, height) for left in lefts)
        drawn = draw_peaks_on_disk(disk, peaks, movie.disk_grid, shown)
        draw_peaks_on_cell(cell, peaks, windows, shown, scale=movie.scale)
        bar = sheet.axes(lefts[1] + _PANEL + 3.0, top + 0.1 * height, 2.2, 0.8 * height)
        colour_bar(drawn, bar, label, extend=_cut_off(peaks, shown))
    foot = head + 2 * row + 3.0
    sheet.text(LEFT_MM, foot + 2.0, "lag: " + sides(*one.first_names, upright=True))
    if key:
        sheet.key(LEFT_MM, foot + 3.5, key, _columns(key), **_KEY_STYLE)
    for number, words in enumerate(notes):
        sheet.text(LEFT_MM, foot + 6.0 + 4.0 * key_rows + _LINE * number, words, color="0.3")
    return sheet


def _notes_on_peaks(one: DrawnCorrelation) -> list[str]:
    """The largest clusters with their places, and what does not survive without the controls."""
    without = one.partial_words
    lines = []
    for row in one.rows(one.correlation.clusters).head(_MOST_CLUSTERS).itertuples():
        parts = [part for part in (cluster_line(row), region_left(row, without)) if part]
        lines += broken_lines(parts, "; ", SINGLE_COLUMN_MM - 2 * LEFT_MM)
    return [line for line in (*lines, windows_lost(one.rows(one.correlation.windows), without)) if line]


def pairs_page(one: DrawnCorrelation) -> Sheet | None:
    """Correlation of all pairs of windows by distance and lag; None when pairs were not asked for."""
    pairs = one.correlation.pairs
    kinds = [] if pairs is None else drawn_kinds(pairs, one.cell)
    if pairs is None or not kinds:
        return None
    tables = [PairTable.of(pairs, along=kind, cell=one.cell) for kind in kinds]
    heading = one.heading(WIDE_MM, f"{one.signal_name} with {one.with_name}, all pairs of windows")
    top = heading.height_mm + 5.0
    notes = broken_lines(_pair_notes(tables), " · ", WIDE_MM - 2 * LEFT_MM)
    foot = top + len(kinds) * _PAIR_STEP
    sheet = Sheet(foot + _LINE * len(notes) + 2.2)
    heading.write(sheet)
    limit = max(float(np.nanmax(np.abs(table.correlation))) for table in tables)
    rows = []
    for number, kind in enumerate(kinds):
        row_top = top + number * _PAIR_STEP
        lefts = (_PAIR_LEFT, _PAIR_LEFT + _PAIR + _PAIR_GAP)
        axes = [sheet.axes(left, row_top, _PAIR, _PAIR_HEIGHT) for left in lefts]
        _, image = draw_pairs(axes, pairs, cell=one.cell, along=kind, limit=limit)
        axes[0].tick_params(labelbottom=True)
        axes[0].set(xlabel=axes[1].get_xlabel(), ylabel="correlation")
        colour_bar(image, bar_beside(axes[1]), "correlation")
        rows.append(axes)
    _share_correlations([lines for lines, _ in rows])
    sheet.text(LEFT_MM, foot, f"lag: {sides(*one.first_names, upright=True)}")
    for number, words in enumerate(notes):
        sheet.text(LEFT_MM, foot + _LINE * (number + 1), words, color="0.3")
    return sheet


def events_page(one: DrawnCorrelation) -> Sheet | None:
    """Events of the edge, and the signal around onsets of protrusion; None when there are none."""
    events, averages = one.used_events(), one.rows(one.correlation.event_averages)
    if events.empty or averages.empty:
        return None
    what = f"events of the edge, and {one.signal_name} around onsets of protrusion"
    heading = one.heading(WIDE_MM, what, *_event_notes(one))
    head = heading.height_mm
    below = head + 3.0 + _MAP_HEIGHT + _AVERAGE_ABOVE
    sheet = Sheet(below + _AVERAGE + 9.0)
    heading.write(sheet)
    ax = sheet.axes(_MAP_LEFT, head + 3.0, _MAP, _MAP_HEIGHT)
    outlines = draw_events(ax, one.velocity, events)
    words = "events outlined, onsets bold" if len(outlines.get_segments()) else "onsets of protrusion marked"
    ax.set_title(words, loc="left", y=1.0, pad=2.5)
    _draw_average(sheet.axes(_MAP_LEFT, below, _MAP, _AVERAGE), one, averages)
    return sheet


def _draw_average(ax: Axes, one: DrawnCorrelation, averages: pd.DataFrame) -> None:
    """The signal around onsets, its key above the axes, where no line can run through it."""
    average = _average(averages, "protrusion")
    if not np.isfinite(average["mean"]).any():
        ax.set_axis_off()
        ax.text(0.5, 0.5, "no onset of protrusion is known", ha="center", color="0.3")
        return
    lines = draw_event_average(ax, average, label=shortened(one.signal_name, _LONGEST_SIGNAL))
    key: Any = {"loc": "lower left", "frameon": False, "borderaxespad": 0.2, "borderpad": 0.0}
    key |= {"handlelength": 1.8, "labelspacing": 0.25, "columnspacing": 1.2}
    above = 1.0
    if band := band_key(average):
        ax.add_artist(ax.legend(handles=band, bbox_to_anchor=(0.0, 1.0), **key))
        above += _LINE / _AVERAGE
    ax.legend(handles=lines, ncols=len(lines), bbox_to_anchor=(0.0, above), **key)
    count = ax.get_title(loc="right") + ("" if band else "; no band: too few patches")
    ax.set_title("", loc="right")
    ax.text(0.995, 0.02, count, ha="right", va="bottom", color="0.3", transform=ax.transAxes)


def _event_notes(one: DrawnCorrelation) -> list[str]:
    settings = one.correlation.settings
    notes = [] if detrending(settings) else ["averages not detrended"]
    notes += ["averages of values, not of differences"] if settings.get("difference") else []
    return notes + ["grey: not used"] * (not one.used.all())


def _average(table: pd.DataFrame, kind: str) -> xr.Dataset:
    """The Dataset of `average_around` from its table."""
    rows = table[table["kind"] == kind].drop(columns=["cell", "kind"])
    units = table.attrs.get("units", {}).get("mean", "a.u.")
    seconds = rows.drop_duplicates("delay").sort_values("delay")["delay_s"].to_numpy(dtype=np.float64)
    average = xr.Dataset.from_dataframe(rows.drop(columns="delay_s").set_index(["layer", "delay"]))
    if np.isfinite(seconds).all():
        average = average.assign_coords(delay_s=("delay", seconds))
    for name in ("mean", "lower", "upper"):
        average[name].attrs["units"] = units
    return average.assign_attrs(kind=kind, at="onset", normalise="mean", confidence=0.95)


def _shown(peaks: PeakMap) -> list[tuple[Shown, str]]:
    """The two rows of the page of peaks, with the labels of their colours."""
    return [("correlation", "peak correlation"), ("lag", f"lag of the peak ({peaks.lag_unit.unit})")]


def _cut_off(peaks: PeakMap, shown: Shown) -> str:
    values, _, limits = peaks.picture(shown, None)
    return cut_off(values, limits)


def _map_notes(one: DrawnCorrelation) -> list[str]:
    """What the maps show other than what was correlated."""
    settings = one.correlation.settings
    changed = settings.get("detrend", "none") != "none" or settings.get("difference")
    return ["values as measured"] * bool(changed) + ["grey: not used"] * (not one.used.all())


def _pair_notes(tables: list[PairTable]) -> list[str]:
    facts = ["coloured bands: quartiles of pairs"]
    if any(np.isfinite(table.threshold) for table in tables):
        facts.append("grey band: chance, 95 % at all distances and lags")
    if any((np.abs(table.correlation) >= table.threshold).any() for table in tables):
        facts.append("outlined: beyond chance")
    return [*facts, f"bins of fewer than {min(table.fewest for table in tables)} pairs left out"]


def _share_correlations(axes: list[Axes]) -> None:
    """The same correlations in all panels."""
    ends = np.array([lines.get_ylim() for lines in axes])
    for lines in axes:
        lines.set_ylim(ends[:, 0].min(), ends[:, 1].max())
