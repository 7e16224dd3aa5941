"""Pages of trends: scalars over the dose, and how the windows of the disk follow it."""

from __future__ import annotations

from typing import Any

import pandas as pd

from cytodisk.pages.drawn_movie import LEFT_MM
from cytodisk.pages.population.drawn_population import DrawnPopulation
from cytodisk.pages.population.scalar_pages import LAYER, MOST_PANELS, scalar_label
from cytodisk.pages.sheet import CHARACTER_MM, Sheet
from cytodisk.plot.population.dose_trend_key import dose_trend_key
from cytodisk.plot.population.dose_trends import STEPS, draw_dose_trend
from cytodisk.plot.population.population_maps import difference_key, draw_difference
from cytodisk.plot.style import SINGLE_COLUMN_MM, colour_bar

_LEFT, _GAP, _COLUMNS, _TALL, _ABOVE, _BELOW, _LINE = 12.5, 3.0, 2, 29.0, 10.0, 9.0, 3.6  # mm
_DISK, _TITLE, _BAR_ROOM = 32.0, 5.5, 16.0  # mm, of trends on the disk
_KEY_STYLE: Any = {"handlelength": 1.4, "labelspacing": 0.35, "columnspacing": 1.2, "borderaxespad": 0.0}


def trends_page(one: DrawnPopulation) -> Sheet | None:
    """The scalars that follow the dose most closely; None where no trend was tested."""
    dose = one.study.parameters.get("dose")
    if dose is None or dose not in one.used or (rows := chosen_trends(one)).empty:
        return None
    scale: Any = one.study.parameters.get("dose_scale") or "rank"
    width = SINGLE_COLUMN_MM
    panel = (width - 2 * _GAP) / _COLUMNS - _LEFT
    key = dose_trend_key(one.used, dose)
    longest = max(len(str(handle.get_label())) for handle in key)
    abreast = max(1, int((width - 2 * LEFT_MM) / (CHARACTER_MM * longest + 7.0)))
    known = int((~one.study.scalar_trends["scalar"].str.match(LAYER)).sum())
    notes = [f"{len(rows)} of {known} scalars: smallest p"] if len(rows) < known else []
    notes += ["p corrected for all scalars (max-T)", "slope with its 95 % interval"]
    heading = one.heading(width, f"Scalars over the dose{_named(dose)}", *notes)
    first = heading.height_mm + _LINE * -(-len(key) // abreast)
    lines = -(-len(rows) // _COLUMNS)
    sheet = Sheet(first + lines * (_ABOVE + _TALL + _BELOW), width)
    heading.write(sheet)
    along_rows = [handle for column in range(abreast) for handle in key[column::abreast]]
    sheet.key(LEFT_MM, heading.height_mm - 2.0, along_rows, abreast, **_KEY_STYLE)
    for number, row in enumerate(rows.to_dict("records")):
        line, column = divmod(number, _COLUMNS)
        left = _GAP + column * (panel + _LEFT) + _LEFT - 1.0
        ax = sheet.axes(left, first + line * (_ABOVE + _TALL + _BELOW) + _ABOVE, panel - 1.0, _TALL)
        name = str(row["scalar"])
        draw_dose_trend(ax, one.used, name, dose, scale=scale, trend=row, label=scalar_label(one, name))
    return sheet


def trend_maps_page(one: DrawnPopulation) -> Sheet | None:
    """The slope of each channel by window, on the disk; None where no trend was tested."""
    dose = one.study.parameters.get("dose")
    found = {} if dose is None else {name: one.trend(name) for name in one.drawn_channels}
    maps = {name: trend for name, trend in found.items() if trend is not None}
    if not maps or one.study.is_curves:
        return None
    scale = STEPS[one.study.parameters.get("dose_scale") or "rank"]
    width, panel = SINGLE_COLUMN_MM, _DISK
    step = 0.5 * (width - 2 * LEFT_MM)
    title = f"Where the signal follows the dose{_named(str(dose))}"
    notes = [note for note in (one.sources.note, "p corrected for all windows (max-T)") if note]
    heading = one.heading(width, title, *notes)
    keys = {name: difference_key(trend) for name, trend in maps.items()}
    below = _BAR_ROOM + _LINE * max(map(len, keys.values()))
    tall = _TITLE + panel + below
    sheet = Sheet(heading.height_mm + tall * -(-len(maps) // 2), width)
    heading.write(sheet)
    unit = f"{one.unit} per {scale}" if one.unit not in ("", "1") else f"per {scale}"
    for number, (name, trend) in enumerate(maps.items()):
        line, column = divmod(number, 2)
        left, top = LEFT_MM + column * step, heading.height_mm + line * tall + _TITLE
        ax = sheet.axes(left + 0.5 * (step - panel) - 1.0, top, panel, panel)
        drawn = draw_difference(ax, trend, one.grid)
        ax.set_title(one.channel_words(name), parse_math=False)
        bar = sheet.axes(left + 3.0, top + panel + 4.5, step - 8.0, 2.2)
        colour_bar(drawn, bar, f"slope ({unit})", extend=trend.cut_off, upright=False)
        _say_trend(sheet, left, top + panel + _BAR_ROOM, keys[name])
    return sheet


def _say_trend(sheet: Sheet, left: float, top: float, handles: list[Any]) -> None:
    for handle in handles:
        handle.set_label(str(handle.get_label()).replace(" (max-T)", ""))
    if handles:
        sheet.key(left, top, handles, 1, **_KEY_STYLE)
    else:
        sheet.text(left, top + 2.4, "no window with p ≤ 0.05", color="0.3")


def _named(dose: str) -> str:
    return "" if dose == "dose" else f" ({dose})"


def chosen_trends(one: DrawnPopulation) -> pd.DataFrame:
    """Rows of the trends with a panel: those with the smallest p, then the steepest, in the table's order."""
    table = one.study.scalar_trends
    if table.empty:
        return table
    shown = [
        name in one.used and not LAYER.match(name) and bool(one.used[name].notna().any())
        for name in table["scalar"]
    ]
    rows = table[shown]
    ranked = rows.assign(p=rows["p_fwer"].fillna(1.0), flat=-rows["correlation"].abs().fillna(0.0))
    chosen = ranked.sort_values(["p", "flat"], kind="stable").index[:MOST_PANELS]
    return rows.loc[sorted(chosen)]
