"""`DiskDock`: the disk of the cell under the cursor, linked with the viewer both ways."""

from __future__ import annotations

from typing import Any

import numpy as np
from qtpy.QtCore import QTimer
from qtpy.QtGui import QColor
from qtpy.QtWidgets import QWidget

from cytodisk.napari.disk_view.cell_numbers import CellNumbers
from cytodisk.napari.disk_view.disk_choices import DiskChoice, disk_choices
from cytodisk.napari.disk_view.disk_parts import DiskParts
from cytodisk.napari.disk_view.disk_pixels import DiskColours
from cytodisk.napari.disk_view.disk_state import DiskState
from cytodisk.napari.disk_view.drawn_marks import draw_marks
from cytodisk.napari.disk_view.pointing import Pointed, ViewerPlaces, pointed_in_cell, pointed_in_disk
from cytodisk.napari.disk_view.viewer_link import ViewerLink
from cytodisk.napari.docks import join_docks
from cytodisk.napari.napari_versions import camera_of, plain_viewer, text_colour_of
from cytodisk.napari.study_layers.shown_study import shown_studies

NO_STUDY = (
    "No study with maps is open. Open a study folder (File, Open Folder…), or run “Map cells” or “Follow "
    "cells”: the disk of the cell under the cursor is then shown here."
)
_MOST_KEPT = 4  # cells whose numbers through time are kept


