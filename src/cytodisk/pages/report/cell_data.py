"""One cell of a movie's study as the page shows it: which frames, which numbers, which colours."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.arrays import FloatArray
from cytodisk.motion.disk_movie import DiskMovie
from cytodisk.pages.report.encode import pack_floats
from cytodisk.pages.report.shown_names import shown_name, without_folders
from cytodisk.plot.style import signal_limits
from cytodisk.plot.time_axis import time_scale
from cytodisk.store.study import Study
from cytodisk.windows.grid import PolarGrid, polar_windows

MOST_ARRAY_BYTES = 5_000_000
"""Of numbers by frame and window; more frames are thinned out."""

_BY_WINDOW = ("mean", "sd")
_SHOWN = (*_BY_WINDOW, "n_pixels", "area", "velocity", "velocity_error", "status", "reason")
_QUALITY = ("area", "tracking_residual", "area_distortion")
_LARGE, _USUAL = 99.0, 75.0  # percentiles of speed that the colours of velocity go by
_FAULTY = 3.0  # times the usual speed, beyond which it is a fault of the mask


@dataclass(frozen=True, eq=False)
class CellData:
    """A cell's tables and maps, and the frames of it that are shown.

    Attributes
    ----------
    study : Study
    cell : int
    every : int
        Every so-manyth frame is shown.
    """

    study: Study
    cell: int
    every: int = 1

    @cached_property
    def whole(self) -> xr.Dataset:
        """Activity in all frames, as far as the page shows it."""
        activity = self.study.activity(self.cell)
        return activity[[name for name in _SHOWN if name in activity]].load()

    @cached_property
    def activity(self) -> xr.Dataset:
        """Activity in the shown frames."""
        return self.whole.isel(time=slice(None, None, self.every))

    @cached_property
    def maps(self) -> DiskMovie:
        """Maps by number of the frame."""
        return self.study.movie(self.cell)

    @cached_property
    def frames(self) -> list[int]:
        """Numbers of the shown frames."""
        return [int(time) for time in self.activity["frame"].to_numpy()]

    @cached_property
    def channels(self) -> list[str]:
        """Names of the signal's channels; empty without a signal."""
        return [str(name) for name in self.whole["channel"].to_numpy()] if "mean" in self.whole else []

    @cached_property
    def grid(self) -> PolarGrid:
        """The windows on the disk."""
        sizes = self.whole.sizes
        spacing = self.study.provenance["parameters"]["spacing"]
        return polar_windows(sizes["layer"], sizes["sector"], spacing)

    @property
    def pixel_size_um(self) -> float | None:
        """Micrometres a pixel; None when unknown."""
        size: float | None = self.study.provenance["pixel_size_um"]
        return size

    @property
    def interval_s(self) -> float | None:
        """Seconds between frames; None when unknown."""
        interval: float | None = self.study.provenance["frame_interval_s"]
        return interval

    @cached_property
    def time_step(self) -> tuple[float, str]:
        """Length of a frame on the time axes, and their label."""
        return time_scale(max(self.frames) + 1, self.interval_s)

    def unit(self, name: str) -> str:
        """Unit of a variable of the activity."""
        return str(self.whole[name].attrs.get("units", ""))

    def thinned(self) -> CellData:
        """The same with so many frames that the numbers by window stay below `MOST_ARRAY_BYTES`."""
        sizes = self.whole.sizes
        arrays = len(_BY_WINDOW) * len(self.channels) + 1
        size = 4 * arrays * sizes["time"] * sizes["layer"] * sizes["sector"]
        return self.every_frames(max(self.every, int(np.ceil(size / MOST_ARRAY_BYTES))))

    def every_frames(self, every: int) -> CellData:
        """The same with every so-manyth frame."""
        return self if every == self.every else CellData(self.study, self.cell, every)

    def as_json(self) -> dict[str, Any]:
        """What the page's scripts need to know, apart from pictures, labels and correlations."""
        step, label = self.time_step
        return {
            "cell": self.cell,
            "frames": self.frames,
            "every": self.every,
            "reasons": self._reasons(),
            "interval_s": self.interval_s,
            "time": {"step": step, "label": label},
            "layers": self.grid.layers,
            "sectors": self.grid.sectors,
            "radii": self.grid.radii.tolist(),
            "units": {name: self.unit(name) for name in ("area", "velocity")},
            "channels": list(self._channels()),
            "velocity": pack_floats(self.activity["velocity"]),
            "velocity_error": pack_floats(self.activity["velocity_error"]),
            "velocity_limit": velocity_limit(self.whole["velocity"].to_numpy()),
            "area": pack_floats(self.activity["area"]),
            "quality": self._quality(),
        }

    def _reasons(self) -> list[str]:
        """Why a shown frame has no map; empty if it has one."""
        pairs = zip(self.activity["status"].to_numpy(), self.activity["reason"].to_numpy(), strict=True)
        return [
            "" if status == "ok" else without_folders(f"{status}: {reason}", self.study)
            for status, reason in pairs
        ]

    def _channels(self) -> Iterator[dict[str, Any]]:
        for number, name in enumerate(self.channels):
            values = self.activity.isel(channel=number)
            yield {
                "name": shown_name(name),
                "unit": self.unit("mean"),
                "mean": pack_floats(values["mean"]),
                "sd": pack_floats(values["sd"]),
                "whole_mean": pack_floats(_whole_mean(values)),
                **_limits(self.whole["mean"].isel(channel=number).to_numpy()),
            }
        area = {"name": "window area", "unit": self.unit("area"), "mean": None, "sd": None}
        yield area | {"whole_mean": None} | _limits(self.whole["area"].to_numpy())

    def _quality(self) -> dict[str, Any]:
        rows = self.study.cells[self.study.cells["cell"] == self.cell].set_index("frame")
        rows = rows.reindex(self.frames)
        return {name: pack_floats(rows[name]) for name in _QUALITY}


def velocity_limit(velocity: FloatArray) -> float:
    """Speed at the ends of the colours.

    Parameters
    ----------
    velocity : ndarray of shape (T, S)

    Returns
    -------
    float
        Percentile 99 of the speeds, at most three times percentile 75; 1 if nothing moves.
    """
    speed = np.abs(velocity[np.isfinite(velocity)])
    if not speed.size or speed.max() == 0:
        return 1.0
    large, usual = np.percentile(speed, [_LARGE, _USUAL]).tolist()
    return float(min(large, _FAULTY * usual) or large or speed.max())


def _limits(values: FloatArray) -> dict[str, Any]:
    """Ends of the colours, for all layers together and for each; `values` are (T, L, S)."""
    layers = [signal_limits(layer, np.isfinite(layer)) for layer in np.moveaxis(values, 1, 0)]
    return {"limits": signal_limits(values, np.isfinite(values)), "layer_limits": layers}


def _whole_mean(values: xr.Dataset) -> FloatArray:
    """Mean over the cell by frame, windows counted by their pixels."""
    pixels = values["n_pixels"].where(values["mean"].notnull())
    inside = pixels.sum(("layer", "sector"))
    total = (values["mean"] * pixels).sum(("layer", "sector"))
    return np.asarray((total / inside.where(inside > 0)).to_numpy())
