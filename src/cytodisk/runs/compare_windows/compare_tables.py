"""Tables of a comparison of windows: their columns, and what goes into them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyarrow as pa
import xarray as xr

from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import CytodiskError, MaskError, ReadError
from cytodisk.runs.compare_windows.compare_columns import BY_LAYER as BY_LAYER_CSV
from cytodisk.runs.compare_windows.compare_columns import BY_METHOD as BY_METHOD_CSV
from cytodisk.runs.compare_windows.compare_columns import COLUMNS_FILE as COLUMNS_CSV
from cytodisk.runs.compare_windows.compare_columns import THROUGH_TIME as THROUGH_TIME_CSV
from cytodisk.runs.compare_windows.compare_parameters import TITLES
from cytodisk.store.study_folder import part_patterns
from cytodisk.store.study_kind import StudyKind
from cytodisk.store.tables import (
    CELL,
    CONSISTENCY_COLUMNS,
    FRAME,
    LABEL,
    LAYER,
    NOTES,
    QC_FLAGS,
    REASON,
    SECONDS,
    SOURCE,
    Column,
    Columns,
)
from cytodisk.windows.edge_windows import EdgeWindows
from cytodisk.windows.on_cell import WindowsOnCell

_METHOD = Column(
    "method",
    pa.string(),
    "",
    "how windows are made: newton (the default map), newton-triangles, harmonic, advection (of the paper), "
    "edge, springs, registered (movies) or rings; with nuclei newton, nucleus-rings or interpolated-rings",
)
# One row for each cell and method; counts are sums over the frames of a movie.
_CELLS: Columns = (
    CELL,
    SOURCE,
    FRAME,
    LABEL,
    _METHOD,
    Column("status", pa.string(), "", "ok; refused or unreadable (the mask); no map (the method gave none)"),
    REASON,
    NOTES,
    QC_FLAGS,
    Column("frames", pa.int64(), "", "number of frames; 1 for a cell that is not followed"),
    Column("mapped", pa.int64(), "", "number of those frames that have windows"),
    Column("area_px", pa.float64(), "px²", "area without excluded holes, in a movie over all frames"),
    Column("certificate_valid", pa.bool_(), "", "whether the map is proven to be one to one"),
    Column(
        "invalid_maps",
        pa.int64(),
        "",
        "number of maps, or cells with interpolated rings, that are not one to one",
    ),
    Column("flipped", pa.int64(), "", "number of triangles that the map, or interpolated rings, turn over"),
    Column("area_distortion", pa.float64(), "1", "mean of |ln λ| over the cell, as in the cells of a map"),
    Column("angle_distortion", pa.float64(), "1", "median of the largest over the smallest stretch"),
    Column("coverage", pa.float64(), "1", "share of the cell's area that lies in windows"),
    Column("lost_px", pa.float64(), "px²", "area of the cell that lies in no window"),
    Column("empty_windows", pa.int64(), "", "number of windows that hold no part of the cell"),
    Column("depth_px", pa.float64(), "px", "depth of an edge-based layer; empty for other methods"),
    SECONDS,
)

# Beside these in a comparison of movies; those of earlier versions have none.
REGISTERED: Columns = (
    Column("folded", pa.float64(), "1", "registered: share of the cell where the field folds, median over "
           "frames"),
    Column("carried_outside", pa.float64(), "1", "registered: share of the windows' area that the field "
           "carries out of the cell, median over frames"),
)  # fmt: skip

# Beside these in a comparison with nuclei.
_NUCLEUS: Columns = (
    Column("nucleus_area", pa.float64(), "px²", "area of the nucleus"),
    Column("outside", pa.float64(), "1", "share of points of interpolated rings that lie outside the cell"),
    Column("overlap", pa.float64(), "1", "share of the cell's area in several interpolated windows"),
    Column("area_error_cytoplasm", pa.float64(), "1", "mean |ln| of the areas of windows of the cytoplasm "
           "over their mean; empty windows count in the mean alone"),
    Column("area_error_nucleus", pa.float64(), "1", "the same of the nucleus"),
    Column("outer_fifth", pa.float64(), "1", "share of the cytoplasm in the outermost of five layers; a "
           "fifth where all layers are equal"),
    Column("nearness", pa.float64(), "1", "rank correlation of layers of the cytoplasm with the nearness of "
           "their pixels to the nucleus, by the way through the cell"),
)  # fmt: skip

_BY_LAYER: Columns = (
    Column("completeness", pa.float64(), "1", "share of the layer's windows that hold a part of the cell"),
    Column("area", pa.float64(), "px²", "mean area of the layer's windows"),
    Column("area_cv", pa.float64(), "1", "coefficient of variation of their area"),
    Column("eccentricity", pa.float64(), "1", "mean eccentricity of the layer's windows: 0 round, 1 a line"),
    Column("eccentricity_cv", pa.float64(), "1", "coefficient of variation of their eccentricity"),
    Column("pieces", pa.float64(), "1", "mean number of separate pieces of a window"),
    Column("one_piece", pa.float64(), "1", "share of the windows that are in one piece"),
    Column("layer_pieces", pa.float64(), "1", "number of separate pieces of the layer as a whole"),
)
BY_LAYER = tuple(column.name for column in _BY_LAYER)

_LAYERS: Columns = (CELL, FRAME, _METHOD, LAYER, *_BY_LAYER)
_NUCLEUS_LAYERS: Columns = (
    *_LAYERS,
    Column("compartment", pa.string(), "", "cytoplasm or nucleus"),
    Column("relative_area", pa.float64(), "1", "mean area of the layer's windows over that of all windows of "
           "the compartment; 1 where all are equal"),
)  # fmt: skip
_CONSISTENCY: Columns = (CELL, _METHOD, *CONSISTENCY_COLUMNS[1:])

_READER = "look at comparison.csv and the figures, or read it with open_comparison"
_SUMMARIES = (BY_LAYER_CSV, BY_METHOD_CSV, COLUMNS_CSV)
_ACTIVITIES = tuple(
    pattern for method in TITLES for pattern in part_patterns(f"maps/activity_{{}}_{method}.npz")
)
COMPARED_CELLS = StudyKind(
    "comparison",
    "cytodisk compare-windows",
    _READER,
    _CELLS,
    {"layers": _LAYERS},
    (*_SUMMARIES, *part_patterns("maps/windows_{}.npz")),
)
COMPARED_NUCLEI = StudyKind(
    "comparison with nuclei",
    "cytodisk compare-windows --nuclei",
    _READER,
    (*_CELLS, *_NUCLEUS),
    {"layers": _NUCLEUS_LAYERS},
    (*_SUMMARIES, *part_patterns("maps/windows_{}.npz")),
)
COMPARED_MOVIE = StudyKind(
    "movie comparison",
    "cytodisk compare-windows --movie",
    _READER,
    (*_CELLS, *REGISTERED),
    {"layers": _LAYERS, "consistency": _CONSISTENCY},
    (*_SUMMARIES, THROUGH_TIME_CSV, *_ACTIVITIES),
)


def method_status(fault: CytodiskError) -> str:
    """Status of a cell that a method gave no windows: "refused" if the mask is at fault, or else "no map"."""
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
    area = float(windows.mask_without_holes.sum())
    row: dict[str, Any] = {
        "area_px": area,
        "coverage": windows.areas.sum() / area,
        "lost_px": area * (1.0 - windows.areas.sum() / area),
        "empty_windows": windows.n_empty,
        "depth_px": windows.depth_px if isinstance(windows, EdgeWindows) else None,
    }
    if disk is None:
        return row
    outside = int(np.isnan(disk.to_disk(disk.placed_mask.pixels_yx)[:, 0]).sum())
    return row | {
        "lost_px": row["lost_px"] + outside,
        "certificate_valid": disk.certificate.valid,
        "invalid_maps": int(not disk.certificate.valid),
        "flipped": len(disk.certificate.flipped_in_disk),
        "area_distortion": disk.distortion.area,
        "angle_distortion": disk.distortion.angle,
    }


def layer_columns(cell: int, frame: int, method: str, measures: xr.Dataset) -> dict[str, Any]:
    """Rows of the table of layers: what `measures_by_layer` found, for one cell, frame and method."""
    count = measures.sizes["layer"]
    return {
        "cell": np.full(count, cell),
        "frame": np.full(count, frame),
        "method": [method] * count,
        "layer": np.arange(count),
        **{name: measures[name].to_numpy().astype(np.float64) for name in BY_LAYER},
    }
