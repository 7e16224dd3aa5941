"""What the table of a movie's cells says of how their nuclei were followed."""

import pyarrow as pa

from cytodisk.store.tables import Column, Columns

NUCLEUS_TRACK_COLUMNS: Columns = (
    Column(
        "nucleus_held",
        pa.string(),
        "",
        "why the nucleus is that of the frame before, moved with the cell; empty if it is the frame's own",
    ),
    Column(
        "nucleus_restarted",
        pa.string(),
        "",
        "why following the nucleus started anew here: its places do not go with those before; else empty",
    ),
    Column(
        "nucleus_turn",
        pa.float64(),
        "degrees",
        "turn of the nucleus in its cell since it was first followed, from +x towards +y, as its outline "
        "tells: a round one shows none",
    ),
    Column(
        "nucleus_twist",
        pa.float64(),
        "degrees",
        "how far the nucleus has turned against the membrane on the disk; the cytoplasm between is sheared "
        "by that much. From 270 degrees on, a whole turn is taken back",
    ),
    Column(
        "nucleus_tracking_residual",
        pa.float64(),
        "length",
        "mean distance between points of the nuclear outline and where they come to lie when carried on and "
        "back again",
    ),
)
