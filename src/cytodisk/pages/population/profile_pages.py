"""Page of the signal by depth: experiments as lines, by condition."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from cytodisk.pages.drawn_movie import LEFT_MM
from cytodisk.pages.population.drawn_population import DrawnPopulation
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.population.condition_profiles import condition_key, draw_condition_profiles
from cytodisk.plot.style import SINGLE_COLUMN_MM
from cytodisk.runs.channel_names import shortened

_LEFT, _RIGHT, _TALL, _ABOVE, _BELOW, _LINE = 15.5, 6.0, 42.0, 5.5, 13.5, 3.8  # mm
_LONGEST_NAME = 18  # of a condition in the key, whose columns are half a page wide
_KEY_STYLE: Any = {"handlelength": 1.6, "labelspacing": 0.35, "columnspacing": 1.2}


def profiles_page(one: DrawnPopulation) -> Sheet | None:
    """Mean of each layer by condition; None where there is one layer, or no value."""
    table = one.study.profiles
    known = set(table.loc[table["mean"].notna(), "channel"])
    channels = [name for name in one.drawn_channels if name in known]
    if not channels or table["layer"].nunique() < 2:
        return None
    left_out = len(one.channels) - len(channels)
    notes = [f"{len(channels)} of {len(one.channels)} channels"] if left_out else []
    heading = one.heading(SINGLE_COLUMN_MM, "Signal by depth", *notes)
    count = len(one.conditions)
    key_rows = -(-(count + 2 * one.repeated) // 2)
    first = heading.height_mm + _LINE * key_rows + 1.0
    sheet = Sheet(first + len(channels) * (_ABOVE + _TALL + _BELOW), SINGLE_COLUMN_MM)
    heading.write(sheet)
    for number, channel in enumerate(channels):
        top = first + number * (_ABOVE + _TALL + _BELOW) + _ABOVE
        ax = sheet.axes(_LEFT, top, SINGLE_COLUMN_MM - _LEFT - _RIGHT, _TALL)
        own = table[(table["channel"] == channel) & table["condition"].isin(one.conditions)]
        order = {name: place for place, name in enumerate(one.conditions)}
        own = own.sort_values("condition", key=lambda names: names.map(order), kind="stable")
        shown = own.assign(value=own["mean"], experiment=own["experiment"].fillna("").astype(str))
        lines = draw_condition_profiles(
            ax, shown, depths=_depths(one, channel), label=one.value_label(channel)
        )
    key = condition_key(lines, experiments=one.repeated)
    for handle in key[:count]:
        handle.set_label(shortened(str(handle.get_label()), _LONGEST_NAME))
    sheet.key(LEFT_MM, heading.height_mm - 2.0, key, 2, borderaxespad=0.0, **_KEY_STYLE)
    return sheet


def _depths(one: DrawnPopulation, channel: str) -> xr.DataArray | None:
    table = one.study.profiles
    rows = table[table["channel"] == channel].drop_duplicates("layer").sort_values("layer")
    coords = {"compartment": ("layer", rows["compartment"].to_numpy(dtype=object))}
    inside = (rows["compartment"] == "nucleus").any()
    if not np.isfinite(rows["depth"].to_numpy(dtype=np.float64)).any() and not inside:
        return None
    units = table.attrs.get("units", {}).get("depth", "px")
    depths = rows["depth"].to_numpy(dtype=np.float64)
    return xr.DataArray(depths, coords if inside else {}, ("layer",), attrs={"units": units})
