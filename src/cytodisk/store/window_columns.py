"""What the tables say about windows: the columns of their own table, and their sizes in that of the cells."""

import pyarrow as pa

from cytodisk.store.tables import (
    CELL,
    CENTROID_X,
    CENTROID_Y,
    CHANNEL,
    FRAME,
    LAYER,
    SECTOR,
    TIME_S,
    Column,
    Columns,
)

WINDOW_COLUMNS: Columns = (
    CELL,
    FRAME,
    TIME_S,
    CHANNEL,
    LAYER,
    SECTOR,
    Column("mean", pa.float64(), "a.u.", "mean of the signal in the window"),
    Column("sd", pa.float64(), "a.u.", "standard deviation of the signal over the window's pixels"),
    Column("min", pa.float64(), "a.u.", "smallest value of the signal in the window"),
    Column("max", pa.float64(), "a.u.", "largest value of the signal in the window"),
    Column(
        "n_pixels",
        pa.float64(),
        "px²",
        "number of pixels in the window, as the sum of their shares, so it need not be whole; times mean, it "
        "is the window's total intensity",
    ),
    Column("n_nan", pa.float64(), "px²", "number of pixels in the window without a value, counted likewise"),
    Column("area", pa.float64(), "length²", "area of the window in the cell"),
    Column(
        "depth",
        pa.float64(),
        "length",
        "median distance of the window's subpixels to the cell's edge; the border of the image is no edge: "
        "beside it, the distance to the nearest edge in the image",
    ),
    Column("depth_p5", pa.float64(), "length", "5th percentile of that distance"),
    Column("depth_p95", pa.float64(), "length", "95th percentile of that distance"),
    CENTROID_Y,
    CENTROID_X,
    Column(
        "eccentricity", pa.float64(), "1", "form of the window in the cell: 0 is round, near 1 is a sliver"
    ),
    Column(
        "status",
        pa.string(),
        "",
        "ok; NaN in signal; no signal, if the run had no image; in a hole, if excluded holes leave none of "
        "the window; deeper than the cell, for layers by depth; or no nucleus, for "
        "layers of the nucleus in a cell without one",
    ),
)

NUCLEUS_WINDOW_COLUMNS: Columns = (
    Column(
        "compartment",
        pa.string(),
        "",
        "cytoplasm or nucleus, whichever the window's layer is in; cell, if the cell was mapped without one",
    ),
    Column(
        "nucleus_distance",
        pa.float64(),
        "length",
        "median distance of the window's subpixels to the outline of the nucleus, inside of it or outside",
    ),
    Column("nucleus_distance_p5", pa.float64(), "length", "5th percentile of that distance"),
    Column("nucleus_distance_p95", pa.float64(), "length", "95th percentile of that distance"),
)
"""What the table of windows has beyond that in a study with nuclei."""

WINDOW_SIZE_COLUMNS: Columns = (
    Column(
        "window_area_error",
        pa.float64(),
        "1",
        "mean of |ln| of each window's area over the area that the grid gives it, which is the same for all "
        "by default: at 0.03 windows differ from equal area by about 3 %",
    ),
    Column("median_window_px", pa.float64(), "px²", "area of the windows in pixels, their median"),
    Column("smallest_window_px", pa.float64(), "px²", "area of the smallest window in pixels"),
    Column("windows_below_10px", pa.float64(), "1", "share of the windows that are smaller than 10 px²"),
    Column("windows_below_1px", pa.float64(), "1", "share of the windows that are smaller than a pixel"),
    Column(
        "windows_between_pixels",
        pa.int64(),
        "",
        "number of windows that hold the centre of no pixel, but parts of pixels alone",
    ),
)
"""How large a cell's windows are, in its table of cells."""
