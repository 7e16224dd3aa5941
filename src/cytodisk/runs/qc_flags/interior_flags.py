"""QC flags of movies whose interior stands still (`interior="still"`)."""

from collections.abc import Iterator
from dataclasses import replace

from cytodisk.runs.qc_flags import column_flags
from cytodisk.runs.qc_flags.column_flags import ColumnRule, said
from cytodisk.runs.qc_flags.qc_flag import QCFlag
from cytodisk.store.study import Study

SMALLEST_STILL_SHARE = 0.1
"""Share of its area in a map of equal areas below which a window is squeezed."""

interior_restarts = ColumnRule(
    "interior restarts",
    "the interior leaps in {frames}",
    "The edge moved so far at once that places inside could not be carried on from the frame before, or "
    "tracking started anew.",
    "Compare windows within the stretches between restarts. Or with windows of equal area: ",
    "interior_restarted",
    said,
    lambda value, row, scale: str(value),
    again=("interior", "area"),
)
small_still_windows = ColumnRule(
    "small still windows",
    "windows are squeezed to less than a tenth of their share of the cell in {frames}",
    "The interior stands still and the edge has come close: a cell that migrates or shrinks cannot stand "
    "still for ever. The means of these windows come from few pixels.",
    "Use the frames before, or start the movie later. Or with windows of equal area: ",
    "smallest_window_share",
    lambda column, scale: column < SMALLEST_STILL_SHARE,
    lambda value, row, scale: f"{100 * value:.2g} % of its usual area",
    again=("interior", "area"),
)


def distortion(study: Study) -> Iterator[QCFlag]:
    """Windows that differ much in area, in a study that asked for equal areas."""
    if study.provenance.get("parameters", {}).get("interior") == "still":
        return
    rule = column_flags.distortion
    if rule.column not in study.cells:  # a study of an earlier version
        rule = replace(rule, column="area_distortion")
    yield from rule(study)
