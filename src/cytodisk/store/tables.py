"""The tables of a study: their columns, types and units."""

from pathlib import Path
from typing import Any, TypeAlias

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

Columns: TypeAlias = tuple[tuple[str, pa.DataType, str], ...]

# (name, type, unit); "length²", "length" and "velocity" become the units that the run has.
CELL_COLUMNS: Columns = (
    ("cell", pa.int64(), ""),
    ("frame", pa.int64(), "frame"),
    ("time_s", pa.float64(), "s"),
    ("label", pa.int64(), ""),
    ("status", pa.string(), ""),
    ("reason", pa.string(), ""),
    ("notes", pa.string(), ""),
    ("qc_flags", pa.string(), ""),
    ("area", pa.float64(), "length²"),
    ("perimeter", pa.float64(), "length"),
    ("centroid_y", pa.float64(), "px"),
    ("centroid_x", pa.float64(), "px"),
    ("area_px", pa.int64(), "px²"),
    ("components", pa.int64(), ""),
    ("dropped_px", pa.int64(), "px²"),
    ("holes", pa.int64(), ""),
    ("filled_px", pa.int64(), "px²"),
    ("touches_border", pa.bool_(), ""),
    ("border_share", pa.float64(), "1"),
    ("nan_px", pa.int64(), "px²"),
    ("certificate_valid", pa.bool_(), ""),
    ("flipped", pa.int64(), ""),
    ("vertices", pa.int64(), ""),
    ("triangles", pa.int64(), ""),
    ("area_distortion", pa.float64(), "1"),
    ("area_ratio_p1", pa.float64(), "1"),
    ("area_ratio_p99", pa.float64(), "1"),
    ("angle_distortion", pa.float64(), "1"),
    ("angle_distortion_p95", pa.float64(), "1"),
    ("empty_windows", pa.int64(), ""),
    ("relaxation_start", pa.string(), ""),
    ("steps", pa.int64(), ""),
    ("converged", pa.bool_(), ""),
    ("seconds", pa.float64(), "s"),
)

# A map's cells, which may come from many files.
SOURCE_COLUMNS: Columns = (CELL_COLUMNS[0], ("source", pa.string(), ""), *CELL_COLUMNS[1:])

# What a movie's cells have in addition: how the frame was tracked and registered.
TRACK_COLUMNS: Columns = (
    ("restarted", pa.string(), ""),
    ("tracking_residual", pa.float64(), "length"),
    ("order_violations", pa.int64(), ""),
    ("registration_angle", pa.float64(), "°"),
    ("registration_shift_y", pa.float64(), "px"),
    ("registration_shift_x", pa.float64(), "px"),
)

EDGE_COLUMNS: Columns = (
    ("cell", pa.int64(), ""),
    ("frame", pa.int64(), "frame"),
    ("time_s", pa.float64(), "s"),
    ("sector", pa.int64(), ""),
    ("velocity", pa.float64(), "velocity"),
    ("velocity_cell_frame", pa.float64(), "velocity"),
    ("velocity_error", pa.float64(), "velocity"),
    ("protruded_area", pa.float64(), "length²"),
    ("retracted_area", pa.float64(), "length²"),
    ("edge_length", pa.float64(), "length"),
    ("status", pa.string(), ""),
)

CONSISTENCY_COLUMNS: Columns = (
    ("cell", pa.int64(), ""),
    ("frame", pa.int64(), "frame"),
    ("time_s", pa.float64(), "s"),
    ("channel", pa.string(), ""),
    ("layer", pa.int64(), ""),
    ("correlation", pa.float64(), "1"),
    ("centroid_displacement", pa.float64(), "length"),
    ("completeness", pa.float64(), "1"),
)

WINDOW_COLUMNS: Columns = (
    ("cell", pa.int64(), ""),
    ("frame", pa.int64(), "frame"),
    ("time_s", pa.float64(), "s"),
    ("channel", pa.string(), ""),
    ("layer", pa.int64(), ""),
    ("sector", pa.int64(), ""),
    ("mean", pa.float64(), "a.u."),
    ("sd", pa.float64(), "a.u."),
    ("min", pa.float64(), "a.u."),
    ("max", pa.float64(), "a.u."),
    ("n_pixels", pa.float64(), "px²"),
    ("n_nan", pa.float64(), "px²"),
    ("area", pa.float64(), "length²"),
    ("centroid_y", pa.float64(), "px"),
    ("centroid_x", pa.float64(), "px"),
    ("eccentricity", pa.float64(), "1"),
    ("status", pa.string(), ""),
)


def schema(columns: Columns, length_unit: str, velocity_unit: str = "") -> Any:
    """Arrow schema with the unit of each column in its metadata.

    Parameters
    ----------
    columns : tuple of (name, type, unit)
    length_unit : {"µm", "px"}
    velocity_unit : str
        Such as "µm/s".

    Returns
    -------
    pyarrow.Schema
    """
    return pa.schema(
        [
            pa.field(name, kind, metadata={"unit": _unit(unit, length_unit, velocity_unit)})
            for name, kind, unit in columns
        ]
    )


def _unit(unit: str, length_unit: str, velocity_unit: str) -> str:
    return unit.replace("length", length_unit).replace("velocity", velocity_unit)


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
