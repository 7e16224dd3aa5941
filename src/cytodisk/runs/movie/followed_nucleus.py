"""What the table of a movie's cells says of a nucleus and how it was followed."""

from __future__ import annotations

from typing import Any

import numpy as np

from cytodisk.motion.mapped_frame import MappedFrame
from cytodisk.runs.cells.cell_nuclei import CellNucleus
from cytodisk.runs.cells.nucleus_rows import nucleus_columns


def followed_nucleus_columns(nucleus: CellNucleus | None, frame: MappedFrame) -> dict[str, Any]:
    """Columns of a mapped frame's row in a study with nuclei; none in one without.

    Parameters
    ----------
    nucleus : CellNucleus or None
        As it came.
    frame : MappedFrame
    """
    if nucleus is None or frame.nucleus is None or frame.disk.nucleus is None:
        return {}
    tracked, report = frame.nucleus, frame.disk.nucleus.report
    columns = nucleus_columns(nucleus, report)
    if tracked.held:  # the report is that of the frame before
        columns["n_nuclei"] = 0 if nucleus.match is None else len(nucleus.match.nuclei)
    return columns | {
        "nucleus_held": tracked.held,
        "nucleus_restarted": tracked.boundary.restarted,
        "nucleus_turn": float(np.degrees(tracked.boundary.transform.angle)),
        "nucleus_twist": float(np.degrees(tracked.twist)),
        "nucleus_tracking_residual": frame.disk.scale.length(tracked.boundary.residual_px),
    }
