"""The tables of a study: their columns, types and units."""

from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq


class Column(NamedTuple):
    """A column of a table.

    Attributes
    ----------
    name : str
    kind : pyarrow.DataType
    unit : str
        "length²", "length" and "velocity" become the units that the run has.
    meaning : str
        What a user reads about it, without a full stop.
    """

    name: str
    kind: pa.DataType
    unit: str
    meaning: str


Columns: TypeAlias = tuple[Column, ...]

CELL = Column("cell", pa.int64(), "", "number of the cell in this run, from 0")
SOURCE = Column("source", pa.string(), "", "name of the mask file that the cell comes from")
FRAME = Column("frame", pa.int64(), "frame", "number of the frame, from 0")
TIME_S = Column("time_s", pa.float64(), "s", "time of the frame; empty if the frame interval is unknown")
LABEL = Column("label", pa.int64(), "", "value of the cell in its label image; 0 for a file without a cell")
CHANNEL = Column("channel", pa.string(), "", "name of the channel of the signal")
LAYER = Column("layer", pa.int64(), "", "layer of the window: 0 is at the cell's edge, numbers grow inwards")
SECTOR = Column(
    "sector", pa.int64(), "", "sector of the window: 0 points along +x of the image, numbers grow towards +y"
)
STATUS = Column(
    "status",
    pa.string(),
    "",
    "ok if there is a map; else refused, unreadable, no cell, no image, or missing (not in this frame)",
)
REASON = Column("reason", pa.string(), "", "why there is no map; empty if there is one")
NOTES = Column("notes", pa.string(), "", "each change that cleaning made to the mask")
QC_FLAGS = Column(
    "qc_flags",
    pa.string(),
    "",
    "what speaks against the mask being one whole cell, such as a large fragment that was dropped",
)
ALL_QC_FLAGS = QC_FLAGS._replace(
    meaning="names of the QC flags of this row and of the cell as a whole, with ; between, as area jumps; "
    "then mask_remarks"
)
MASK_REMARKS = QC_FLAGS._replace(name="mask_remarks")
TOUCHES_BORDER = Column("touches_border", pa.bool_(), "", "whether the cell touches the border of the image")
SECONDS = Column("seconds", pa.float64(), "s", "computing time of this row; it differs from run to run")
CENTROID_Y, CENTROID_X = (
    Column(f"centroid_{axis}", pa.float64(), "px", f"{axis} of the centroid in the image") for axis in "yx"
)

CELL_COLUMNS: Columns = (
    CELL,
    FRAME,
    TIME_S,
    LABEL,
    STATUS,
    REASON,
    NOTES,
    ALL_QC_FLAGS,
    MASK_REMARKS,
    Column("area", pa.float64(), "length²", "area of the cell, without excluded holes"),
    Column("perimeter", pa.float64(), "length", "length of the cell's outline"),
    CENTROID_Y,
    CENTROID_X,
    Column("area_px", pa.int64(), "px²", "area of the cleaned mask in pixels, without excluded holes"),
    Column("components", pa.int64(), "", "number of separate pieces in the mask as it came"),
    Column("dropped_px", pa.int64(), "px²", "area of the pieces that cleaning dropped"),
    Column("holes", pa.int64(), "", "number of holes in the mask as it came"),
    Column("filled_px", pa.int64(), "px²", "area of the holes that count as cell"),
    Column("excluded_px", pa.int64(), "px²", "area of the holes that belong to no window (--holes exclude)"),
    TOUCHES_BORDER,
    Column("border_share", pa.float64(), "1", "share of the outline that lies on the border of the image"),
    Column(
        "outline_step_px",
        pa.int64(),
        "px",
        "length of the steps in the outline: 1, or more for a mask that was drawn small and scaled up",
    ),
    Column(
        "nan_px", pa.int64(), "px²", "pixels of the mask that were not a number; they count as background"
    ),
    Column(
        "clipped_share",
        pa.float64(),
        "1",
        "share of the cell's pixels that are cut off at the smallest value, in the worst channel; "
        "0 if the zeros are no more than a dim image has and less than three quarters",
    ),
    Column("clipped_channel", pa.string(), "", "that channel; empty if the share is 0"),
    Column(
        "clipped_note", pa.string(), "", "that a dim image would look the same; empty if the share is sure"
    ),
    Column(
        "saturated_share",
        pa.float64(),
        "1",
        "share of the cell's pixels that are cut off at the largest value, in the channel with most of them",
    ),
    Column("saturated_channel", pa.string(), "", "that channel; empty if the share is 0"),
    Column("certificate_valid", pa.bool_(), "", "whether the map is proven to be one to one"),
    Column("flipped", pa.int64(), "", "number of triangles that the map turns over; 0 in a valid map"),
    Column("vertices", pa.int64(), "", "number of vertices of the mesh"),
    Column("triangles", pa.int64(), "", "number of triangles of the mesh"),
    Column(
        "area_distortion",
        pa.float64(),
        "1",
        "mean of |ln λ| over the cell, where λ is a triangle's share of the disk over its share of the cell; "
        "triangles may differ where windows do not: see window_area_error",
    ),
    Column("area_ratio_p1", pa.float64(), "1", "1st percentile of λ (see area_distortion)"),
    Column("area_ratio_p99", pa.float64(), "1", "99th percentile of λ (see area_distortion)"),
    Column(
        "angle_distortion",
        pa.float64(),
        "1",
        "median over triangles of the largest over the smallest stretch; 1 keeps angles",
    ),
    Column("angle_distortion_p95", pa.float64(), "1", "95th percentile of the same ratio"),
    Column("empty_windows", pa.int64(), "", "number of windows that hold no part of the cell"),
    Column("relaxation_start", pa.string(), "", "map that the relaxation started from"),
    Column("steps", pa.int64(), "", "number of steps of the relaxation"),
    Column("converged", pa.bool_(), "", "whether the relaxation reached its end"),
    SECONDS,
)

