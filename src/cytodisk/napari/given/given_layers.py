"""Layers that are open become the files that a command reads."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from cytodisk.images.frame_file import FileChoice, FrameFile
from cytodisk.napari.given.chosen_layers import ChosenLayers, check_kinds
from cytodisk.napari.given.layer_axes import UNNAMED
from cytodisk.napari.given.layer_frames import LayerFrames, frames_of, like_its_file
from cytodisk.napari.given.layer_kinds import layer_kind
from cytodisk.napari.given.layer_places import check_places
from cytodisk.napari.given.scale_of_layers import ScaleOfLayers
from cytodisk.napari.given.shapes_file import write_shapes
from cytodisk.napari.given.source_file import same_pixels, source_file
from cytodisk.napari.given.tracks_file import write_tracks
from cytodisk.napari.given.written_layers import channel_name, write_masks, write_signal
from cytodisk.scale import UNKNOWN, Scale


@dataclass(frozen=True)
class GivenFiles:
    """Files that hold what layers show.

    Attributes
    ----------
    masks : Path
    signal, nuclei, tracks : Path or None
    scale : Scale
        What the layers say, or else their files.
    values : dict of str to object
        Parameters without which the files alone would be read otherwise, as `pixel_size_um` where the layer
        says another one than its file; those that a user typed come over them.
    notes : tuple of str
        What a user should know, in words.
    written : tuple of Path
        Those of the files that were written; the others are the user's own.
    """

    masks: Path
    signal: Path | None = None
    nuclei: Path | None = None
    tracks: Path | None = None
    scale: Scale = UNKNOWN
    values: dict[str, Any] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    written: tuple[Path, ...] = ()


def given_files(
    chosen: ChosenLayers,
    folder: Path,
    values: Mapping[str, Any] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> GivenFiles:
    """Files that hold what layers show: the files that they were opened from, or new ones.

    Parameters
    ----------
    chosen : ChosenLayers
    folder : Path
        Where new files are written, one a layer, with its name.
    values : mapping of str to object, optional
        Parameters that the user typed; of these axes, scene and slice count here.
    progress : callable, optional
        Called with (images done, images in all); whatever it raises ends the work.

    Returns
    -------
    GivenFiles

    Raises
    ------
    ReadError, MaskError, SignalError
        Layers cannot be used, or not together.

    Notes
    -----
    No layer is changed. An array that is read when it is needed (Dask, Zarr) is read image by image.
    """
    check_kinds(chosen)
    for other in chosen.of_pixels[1:]:
        check_places(chosen.of_pixels[0], other)
    work = _Work(chosen, Path(folder), dict(values or {}), progress)
    return work.done()


@dataclass
class _Read:
    """A layer of pixels, with the file that it was opened from."""

    frames: LayerFrames
    source: FrameFile | None


class _Work:
    """What is done for each of the chosen layers."""

    def __init__(
        self,
        chosen: ChosenLayers,
        folder: Path,
        typed: dict[str, Any],
        progress: Callable[[int, int], None] | None,
    ):
        self._chosen, self._folder, self._typed, self._progress = chosen, folder, typed, progress
        self._values: dict[str, Any] = {}
        self._notes: list[str] = []
        self._written: list[Path] = []
        self._read = {
            role: [self._opened(layer, role) for layer in layers if layer_kind(layer) in ("labels", "image")]
            for role, layers in self._layers.items()
        }
        self._done = 0
        every = [one for reads in self._read.values() for one in reads]
        self._all = sum(one.frames.planes * (1 if one.source is None else 2) for one in every)
        self._scale = ScaleOfLayers([(one.frames.layer, one.frames.letters, one.source) for one in every])

    @property
    def _layers(self) -> dict[str, list[Any]]:
        chosen = self._chosen
        nuclei = [] if chosen.nuclei is None else [chosen.nuclei]
        return {"masks": [chosen.masks], "signal": [*chosen.signal], "nuclei": nuclei}

    def _opened(self, layer: Any, role: str) -> _Read:
        prefix = {"masks": "axes", "signal": "signal_axes", "nuclei": "nuclei_axes"}[role]
        axes = self._typed.get(prefix)
        axes = None if axes is None else str(axes).strip().upper()
        z, scene = (None if (said := self._typed.get(one)) is None else str(said) for one in ("z", "scene"))
        frames = frames_of(layer, axes)
        source = source_file(layer, frames, FileChoice(axes, scene, z))
        return _Read(frames if source is None else like_its_file(frames, source), source)

    def done(self) -> GivenFiles:
        """Find or write all files."""
        self._folder.mkdir(parents=True, exist_ok=True)
        masks = self._masks(self._chosen.masks, "masks", "mask_channel")
        signal = self._signal()
        nuclei = (
            None
            if self._chosen.nuclei is None
            else self._masks(self._chosen.nuclei, "nuclei", "nuclei_channel")
        )
        tracks = None
        if self._chosen.tracks is not None:
            tracks = self._path(self._chosen.tracks, ".xml")
            write_tracks(tracks, self._chosen.tracks, next(iter(self._chosen.of_pixels), None))
            self._values["tracks"] = str(tracks)
        frames = [one.frames for reads in self._read.values() for one in reads]
        is_movie = any(letter in one.axes for one in frames for letter in f"T{UNNAMED}")
        self._values |= self._scale.values(is_movie=is_movie)
        notes = [*self._notes, *self._scale.notes(self._typed, is_movie=is_movie)]
        known = self._scale.known
        return GivenFiles(
            masks,
            signal,
            nuclei,
            tracks,
            known,
            self._values,
            tuple(dict.fromkeys(notes)),
            tuple(self._written),
        )

    def _masks(self, layer: Any, role: str, of_channel: str) -> Path:
        if layer_kind(layer) == "shapes":
            path = self._path(layer, ".geojson")
            self._notes += write_shapes(path, layer, next(iter(self._chosen.of_pixels), None))
            self._scale.add_unsaid()
            return path
        (read,) = self._read[role]
        found = self._same(read)
        if found is not None:
            assert read.source is not None  # whose pixels they are
            if len(found) < len(read.source.channels):
                self._values[of_channel] = str(found[0])
            return read.source.path
        path = self._path(layer, ".ome.tif")
        write_masks(path, read.frames, self._scale.known, self._step)
        self._scale.add_written(read.frames.axes)
        return path

    def _signal(self) -> Path | None:
        reads = self._read["signal"]
        if not reads:
            return None
        sources = {None if one.source is None else one.source.path for one in reads}
        if len(sources) == 1 and None not in sources:
            path = self._source_of(reads)
            if path is not None:
                return path
        path = self._path(reads[0].frames.layer, ".ome.tif")
        write_signal(path, [one.frames for one in reads], self._scale.known, self._step)
        axes = reads[0].frames.axes
        self._scale.add_written(axes)
        names = [channel_name(one.frames.layer) for one in reads]
        if UNNAMED in axes and "C" not in axes:
            self._values["channels"] = tuple(names)
        return path

    def _source_of(self, reads: Sequence[_Read]) -> Path | None:
        """The one file whose channels are those of the layers, if it is."""
        found = [self._same(one) for one in reads]
        if any(one is None for one in found) or (len(found) > 1 and any(len(one or ()) > 1 for one in found)):
            return None
        source = reads[0].source
        assert source is not None  # whoever calls this has looked
        numbers = [number for one in found for number in one or ()]
        if numbers != list(range(len(source.channels))):
            if len(set(numbers)) < len(numbers):
                return None
            self._values["signal_channels"] = tuple(map(str, numbers))
        names = [channel_name(one.frames.layer) for one in reads]
        if len(names) == len(numbers) and not _called_so(names, source, numbers):
            self._values["channels"] = tuple(names)
        return source.path

    def _same(self, read: _Read) -> tuple[int, ...] | None:
        if read.source is None:
            return None
        found = same_pixels(read.frames, read.source, self._step)
        if found is not None:
            self._scale.add_file(read.source)
        return found

    def _step(self) -> None:
        self._done = min(self._done + 1, self._all)
        if self._progress is not None:
            self._progress(self._done, self._all)

    def _path(self, layer: Any, ending: str) -> Path:
        """A new file called after a layer."""
        name = re.sub(r"[^\w.+-]+", "_", str(layer.name)).strip("._") or "layer"
        taken = {path.name for path in self._written}
        name = next(
            full
            for k in range(1, 1000)
            if (full := f"{name}{'' if k == 1 else f'_{k}'}{ending}") not in taken
        )
        self._written.append(self._folder / name)
        return self._written[-1]


def _called_so(names: Sequence[str], source: FrameFile, numbers: Sequence[int]) -> bool:
    """Whether channels have names of their own in the file, or those that napari gives layers of it."""
    own = [source.channels[number] for number in numbers]
    plain = [re.sub(r" \[\d+\]$", "", name) for name in names]
    return plain == own or all(
        name == source.path.name.split(".")[0] or name == source.path.stem for name in plain
    )
