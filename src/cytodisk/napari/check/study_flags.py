"""The QC flags of a study as points that jump to their frame, and as a table."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

from cytodisk.napari.check.flag_points import FlagGround, FlagMarks
from cytodisk.napari.check.flag_table import FlagTable
from cytodisk.napari.check.found_flags import FoundFlag, flags_of_study, sector_place
from cytodisk.runs.qc_flags.qc_flag import QCFlag
from cytodisk.runs.qc_flags.study_flags import qc_flags
from cytodisk.store.study import Study
from cytodisk.windows.study_grid import polar_grid_of

if TYPE_CHECKING:
    from cytodisk.napari.study_layers.shown_study import ShownStudy

_HEIGHT = 150  # px of the table under the canvas


_SHOWN: WeakKeyDictionary[Any, ShownFlags] = WeakKeyDictionary()
"""Flags by the study in a viewer that they are of."""


class ShownFlags:
    """Flags of a study in a viewer.

    Attributes
    ----------
    flags : list of FoundFlag
    layer : Points or None
        None if no flag has a place.
    table : FlagTable
    dock : QDockWidget
    """

    def __init__(self, viewer: Any, flags: list[FoundFlag], ground: FlagGround, study: Study):
        self._viewer = viewer
        self.flags = flags
        self._marks = FlagMarks(
            viewer, flags, ground, {"study": str(study.path), "cell": None}, name="QC flags"
        )
        self.layer = self._marks.layer
        self.table = FlagTable(self._marks.go)
        self.table.show_flags(flags, "No QC flags: nothing speaks against these results.")
        self.table.setMinimumHeight(_HEIGHT)
        self.dock: Any = viewer.window.add_dock_widget(
            self.table, name=f"QC flags of {study.path.name}", area="bottom", tabify=True
        )

    def remove(self) -> None:
        """Take the layer and the table out of the viewer, if they are still there."""
        self._marks.remove()
        if self.dock is not None:
            with suppress(LookupError, RuntimeError):  # the user has closed the table
                self._viewer.window.remove_dock_widget(self.table)
        self.dock = None


def show_flags(
    viewer: Any, study: Study, shown: ShownStudy, flags: Sequence[QCFlag] | None = None
) -> ShownFlags:
    """Show the QC flags of a study: points in the layer "QC flags", and a table under the canvas.

    Parameters
    ----------
    viewer : Viewer
    study : Study
    shown : ShownStudy
        Of its layers in the viewer.
    flags : sequence of QCFlag, optional
        As `qc_flags` finds them, where that was done in a thread.

    Returns
    -------
    ShownFlags
        In the place of those that were shown of the study before.
    """
    remove_flags(shown)
    found = qc_flags(study) if flags is None else flags
    sectors = polar_grid_of(study.provenance).sectors
    edge = partial(sector_place, shown, sectors=sectors)
    ground = _ground(study, shown)
    rows = flags_of_study(study, found, shown.cells.rows, edge, has_time=ground.time_axis is not None)
    flags_shown = ShownFlags(viewer, rows, ground, study)
    _SHOWN[shown] = flags_shown
    return flags_shown


def remove_flags(shown: ShownStudy) -> None:
    """Take the flags of a study out of its viewer, if there are any."""
    there = _SHOWN.pop(shown, None)
    if there is not None:
        there.remove()


def _ground(study: Study, shown: ShownStudy) -> FlagGround:
    """That of the study's layers, or without any, by its scale."""
    for role in ("windows", "values"):
        if role in shown.layers:
            return FlagGround.of(shown.layers[role])
    pixel, interval = study.scale.pixel_size_um, study.scale.frame_interval_s
    dims = 3 if study.is_movie else 2
    length, unit = (1.0, "pixel") if pixel is None else (pixel, "micrometer")
    time, second = (1.0, "pixel") if interval is None else (interval, "second")
    place = (time, length, length)[-dims:], (0.0,) * dims, (second, unit, unit)[-dims:]
    return FlagGround(*place, -3 if study.is_movie else None)