SOURCE_COLUMNS: Columns = (CELL, SOURCE, *CELL_COLUMNS[1:])
"""Columns of a map's cells, which may come from many files."""

TRACK_COLUMNS: Columns = (
    Column("restarted", pa.string(), "", "why tracking started anew in this frame; empty if it went on"),
    Column(
        "interior_restarted",
        pa.string(),
        "",
        "with interior still: why places inside did not go on from the last map; empty if they did",
    ),
    Column(
        "smallest_window_share",
        pa.float64(),
        "1",
        "with interior still: area of the smallest window over the area that it has in a map of equal areas",
    ),
    Column(
        "tracking_residual",
        pa.float64(),
        "length",
        "mean distance between where boundary points start and where they end, if they are tracked to the "
        "next frame and back",
    ),
    Column(
        "order_violations",
        pa.int64(),
        "",
        "number of boundary points that the tracker put out of order; 0 with the tracker matching",
    ),
    Column(
        "registration_angle", pa.float64(), "°", "turn about pixel (0, 0) that takes the frame to the first"
    ),
    Column("registration_shift_y", pa.float64(), "px", "shift along y after that turn"),
    Column("registration_shift_x", pa.float64(), "px", "shift along x after that turn"),
    Column(
        "swept_area",
        pa.float64(),
        "length²",
        "sum of the areas, without signs, that short pieces of the edge sweep from the frame before to this "
        "one; near the area won and lost where the two outlines match",
    ),
)
"""What a movie's cells have in addition: how the frame was tracked and registered."""

EDGE_COLUMNS: Columns = (
    CELL,
    FRAME,
    TIME_S,
    SECTOR,
    Column(
        "velocity",
        pa.float64(),
        "velocity",
        "outward velocity of the edge over the substrate from this frame to the next, protrusion positive: "
        "the area that the edge sweeps over edge_length; the last frame has none, nor has an edge that the "
        "image's border cuts off",
    ),
    Column(
        "velocity_cell_frame",
        pa.float64(),
        "velocity",
        "the same after the cell's rigid motion is removed: change of shape alone",
    ),
    Column(
        "velocity_fastest",
        pa.float64(),
        "velocity",
        "velocity of the fastest half pixel of edge in this sector, out or in: a thin protrusion shows here "
        "also where the sector is longer; as the extreme of many values it is never near 0",
    ),
    Column(
        "velocity_error",
        pa.float64(),
        "velocity",
        "standard deviation of velocity, from how the velocities of the movie jitter from frame to frame, "
        "with that of a mask right to the pixel on top; in a movie of fewer than 16 frames an upper bound "
        "(all change of velocity counts), and a lower one in one of two (none counts); it knows nothing of "
        "masks that stay wrong",
    ),
    Column("protruded_area", pa.float64(), "length²", "area won in this sector from this frame to the next"),
    Column("retracted_area", pa.float64(), "length²", "area lost in this sector from this frame to the next"),
    Column(
        "edge_length",
        pa.float64(),
        "length",
        "length of the edge in this sector, mean of this frame and the next; velocity times edge_length, "
        "summed over sectors, is the area won less the area lost",
    ),
    Column("status", pa.string(), "", "ok, or why the sector has no velocity"),
)

CONSISTENCY_COLUMNS: Columns = (
    CELL,
    FRAME,
    TIME_S,
    CHANNEL,
    LAYER,
    Column(
        "correlation",
        pa.float64(),
        "1",
        "Pearson correlation of the layer's window means with those in the next frame",
    ),
    Column(
        "centroid_displacement",
        pa.float64(),
        "length",
        "mean distance that the centroids of the layer's windows move to the next frame",
    ),
    Column("completeness", pa.float64(), "1", "share of the layer's windows that hold pixels"),
)


def schema(columns: Columns, length_unit: str, velocity_unit: str = "") -> Any:
    """Arrow schema with the unit of each column in its metadata.

    Parameters
    ----------
    columns : tuple of Column
    length_unit : {"µm", "px"}
    velocity_unit : str
        Such as "µm/s".

    Returns
    -------
    pyarrow.Schema
    """
    return pa.schema(
        [
            pa.field(column.name, column.kind, metadata={"unit": unit_of(column, length_unit, velocity_unit)})
            for column in columns
        ]
    )


def unit_of(column: Column, length_unit: str, velocity_unit: str = "") -> str:
    """Unit of a column in a run with these units."""
    return column.unit.replace("length", length_unit).replace("velocity", velocity_unit)


def read_table(path: Path) -> pd.DataFrame:
    """A table with the units of its columns in `attrs["units"]`."""
    table = pq.read_table(path)
    frame: pd.DataFrame = table.to_pandas()
    units = {field.name: (field.metadata or {}).get(b"unit", b"").decode() for field in table.schema}
    frame.attrs["units"] = units
    return frame


def write_table(frame: pd.DataFrame, path: Path) -> None:
    """Write a table whose `attrs["units"]` hold the units of its columns."""
    units = frame.attrs.get("units", {})
    table = pa.Table.from_pandas(pd.DataFrame(frame, copy=False), preserve_index=False)
    fields = [field.with_metadata({"unit": units.get(field.name, "")}) for field in table.schema]
    pq.write_table(table.cast(pa.schema(fields)), path)
