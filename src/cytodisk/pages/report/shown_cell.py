"""One cell of a movie's study as the page shows it: which frames, which numbers, which colours."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.colors import to_hex

from cytodisk.analysis.top_speed import top_speed
from cytodisk.arrays import FloatArray
from cytodisk.pages.movie_cell import MovieCell
from cytodisk.pages.report.encode import pack_floats
from cytodisk.pages.report.shown_names import without_folders
from cytodisk.plot.layer_looks import CYTOPLASM_COLOURS, NUCLEUS_COLOURS, depth_words, layer_place
from cytodisk.plot.style import signal_limits
from cytodisk.plot.time_axis import FrameTimes
from cytodisk.runs.channel_names import shown_name
from cytodisk.runs.depth_layers import layer_borders
from cytodisk.scale import ShownUnit, suited_lag

MOST_ARRAY_BYTES = 5_000_000
"""Of numbers by frame and window of all cells of a page; more frames are thinned out."""

_LONGEST_NAME = 24  # letters of a channel: what a list to choose from has room for
_BY_WINDOW = ("mean", "sd")
_SHOWN = (*_BY_WINDOW, "n_pixels", "area", "depth", "velocity", "velocity_error", "status", "reason")
STRIPS = {"area": "area", "tracking_residual": "residual", "area_distortion": "distortion"}
"""Columns of quality through time, and the names of their figures."""


@dataclass(frozen=True, eq=False)
class ShownCell(MovieCell):
    """A cell's tables and maps, and the frames of it that are shown.

    Attributes
    ----------
    every : int
        Every so-manyth frame is shown.
    """

    every: int = 1

    @cached_property
    def activity(self) -> xr.Dataset:
        """Activity in all frames, as far as the page shows it."""
        whole = self.study.activity(self.cell)
        return whole[[name for name in _SHOWN if name in whole]].load()

    @cached_property
    def shown(self) -> xr.Dataset:
        """Activity in the shown frames."""
        return self.activity.isel(time=slice(None, None, self.every))

    @cached_property
    def frames(self) -> list[int]:
        """Numbers of the shown frames."""
        return [int(frame) for frame in self.shown["frame"].to_numpy()]

    @cached_property
    def times(self) -> FrameTimes:
        """Where the shown frames lie on the axes of time."""
        interval = self.scale.frame_interval_s
        return FrameTimes(self.frames[0], len(self.frames), interval, self.every)

    def thinned(self, most: int = MOST_ARRAY_BYTES) -> ShownCell:
        """The same with so many frames that the numbers by window stay below so many bytes."""
        sizes = self.activity.sizes
        arrays = len(_BY_WINDOW) * len(self.channels) + 2
        size = 4 * arrays * sizes["time"] * sizes["layer"] * sizes["sector"]
        return self.every_frames(max(self.every, int(np.ceil(size / most))))

    def every_frames(self, every: int) -> ShownCell:
        """The same with every so-manyth frame."""
        return self if every == self.every else ShownCell(self.study, self.cell, every)

    def as_json(self) -> dict[str, Any]:
        """What the page's scripts need to know, apart from pictures, labels and correlations."""
        return {
            "cell": self.cell,
            "frames": self.frames,
            "every": self.every,
            "reasons": self.reasons,
            "interval_s": self.scale.frame_interval_s,
            "time_step": self.times.per_frame,
            "time_unit": self.times.unit.name,
            "time_label": self.times.label,
            "lag_step": (self.scale.frame_interval_s or 1.0) * self._lag_unit.factor,
            "lag_unit": self._lag_unit.name,
            "layers": self.grid.layers,
            "sectors": self.grid.sectors,
            "radii": self.disk_grid.radii.tolist(),
            "units": {
                "area": self.unit("area"),
                "depth": self.depths.attrs["units"],
                "velocity": self.velocity_unit.name,
            },
            "channels": list(self._channels()),
            "quality": list(self._quality()),
            "speed_limit": self._top_speed * self.velocity_unit.factor,
            "velocity": pack_floats(self.shown["velocity"] * self.velocity_unit.factor),
            "velocity_error": pack_floats(self.shown["velocity_error"] * self.velocity_unit.factor),
            "area": pack_floats(self.shown["area"]),
            "depth": pack_floats(self.depths.isel(time=slice(None, None, self.every))),
            "layer_depths": self.layer_depths,
            "median_depths": self.median_depths,
            "profile_colours": [to_hex(colours(1.0)) for colours in (NUCLEUS_COLOURS, CYTOPLASM_COLOURS)],
            "layer_places": self.layer_places,
            "cytoplasm_layers": self.cytoplasm_layers,
        }

    @property
    def layer_places(self) -> list[str]:
        """What layers are, as " (edge)" and " (nucleus 1)"; empty for most."""
        count, outer = self.grid.layers, self.cytoplasm_layers
        if outer is None:
            return [" (edge)"] + [""] * (count - 1)
        return [layer_place(layer, count, outer) for layer in range(count)]

    @property
    def median_depths(self) -> list[float]:
        """Median depth of each layer over frames and sectors; NaN where it is not known."""
        return [float(depth) for depth in self.depths.median(("time", "sector"))]

    @property
    def layer_depths(self) -> list[str]:
        """How deep each layer lies, in words as ", 0–0.5 µm", or in the median as ", 0.4 µm deep"."""
        borders, units = layer_borders(self.grid), self.depths
        return [
            f", {border}" if border else depth_words(depth, units)
            for border, depth in zip(borders, self.median_depths, strict=True)
        ]

    @cached_property
    def reasons(self) -> list[str]:
        """Why a shown frame has no map; empty if it has one."""
        pairs = zip(self.shown["status"].to_numpy(), self.shown["reason"].to_numpy(), strict=True)
        return [
            "" if status == "ok" else without_folders(f"{status}: {reason}", self.study)
            for status, reason in pairs
        ]

    def _channels(self) -> Iterator[dict[str, Any]]:
        for number, name in enumerate(self.channels):
            values, whole = self.shown.isel(channel=number), self.whole_mean(number)
            yield {
                "name": shown_name(name, _LONGEST_NAME),
                "full": name,
                "unit": self.unit("mean"),
                "mean": pack_floats(values["mean"]),
                "sd": pack_floats(values["sd"]),
                "whole_mean": pack_floats(whole),
                **_limits(self.activity["mean"].isel(channel=number).to_numpy()),
            }
        area = {"name": "window area", "unit": self.unit("area"), "mean": None, "sd": None}
        yield area | {"whole_mean": None} | _limits(self.activity["area"].to_numpy())

    def whole_mean(self, channel: int) -> FloatArray:
        """Mean of a channel over the cell in each shown frame, windows counted by their pixels."""
        values = self.shown.isel(channel=channel)
        pixels = values["n_pixels"].where(values["mean"].notnull())
        inside = pixels.sum(("layer", "sector"))
        total = (values["mean"] * pixels).sum(("layer", "sector"))
        return np.asarray((total / inside.where(inside > 0)).to_numpy())

    @cached_property
    def _top_speed(self) -> float:
        return top_speed(self.activity["velocity"].to_numpy())

    @property
    def velocity_unit(self) -> ShownUnit:
        """The unit that suits the velocities; tables stay in µm/s."""
        return self.scale.shown_velocity(self._top_speed, self.activity.sizes["time"])

    @property
    def _lag_unit(self) -> ShownUnit:
        interval = self.scale.frame_interval_s
        return ShownUnit("frames") if interval is None else suited_lag(interval)

    def _quality(self) -> Iterator[dict[str, Any]]:
        """Strips through time, named as their figures on the page."""
        units = self.study.cells.attrs["units"]
        titles = {
            "area": f"area of the cell ({units['area']})",
            "tracking_residual": f"tracking residual ({units['tracking_residual']})",
            "area_distortion": "area distortion, mean |ln λ|",
        }
        for name, strip in STRIPS.items():
            yield {"name": strip, "title": titles[name], "values": pack_floats(self.quality[name])}

    @cached_property
    def quality(self) -> pd.DataFrame:
        """Area, tracking residual and area distortion in each shown frame; NaN where there is no map."""
        rows = self.study.cells[self.study.cells["cell"] == self.cell].set_index("frame")
        return rows.reindex(self.frames)[list(STRIPS)]


def _limits(values: FloatArray) -> dict[str, Any]:
    """Ends of the colours, for all layers together and for each; `values` are (T, L, S)."""
    layers = [signal_limits(layer) for layer in np.moveaxis(values, 1, 0)]
    return {"limits": signal_limits(values), "layer_limits": layers}
