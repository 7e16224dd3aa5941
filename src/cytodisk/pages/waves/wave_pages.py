"""The pages of a cell's waves: what goes where on paper."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from cytodisk.arrays import FloatArray
from cytodisk.pages.drawn_movie import LEFT_MM
from cytodisk.pages.sheet import Sheet
from cytodisk.pages.waves.drawn_waves import DrawnWaves
from cytodisk.plot.field_of_view import Extent, field_of_view, frame_field
from cytodisk.plot.movie.activity_maps import share_labels
from cytodisk.plot.style import SINGLE_COLUMN_MM, WIDE_MM, colour_bar, scale_bar
from cytodisk.plot.time_raster import bar_beside
from cytodisk.plot.waves.depth_speeds import draw_depth_speeds
from cytodisk.plot.waves.mode_power import CHANCE_NAME, draw_mode_power
from cytodisk.plot.waves.phase_colours import phase_key
from cytodisk.plot.waves.phase_places import draw_phase_on_cell, draw_phase_on_disk
from cytodisk.plot.waves.wave_kymograph import draw_wave_kymograph, draw_wave_phase
from cytodisk.plot.waves.wave_spectrum import draw_wave_spectrum

_MAP_LEFT, _MAP, _MAP_HEIGHT, _MAP_GAP = 13.0, 85.0, 38.0, 7.5  # mm
_POWER, _SPECTRUM, _SPECTRUM_HEIGHT, _SPECTRUM_GAP = 35.0, 40.0, 36.0, 16.0  # mm
_PANEL, _PANEL_GAP, _TALLEST = 21.0, 3.5, 1.5  # mm, mm, height over width
_PHASES = 4  # frames of one period
_DEPTH_LEFT, _DEPTH, _DEPTH_HEIGHT = 16.0, 62.0, 34.0  # mm
_PERIODS_SHOWN = 4.0  # times the frequency that was found are the highest that are drawn
_LINE = 3.6  # mm
_WAYS = {"clockwise": 1, "anticlockwise": -1}


def kymograph_page(one: DrawnWaves) -> Sheet:
    """Values by time and sector with the crests of the wave; below them its phase, where there is one."""
    heading = one.heading(WIDE_MM, f"waves of {one.place_name}", *_kymograph_notes(one))
    top = heading.height_mm + 1.5
    count = 2 if one.there else 1
    sheet = Sheet(top + count * _MAP_HEIGHT + (count - 1) * _MAP_GAP + 9.0)
    heading.write(sheet)
    axes = [
        sheet.axes(_MAP_LEFT, top + k * (_MAP_HEIGHT + _MAP_GAP), _MAP, _MAP_HEIGHT) for k in range(count)
    ]
    phase = one.phase if one.there else None
    draw_wave_kymograph(axes[0], one.values, phase, by_velocity=one.by_velocity, scale=one.movie.scale)
    titles = [_kymograph_title(one)]
    if phase is not None:
        draw_wave_phase(axes[1], phase, scale=one.movie.scale)
        phase_key(bar_beside(axes[1]))
        grey = "" if np.isfinite(phase).all() else "; grey: too weak to have one"
        titles.append(f"phase of the wave{grey}")
    share_labels(axes)
    for ax, words in zip(axes, titles, strict=True):
        ax.set_title(words, loc="left", y=1.0, pad=2.5, parse_math=False)
    return sheet


def _kymograph_title(one: DrawnWaves) -> str:
    words = "protrusion red, retraction blue" if one.by_velocity else one.place_name
    return f"{words}; lines: crests" if one.there else words


def _kymograph_notes(one: DrawnWaves) -> list[str]:
    """Which way lines rise that run clockwise."""
    return ["crests that rise to the right run clockwise"] if one.row["kind"] == "rotating" else []


def spectrum_page(one: DrawnWaves) -> Sheet | None:
    """Power by mode with what chance gives, and by mode and frequency; None for values that do not change."""
    modes, spectrum = one.rows(one.waves.modes), one.rows(one.waves.spectrum)
    if modes.empty or spectrum.empty:
        return None
    heading = one.heading(WIDE_MM, f"waves of {one.place_name}: number and frequency")
    top = heading.height_mm + 1.0
    sheet = Sheet(top + _SPECTRUM_HEIGHT + 10.0)
    heading.write(sheet)
    power = sheet.axes(_MAP_LEFT, top, _POWER, _SPECTRUM_HEIGHT)
    draw_mode_power(power, modes, chosen=int(one.row["mode"]) if one.there else None)
    chance = modes["threshold"].notna().any() if "threshold" in modes else False
    power.set_title(f"grey: {CHANCE_NAME}, 95 %" if chance else "", loc="left", y=1.0, pad=2.5)
    left = _MAP_LEFT + _POWER + _SPECTRUM_GAP
    ax = sheet.axes(left, top, _SPECTRUM, _SPECTRUM_HEIGHT)
    seconds = one.movie.scale.frame_interval_s is not None
    shown = spectrum.drop(columns="frequency" if seconds else "frequency_hz")
    shown = shown.rename(columns={"frequency_hz": "frequency"})
    found = _found_in_spectrum(one, seconds)
    if found is not None:
        shown = shown[shown["frequency"] <= max(_PERIODS_SHOWN * found[1], float(shown["frequency"].min()))]
    mesh = draw_wave_spectrum(ax, shown, chosen=found, seconds=seconds)
    colour_bar(mesh, bar_beside(ax), "share of power (%)")
    ax.set_title("ring: the wave found" if found is not None else "", loc="left", y=1.0, pad=2.5)
    return sheet


def _found_in_spectrum(one: DrawnWaves, seconds: bool) -> tuple[int, float] | None:
    """Mode, with its direction, and frequency of the wave."""
    row = one.row
    period = float(row["period_s"] if seconds else row["period"])
    if not one.there or not math.isfinite(period):
        return None
    side = -1 if row["direction"] < 0 else 1
    return side * int(row["mode"]), 1.0 / period


def phase_page(one: DrawnWaves) -> Sheet | None:
    """The phase on the cell and on the disk at four times of one period; None without a wave."""
    frames = _frames_of_period(one) if one.there or one.inside else []
    if not frames:
        return None
    what = "all layers" if one.inside else "each layer its own wave"
    title = f"phase of {one.signal_name} through one period"
    heading = one.heading(WIDE_MM, title if one.by_velocity else f"{title}, {what}", inside=one.inside)
    windows = [one.movie.windows(frame) for frame in frames]
    fields = _alike_fields([each.disk.outline_yx for each in windows])
    tall = (fields[0][1] - fields[0][0]) / (fields[0][3] - fields[0][2])
    height = _PANEL * float(np.clip(tall, 0.6, _TALLEST))
    top = heading.height_mm + 1.5
    below = top + height + 7.0
    sheet = Sheet(below + _PANEL + 5.5)
    heading.write(sheet)
    phases = [one.phase_at(frame) for frame in frames]
    for place, (frame, each, phase) in enumerate(zip(frames, windows, phases, strict=True)):
        left = LEFT_MM + 4.0 + place * (_PANEL + _PANEL_GAP)
        cell = sheet.axes(left, top, _PANEL, height)
        draw_phase_on_cell(cell, each, phase, scale=one.movie.scale)
        frame_field(cell, fields[place])
        _one_scale_bar(cell, one, place)
        sheet.text(left + 0.5 * _PANEL, top - 1.2, _time(one, frame), ha="center")
        disk = sheet.axes(left, below, _PANEL, _PANEL)
        way = _WAYS.get(str(one.row["inside_way" if one.inside else "way"] or ""), 0)
        draw_phase_on_disk(disk, one.movie.disk_grid, phase, way=way, number_sectors=True)
    key = sheet.axes(LEFT_MM + 4.0 + len(frames) * (_PANEL + _PANEL_GAP), top, 2.0, below + _PANEL - top)
    phase_key(key)
    if not all(np.isfinite(phase).all() for phase in phases):
        sheet.text(LEFT_MM, sheet.height_mm - 1.2, "grey: the wave is too weak to have a phase", color="0.3")
    return sheet


def _alike_fields(outlines: Sequence[FloatArray]) -> list[Extent]:
    """Fields of view of one size, each around its own cell, as cells move on between frames."""
    own = [field_of_view([outline]) for outline in outlines]
    high, wide = (max(each[k + 1] - each[k] for each in own) for k in (0, 2))
    fields = []
    for top, bottom, left, right in own:
        y, x = 0.5 * (top + bottom), 0.5 * (left + right)
        fields.append((y - 0.5 * high, y + 0.5 * high, x - 0.5 * wide, x + 0.5 * wide))
    return fields


def _time(one: DrawnWaves, frame: int) -> str:
    """Time of a frame in the unit of the movie, as "5.5 min"."""
    scale = one.movie.scale
    if scale.frame_interval_s is None:
        return f"frame {frame}"
    return scale.shown_time(one.frames[-1]).words(scale.time(float(frame)))


def _one_scale_bar(cell: Axes, one: DrawnWaves, place: int) -> None:
    """The scale bar below the first cell alone: all are to one scale."""
    scale_bar(cell, one.movie.scale)
    if place:
        for artist in [*cell.lines, *cell.texts]:
            if artist.get_gid() == "scale bar":
                artist.remove()


def _frames_of_period(one: DrawnWaves) -> list[int]:
    """Frames with a map a quarter of a period apart, in the middle of the movie; none if too few have one."""
    mapped = np.array(sorted(set(one.movie.mapped) & set(one.frames)))
    period = float(one.row["inside_period" if one.inside else "period"])
    if mapped.size < _PHASES or not math.isfinite(period):
        return []
    middle = mapped[mapped.size // 2]
    wanted = middle + period * (np.arange(_PHASES) / _PHASES - 0.375)
    chosen = [int(mapped[np.abs(mapped - time).argmin()]) for time in wanted]
    return list(dict.fromkeys(chosen))


def depths_page(one: DrawnWaves) -> Sheet | None:
    """Speed inwards and around by depth; None where that is not known."""
    table = one.waves.depths
    depths = None if table is None else table[table["cell"] == one.movie.cell]
    if depths is None or depths[["inward_speed", "around_speed"]].isna().all(axis=None):
        return None
    heading = one.heading(SINGLE_COLUMN_MM, f"waves of {one.signal_name} by depth", inside=True)
    top = heading.height_mm + _LINE
    sheet = Sheet(top + _DEPTH_HEIGHT + 9.0, SINGLE_COLUMN_MM)
    heading.write(sheet)
    ax = sheet.axes(_DEPTH_LEFT, top, _DEPTH, _DEPTH_HEIGHT)
    speeds = depths[["inward_speed", "around_speed"]].to_numpy(dtype=np.float64)
    fastest = float(np.nanmax(np.abs(speeds)))
    unit = one.movie.scale.shown_velocity(fastest, len(one.frames))
    lines = draw_depth_speeds(ax, depths, speed=unit, length_unit=one.movie.scale.length_unit)
    key: Any = {"frameon": False, "ncols": 2, "loc": "lower left", "bbox_to_anchor": (0.0, 1.0)}
    shown = [line for line in lines if np.isfinite(np.asarray(line.get_ydata(), dtype=np.float64)).any()]
    ax.legend(handles=shown, borderaxespad=0.1, borderpad=0.0, handlelength=2.4, **key)
    return sheet