class DiskDock(QWidget):
    """The dock.

    Parameters
    ----------
    napari_viewer : Viewer

    Attributes
    ----------
    parts : DiskParts
        Its widgets.
    state : DiskState or None
        What is shown; None without a study.
    pointed : Pointed or None
        What the cursor points at, in the cell or in the disk.
    pinned : (int, int, int) or None
        Cell, layer and sector that were clicked.
    link : ViewerLink or None
        None while the dock is hidden.
    """

    def __init__(self, napari_viewer: Any):
        super().__init__()
        self.viewer = plain_viewer(napari_viewer)
        self.parts = DiskParts(self)
        self.state: DiskState | None = None
        self.pointed: Pointed | None = None
        self.pinned: tuple[int, int, int] | None = None
        self._shown: Any = None
        self._places: ViewerPlaces | None = None
        self.link: ViewerLink | None = None
        self._cursor_yx: tuple[float, float] | None = None
        self._kept: dict[tuple[int, int], CellNumbers] = {}
        self._connect_parts()
        self._link()

    def _connect_parts(self) -> None:
        parts = self.parts
        parts.studies.currentIndexChanged.connect(self._take_study)
        parts.cells.currentIndexChanged.connect(self._choose_cell)
        parts.choices.currentIndexChanged.connect(self._choose_colours)
        parts.grid.toggled.connect(parts.show_grid)
        parts.picture.hovered.connect(self._hover_disk)
        parts.picture.clicked.connect(self._click_disk)
        parts.picture.left.connect(self._leave_disk)
        for trace in (parts.trace, parts.velocity_trace):
            trace.chosen.connect(self._go_to)

    # With the viewer

    def _link(self) -> None:
        """Follow the viewer; done again when the dock is shown again."""
        if self.link is None:
            called = self._follow_cursor, self._layers_changed, self._take_look, self._click_cell
            self.link = ViewerLink(self.viewer, *called)
            self._take_look()
            self._list_studies()

    def _unlink(self) -> None:
        """Leave the viewer as it was."""
        if self.link is not None:
            self._take_shown(None)
            self.link.end()
            self.link = None

    def showEvent(self, event: Any) -> None:
        """Follow the viewer."""
        join_docks(self)
        self._link()

    def hideEvent(self, event: Any) -> None:
        """Follow it no more: the dock is closed, or behind another one."""
        self._unlink()

    def _take_look(self, event: Any = None) -> None:
        self.parts.set_text_colour(QColor(*text_colour_of(self.viewer)))
        self._draw_marks()

    # Studies

    def _layers_changed(self, event: Any = None) -> None:
        QTimer.singleShot(0, self._list_studies)  # once the study knows its layers

    def _list_studies(self) -> None:
        if self.link is None:
            return
        studies = [shown for shown in shown_studies(self.viewer) if shown.cells.mapped]
        self.parts.list_studies(studies, self._shown)
        self._take_study()

    def _take_study(self, index: int = 0) -> None:
        self._take_shown(self.parts.study)

    def _take_shown(self, shown: Any) -> None:
        if shown is not self._shown:
            if self._shown is not None:
                self._shown.changed.disconnect(self._follow_study)
            if shown is not None:
                shown.changed.connect(self._follow_study)
            self._shown, self.state, self.pointed, self.pinned = shown, None, None, None
            self._kept = {}
            self.parts.list_cells(shown)
        self._places = None if shown is None else ViewerPlaces.of(shown)
        self.parts.list_choices([] if shown is None else disk_choices(shown), self._choice)
        self.refresh()

    @property
    def _choice(self) -> DiskChoice | None:
        if self.state is not None and self.state.choice.kind != "mean":
            return self.state.choice
        channel = "" if self._shown is None else self._shown.channel
        return DiskChoice("mean", (channel,)) if channel else None

    def _follow_study(self) -> None:
        """Another frame is shown, or another channel."""
        if self.state is not None and self.state.choice.kind == "mean" and self._choice is not None:
            self.parts.choose(self._choice)
        self.refresh()

    def _choose_cell(self, index: int = 0) -> None:
        self.pointed = None
        self.refresh()

    def _choose_colours(self, index: int = 0) -> None:
        choice = self.parts.choice
        if choice is not None and choice.kind == "mean" and choice.names[0] != self._shown.channel:
            self._shown.channel = choice.names[0]
        self.refresh()

    # What is shown

    def refresh(self) -> None:
        """Show the frame under the slider, and what is pointed at in it."""
        choice = self.parts.choice
        if self._shown is None or choice is None:
            self.state = None
            self.parts.picture.show_colours(None, NO_STUDY)
            self.parts.show_keys(None, None)
            self._show_pointed()
            return
        frame = self._shown.frame
        if self._cursor_yx is not None and frame is not None:
            self.pointed = self._under_cursor(frame)
        self.state = DiskState(self._shown, self._numbers(self._cell(frame)), choice, frame)
        self._show_disk(self.state)
        self._show_pointed()

    def _cell(self, frame: int | None) -> int:
        """The chosen cell, the one under the cursor, the one before, or the first."""
        chosen = self.parts.cell
        if chosen is not None:
            return int(chosen)
        if self.pointed is not None:
            return self.pointed.cell
        mapped = self._shown.cells.mapped
        if self.state is not None and (
            self._shown.study.is_movie or self.state.cell in mapped.get(frame, ())
        ):
            return self.state.cell
        return int(next(iter(mapped.get(frame, ())), next(iter(mapped.values()))[0]))

    def _numbers(self, cell: int) -> CellNumbers:
        key = id(self._shown), cell
        found = self._kept.pop(key, None) or CellNumbers(self._shown, cell)
        self._kept[key] = found
        while len(self._kept) > _MOST_KEPT:
            del self._kept[next(iter(self._kept))]
        return found

    def _show_disk(self, state: DiskState) -> None:
        colours, before = state.colours(), self.parts.picture.colours
        message = ""
        if colours is None:
            message = f"No map of cell {state.cell} here: {state.no_map}"
            colours = None if before is None else DiskColours(before.grid)
        self.parts.picture.show_colours(colours, message)
        self.parts.show_keys(*state.keys())
        self.parts.show_cell(state)

    def _show_pointed(self) -> None:
        """Mark what is pointed at in the disk and in the cell, and say what it is."""
        state = self.state
        pointed = self.pointed if state is not None and state.windows is not None else None
        window = None if pointed is None else pointed.window
        self.parts.point_at(state, pointed, self._pinned_here)
        self.parts.show_window(state, window or self._pinned_here)
        self._draw_marks()

    @property
    def _pinned_here(self) -> tuple[int, int] | None:
        """Layer and sector of the window that was clicked, if it is one of the cell that is shown."""
        if self.pinned is None or self.state is None or self.pinned[0] != self.state.cell:
            return None
        return self.pinned[1:]

    def _draw_marks(self) -> None:
        if self.link is not None:
            pointed = None if self.pointed is None else self.pointed.window
            outlines = {"pinned": self._pinned_here, "pointed": pointed}
            draw_marks(self.link.marks, self._places, self.state, outlines, self.pointed)

    # The cursor

    def _follow_cursor(self, event: Any = None) -> None:
        """The cursor is at another place of the canvas, or not on it any more."""
        shown, places = self._shown, self._places
        if shown is None or places is None:
            return
        before = self._cursor_yx
        self._cursor_yx = places.pixel(self.viewer.cursor.position) if self.viewer.mouse_over_canvas else None
        frame = shown.frame
        if self._cursor_yx is None or frame is None:
            if before is not None:
                self._point(None)
            return
        if self.state is None or self.state.frame == frame:  # or else the new frame is about to be shown
            self._point(self._under_cursor(frame))

    def _under_cursor(self, frame: int) -> Pointed | None:
        """What the cursor is at in the cell, if that cell may be shown."""
        if self._cursor_yx is None:
            return None
        found = pointed_in_cell(self._shown, frame, self._cursor_yx)
        return found if found is None or self.parts.may_show(found.cell) else None

    def _point(self, pointed: Pointed | None) -> None:
        if pointed == self.pointed:
            return
        self.pointed = pointed
        if pointed is not None and (self.state is None or pointed.cell != self.state.cell):
            self.refresh()
        else:
            self._show_pointed()

    def _click_cell(self) -> None:
        """Keep the window under the cursor marked."""
        self.pin(self.pointed)

    def pin(self, pointed: Pointed | None) -> None:
        """Keep a window marked, whatever is pointed at; none to let it go."""
        self.pinned = None if pointed is None else (pointed.cell, *pointed.window)
        self._show_pointed()

    def _hover_disk(self, u: float, v: float) -> None:
        state = self.state
        if state is None or state.windows is None or state.frame is None:
            return
        self._cursor_yx = None
        self._point(pointed_in_disk(self._shown, state.cell, state.frame, (u, v)))

    def _leave_disk(self) -> None:
        if self.pointed is not None and self.pointed.by_disk:
            self._point(None)

    def _click_disk(self, u: float, v: float) -> None:
        """Keep the window marked, and move the camera to the place in the cell."""
        self._hover_disk(u, v)
        if self.pointed is None or self.state is None or self._places is None:
            return
        self.pin(self.pointed)
        place = self.state.place_yx(self.pointed)
        if place is not None and np.isfinite(place).all() and self._places.is_flat:
            ((x, y),) = self._places.scene_xy(place)
            camera_of(self.viewer).center = float(y), float(x)

    def _go_to(self, frame: int) -> None:
        if self._places is not None:
            self._places.go_to(frame)
