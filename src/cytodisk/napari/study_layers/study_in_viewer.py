"""`ShownStudy`: a study whose layers are open in a viewer, and follow its time slider."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any

from psygnal import Signal

from cytodisk.arrays import FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import ParameterError
from cytodisk.napari.given.layer_kinds import MARK
from cytodisk.napari.napari_versions import without_thumbnail
from cytodisk.napari.study_layers.cell_windows_cache import CellWindowsCache
from cytodisk.napari.study_layers.frame_lines import FrameLines
from cytodisk.napari.study_layers.frame_updates import FrameUpdates
from cytodisk.napari.study_layers.painted_frames import PaintedFrames
from cytodisk.napari.study_layers.prefetch import Prefetch
from cytodisk.napari.study_layers.shown_cells import ShownCells
from cytodisk.napari.study_layers.window_values import WindowValues
from cytodisk.store.study import Study
from cytodisk.windows.polar_windows import CellWindows


class ShownStudy:
    """A study, its layers in a viewer, and what is under the cursor and the slider.

    Parameters
    ----------
    study : Study
    source : str, optional
        The file of masks whose cells are shown, of a study of many; by default the first.

    Attributes
    ----------
    study : Study
    cells : ShownCells
        Which cells are in which frame.
    painted : PaintedFrames
        Images of its layers.
    lines : FrameLines
        Lines and points of its layers.
    viewer : Viewer or None
        None until its layers are in one.
    layers : dict of str to Layer
        By role: "windows", "values", "outlines", "velocity", "points", "sector 0", "nuclei".
    tell : callable
        Called with the words of what cannot be read of a frame.
    changed : Signal
        Emitted when another frame or channel is shown.
    """

    changed = Signal()

    def __init__(self, study: Study, source: str | None = None):
        self.study = study
        self.cells = ShownCells.of(study, source)
        self.viewer: Any = None
        self.layers: dict[str, Any] = {}
        self._windows = CellWindowsCache(study)
        self._values = WindowValues(study)
        self.painted = PaintedFrames(self.cells, self._windows, self._values)
        self.lines = FrameLines(self.painted)
        self._prefetch = Prefetch(lambda frame: self._updates.load(frame), self._is_full)
        self._channel = next(iter(self.channels), "")
        self._told: tuple[int | None, str] | None = None
        self._told_faults: set[str] = set()
        self.tell: Callable[[str], None] = lambda words: None

    def __deepcopy__(self, memo: Any) -> ShownStudy:
        return self  # a copied layer shows the same study

    @property
    def source(self) -> str:
        """Name of the file of masks; empty for a movie."""
        return self.cells.source

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of the signal's channels; empty without a signal."""
        return self._values.channels

    @property
    def channel(self) -> str:
        """The channel that is shown; empty without a signal."""
        return self._channel

    @channel.setter
    def channel(self, name: str) -> None:
        if name not in self.channels:
            known = ", ".join(map(repr, self.channels)) or "none, as there is no signal"
            raise ParameterError(f"channel must be one of the study's, got {name!r}: pass one of {known}")
        self._channel = name
        if "values" in self.layers:
            self._show_channel(self.layers["values"])
        self._follow()

    def _show_channel(self, layer: Any) -> None:
        if not self.cells.is_stack:
            layer.data = self.painted.painted(min(self.cells.mapped), self._channel)
        layer.name = f"means of {self._channel}"
        layer.contrast_limits_range = layer.contrast_limits = self.limits(self._channel)
        layer.refresh()

    @property
    def frame(self) -> int | None:
        """Number, in the recording, of the frame under the slider; None if there is none there."""
        if not self.cells.is_stack:
            return next(iter(self.cells.mapped), 0)
        layer = self.layers.get("windows")
        if layer is None or self.viewer is None or self.viewer.dims.ndim < layer.ndim:
            return None
        place = layer.world_to_data(self.viewer.dims.point)[0]
        frame = round(float(place))
        return frame if 0 <= frame < self.cells.n_frames else None

    def cell_at(self, frame: int, yx: Sequence[float]) -> int | None:
        """Cell with a map that holds a place of the image.

        Parameters
        ----------
        frame : int
        yx : (float, float)
            (row, column) in pixels.

        Returns
        -------
        int or None
        """
        found = self.window_at(frame, yx)
        return None if found is None else found[0]

    def window_at(self, frame: int, yx: Sequence[float]) -> tuple[int, int, int] | None:
        """Cell, layer and sector of the window that has most of the pixel at a place; None outside.

        Parameters
        ----------
        frame : int
        yx : (float, float)
            (row, column) in pixels.
        """
        if not self.cells.mapped.get(frame):
            return None
        row, column = (round(float(place)) for place in yx)
        height, width = self.painted.shape
        if not (0 <= row < height and 0 <= column < width):
            return None
        label = int(self.painted.labels(frame)[row, column])
        if not label:
            return None
        place, window = divmod(label - 1, self.painted.n_windows)
        cell = next(one for one in self.cells.mapped[frame] if self.cells.place(one, frame) == place)
        layer, sector = divmod(window, self._windows.grid.sectors)
        return cell, layer, sector

    def map_at(self, cell: int, frame: int) -> DiskMap:
        """Map of a cell in a frame.

        Parameters
        ----------
        cell, frame : int

        Returns
        -------
        DiskMap

        Raises
        ------
        ReadError
            There is none, as its row says, or it is damaged.
        """
        return self._windows.map_at(cell, frame)

    def windows_at(self, cell: int, frame: int) -> CellWindows:
        """Windows of a cell in a frame; see `map_at`."""
        return self._windows.windows_at(cell, frame)

    def values(self, cell: int, channel: str, frame: int) -> FloatArray:
        """Means of a channel, or the edge's velocity, of a cell that has a map.

        Parameters
        ----------
        cell : int
        channel : str
            One of `channels`; or "velocity", "area" or "depth".
        frame : int

        Returns
        -------
        ndarray of shape (layers, sectors) and dtype float
            Velocity has the shape (sectors,).
        """
        numbers = self._values.at(cell, frame)
        return numbers["mean"][self.channels.index(channel)] if channel in self.channels else numbers[channel]

    def unit(self, name: str) -> str:
        """Unit of a channel, or of "velocity", "area" or "depth"."""
        return self._values.units["mean" if name in self.channels else name]

    @cached_property
    def top_speed(self) -> float:
        """Speed at the ends of the colours of velocity, the same in all frames."""
        from cytodisk.analysis.top_speed import top_speed

        return top_speed(self._values.velocities())

    def limits(self, channel: str) -> tuple[float, float]:
        """Ends of the colours of a channel, the same in all frames: percentiles 1 and 99.5 of its means."""
        from cytodisk.plot.style import signal_limits

        if channel not in self._limits:
            self._limits[channel] = signal_limits(self._values.sampled(channel))
        return self._limits[channel]

    @cached_property
    def _limits(self) -> dict[str, tuple[float, float]]:
        return {}

    def bind(self, viewer: Any, layer: Any) -> None:
        """Note that a layer of this study is in a viewer; it follows the slider from then on."""
        self.layers[layer.metadata[MARK]["role"]] = layer
        layer.events.visible.connect(self._seen)
        without_thumbnail(layer)
        if layer.metadata[MARK]["role"] == "windows":
            layer.editable = False  # a brush that is meant for the masks must not paint it
        if self.viewer is None:
            self.viewer = viewer
            viewer.dims.events.current_step.connect(self._follow)
            viewer.layers.events.removed.connect(self._forget)
        self._told = None
        self._follow()

    def move_to(self, study: Study) -> None:
        """Show the same study from another folder, to which it was copied."""
        self.study = self._windows.study = self._values.study = study
        for layer in self.layers.values():
            layer.metadata[MARK]["study"] = str(study.path)

    def _forget(self, event: Any) -> None:
        gone = [role for role, layer in self.layers.items() if layer is event.value]
        for role in gone:
            del self.layers[role]
        if not self.layers and self.viewer is not None:
            self.viewer.dims.events.current_step.disconnect(self._follow)
            self.viewer.layers.events.removed.disconnect(self._forget)
            self.viewer = None
            self._prefetch.stop()

    def _follow(self, event: Any = None) -> None:
        """Bring what layers say to the frame under the slider."""
        frame = self.frame
        if self._told == (frame, self._channel):
            return
        moved = self._told is None or self._told[0] != frame
        self._told = frame, self._channel
        if moved and frame is not None:
            self._show_frame(frame)
        self.changed.emit()

    def _show_frame(self, frame: int) -> None:
        for role, layer in self.layers.items():
            self._updates.show(role, layer, frame)
        faults = [words for (_, other), words in self.painted.faults.items() if other == frame]
        for words in faults:
            if words not in self._told_faults:
                self._told_faults.add(words)
                self.tell(words)
        self._prefetch.around(frame, self.cells.n_frames)

    @cached_property
    def _updates(self) -> FrameUpdates:
        top_speed = self.top_speed if self.study.is_movie else 1.0
        return FrameUpdates(self.painted, self.lines, top_speed)

    def _is_full(self) -> bool:
        return self._windows.boxes.is_full or self._values.is_full or self.lines.is_full

    def _seen(self, event: Any) -> None:
        """A layer that was hidden is shown: it was not brought to the frame."""
        if self.frame is not None:
            for role, layer in self.layers.items():
                self._updates.show(role, layer, self.frame)
