"""Tables of a comparison of windows: their columns, and what goes into them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyarrow as pa
import xarray as xr

from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import CytodiskError, MaskError, ReadError
from cytodisk.store.study_folder import Tables
from cytodisk.store.tables import CONSISTENCY_COLUMNS, Columns
from cytodisk.windows.edge_windows import EdgeWindows
from cytodisk.windows.on_cell import WindowsOnCell

# A row a cell and method; in a movie "frames" are many, and what is counted is summed over them.
_CELLS: Columns = (
    ("cell", pa.int64(), ""),
    ("source", pa.string(), ""),
    ("frame", pa.int64(), "frame"),
    ("label", pa.int64(), ""),
    ("method", pa.string(), ""),
    ("status", pa.string(), ""),
    ("reason", pa.string(), ""),
    ("notes", pa.string(), ""),
    ("qc_flags", pa.string(), ""),
    ("frames", pa.int64(), ""),
    ("mapped", pa.int64(), ""),
    ("area_px", pa.float64(), "px²"),
    ("certificate_valid", pa.bool_(), ""),
    ("invalid_maps", pa.int64(), ""),
    ("flipped", pa.int64(), ""),
    ("area_distortion", pa.float64(), "1"),
    ("angle_distortion", pa.float64(), "1"),
    ("coverage", pa.float64(), "1"),
    ("lost_px", pa.float64(), "px²"),
    ("empty_windows", pa.int64(), ""),
    ("depth_px", pa.float64(), "px"),
    ("seconds", pa.float64(), "s"),
)

BY_LAYER = (
    "completeness",
    "area",
    "area_cv",
    "eccentricity",
    "eccentricity_cv",
    "pieces",
    "one_piece",
    "layer_pieces",
)

_LAYERS: Columns = (
    ("cell", pa.int64(), ""),
    ("frame", pa.int64(), "frame"),
    ("method", pa.string(), ""),
    ("layer", pa.int64(), ""),
    *((name, pa.float64(), "px²" if name == "area" else "1") for name in BY_LAYER),
)

_CONSISTENCY: Columns = (CONSISTENCY_COLUMNS[0], ("method", pa.string(), ""), *CONSISTENCY_COLUMNS[1:])

COMPARED_CELLS = Tables(_CELLS, {"layers": _LAYERS})
COMPARED_MOVIE = Tables(_CELLS, {"layers": _LAYERS, "consistency": _CONSISTENCY})


def status_of(fault: CytodiskError) -> str:
    """Status of a cell without windows: "refused" if its mask is at fault, "no map" if the method is."""
    if isinstance(fault, ReadError):
        return "unreadable"
    return "refused" if isinstance(fault, MaskError) else "no map"


def windows_row(windows: WindowsOnCell, disk: DiskMap | None) -> dict[str, Any]:
    """What the table of cells says of the windows of one method.

    Parameters
    ----------
    windows : WindowsOnCell
    disk : DiskMap or None
        The map that polar windows are on.

    Returns
    -------
    dict
        lost_px is the area of the cell in no window, and on a map that of pixels whose centre is outside.
    """
    area = float(windows.mask.sum())
    row: dict[str, Any] = {
        "area_px": area,
        "coverage": windows.coverage,
        "lost_px": area * (1.0 - windows.coverage),
        "empty_windows": windows.n_empty,
        "depth_px": windows.depth_px if isinstance(windows, EdgeWindows) else None,
    }
    if disk is None:
        return row
    outside = int(np.isnan(disk.to_disk(np.argwhere(disk.mask))[:, 0]).sum())
    return row | {
        "lost_px": row["lost_px"] + outside,
        "certificate_valid": disk.certificate.valid,
        "invalid_maps": int(not disk.certificate.valid),
        "flipped": len(disk.certificate.flipped_in_disk),
        "area_distortion": disk.distortion.area,
        "angle_distortion": disk.distortion.angle,
    }


def layer_columns(cell: int, time: int, method: str, measures: xr.Dataset) -> dict[str, Any]:
    """Rows of the table of layers: what `measures_by_layer` found, for one cell, frame and method."""
    count = measures.sizes["layer"]
    return {
        "cell": np.full(count, cell),
        "frame": np.full(count, time),
        "method": [method] * count,
        "layer": np.arange(count),
        **{name: measures[name].to_numpy().astype(np.float64) for name in BY_LAYER},
    }
