"""Draw in the cell what the dock marks."""

from __future__ import annotations

from collections.abc import Mapping

from cytodisk.napari.disk_view.cell_marks import CellMarks
from cytodisk.napari.disk_view.disk_state import DiskState
from cytodisk.napari.disk_view.pointing import Pointed, ViewerPlaces


def draw_marks(
    marks: CellMarks,
    places: ViewerPlaces | None,
    state: DiskState | None,
    outlines: Mapping[str, tuple[int, int] | None],
    pointed: Pointed | None,
) -> None:
    """Draw outlines of windows, the place that is pointed at in the disk, and the ring of sector 0.

    Parameters
    ----------
    marks : CellMarks
    places : ViewerPlaces or None
    state : DiskState or None
    outlines : dict of str to (int, int), or None
        Layer and sector of the windows by their kind of line, "pinned" and "pointed".
    pointed : Pointed or None
    """
    if places is None or state is None or state.windows is None or not places.is_flat:
        marks.clear()
        return
    for name, window in outlines.items():
        outline = state.outline_yx(window)
        marks.outline(name, None if outline is None else places.scene_xy(outline))
    for draw, point in ((marks.cross, state.place_yx(pointed)), (marks.sector_0, state.sector_0_yx)):
        draw(None if point is None else places.scene_xy(point))
