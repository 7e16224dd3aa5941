"""Studies whose activity is given as arrays, for what works on series alone."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.scale import Scale
from cytodisk.store.study import Study


@dataclass(frozen=True, repr=False)
class SeriesStudy(Study):
    """A study of a movie whose cells are Datasets."""

    given: Mapping[int, xr.Dataset]

    def activity(self, cell: int = 0) -> xr.Dataset:
        return self.given[cell]


def series_study(
    folder: Path, cells: list[xr.DataArray], *, scale: Scale | None = None, edge_length: float = 40.0
) -> SeriesStudy:
    """A study of cells with series by (time, sector), of velocity, or by (time, layer, sector), of "Rac1"."""
    scale = Scale(0.2, 5.0) if scale is None else scale
    given = {cell: _activity(values, scale, edge_length) for cell, values in enumerate(cells)}
    rows = [
        {"cell": cell, "frame": int(frame), "status": "ok", "restarted": "", "reason": ""}
        for cell, one in given.items()
        for frame in one["frame"].to_numpy()
    ]
    sizes = next(iter(given.values())).sizes
    provenance: dict[str, Any] = {
        "run": "movie",
        "length_unit": scale.length_unit,
        "velocity_unit": scale.velocity_unit,
        "parameters": {"layers": sizes["layer"], "sectors": sizes["sector"]},
        **scale.attrs,
    }
    return SeriesStudy(folder, pd.DataFrame(rows), provenance, given)


def _activity(values: xr.DataArray, scale: Scale, edge_length: float) -> xr.Dataset:
    frames, sectors = values.sizes["time"], values.sizes["sector"]
    layers = values.sizes.get("layer", 2)
    edge = np.full((frames, sectors), edge_length / sectors)
    edge[-1] = np.nan
    turn = 2 * np.pi * np.arange(sectors) / sectors
    radii = (20.0 - 5.0 * np.arange(layers))[:, None]
    place = radii * np.stack([np.sin(turn), np.cos(turn)])[:, None]
    depth = np.broadcast_to((0.5 + np.arange(layers))[:, None], (frames, layers, sectors))
    window = ("time", "layer", "sector")
    data: dict[str, Any] = {"edge_length": (("time", "sector"), edge), "depth": (window, depth)}
    if "layer" in values.dims:
        data["mean"] = (("time", "channel", "layer", "sector"), values.to_numpy()[:, None])
        moving = np.random.default_rng(0).normal(size=(frames, sectors))
    else:
        moving = values.to_numpy().astype(np.float64)
        moving[-1] = np.nan
        data["mean"] = (("time", "channel", "layer", "sector"), np.zeros((frames, 1, layers, sectors)))
    data |= dict.fromkeys(("velocity", "velocity_cell_frame"), (("time", "sector"), moving))
    coords: dict[str, Any] = {"channel": ["Rac1"], "layer": np.arange(layers), "sector": np.arange(sectors)}
    coords |= scale.time_coords(np.arange(frames))
    coords |= {
        f"centroid_{axis}": (window, np.broadcast_to(one, (frames, layers, sectors)))
        for axis, one in zip("yx", place, strict=True)
    }
    return xr.Dataset(data, coords, scale.attrs).set_xindex("frame")
