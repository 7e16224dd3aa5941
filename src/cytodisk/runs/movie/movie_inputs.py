"""The files of a movie's run, opened and checked against each other."""

from __future__ import annotations

import os
from dataclasses import dataclass, field, replace
from pathlib import Path

from cytodisk.checks import is_path
from cytodisk.errors import MaskError, ParameterError, SignalError
from cytodisk.images.choice_use import check_choice
from cytodisk.images.evidence.steady_labels import changing_label_words
from cytodisk.images.file_parameters import Kind, KindParameters
from cytodisk.images.frame_file import FrameFile
from cytodisk.images.nuclei.nuclei_files import NucleiFile
from cytodisk.images.sequences.movie_files import open_movie_masks
from cytodisk.images.sequences.movie_signals import open_movie_signal
from cytodisk.images.spots.label_spots import LabelTracks, label_tracks
from cytodisk.images.spots.track_files import read_tracks
from cytodisk.images.tracks import CellTrack, list_tracks
from cytodisk.images.what_it_is import MaskLook, look_at, refuse_several
from cytodisk.motion.nucleus.movie_nuclei import check_settings
from cytodisk.motion.still_interior import fade_in_px
from cytodisk.motion.tracking_parameters import MovieSettings
from cytodisk.runs.cells.fitting_signal import check_signal
from cytodisk.runs.cells.nuclei_given import with_nucleus_layers
from cytodisk.runs.cells.outline_sources import sized_like
from cytodisk.runs.channel_names import channels_words, check_signal_given, name_channels, with_common_name
from cytodisk.runs.depth_layers import check_depths, depth_words
from cytodisk.runs.file_notes import file_notes
from cytodisk.runs.file_scales import agreed
from cytodisk.runs.groups.given_groups import GivenGroups
from cytodisk.runs.movie.movie_parameters import FollowedCellParameters
from cytodisk.runs.movie.nuclei_of_movie import open_nuclei_of_movie, refuse_cells
from cytodisk.scale import Scale
from cytodisk.store.study_folder import part_key
from cytodisk.windows.grid_parameters import PolarGridParameters
from cytodisk.windows.polar_windows import PolarGrid, polar_grid


@dataclass(frozen=True)
class MovieFiles:
    """The files of a run that fit each other, as far as their heads say.

    Attributes
    ----------
    masks : FrameFile
    signal : FrameFile or None
        With the names that were given to its channels.
    scale : Scale
        The given one, or else the files' own.
    nuclei : NucleiFile or None
    """

    masks: FrameFile
    signal: FrameFile | None
    scale: Scale
    nuclei: NucleiFile | None = None


@dataclass(frozen=True)
class MovieInputs:
    """The files of a run, opened and checked against each other.

    Attributes
    ----------
    masks : FrameFile
    kind : {"stack", "labels"}
    tracks : tuple of CellTrack
    signal : FrameFile or None
    parameters : FollowedCellParameters
        As given: those of the run.
    grid : PolarGrid
    scale : Scale
        The given one, or else the files' own.
    mothers : dict of int to int
        Labels of tracks that begin with a division, and of the track that divided.
    nuclei : NucleiFile or None
    groups : GivenGroups or None
        What was done to which cell.
    """

    masks: FrameFile
    kind: Kind
    tracks: tuple[CellTrack, ...]
    signal: FrameFile | None
    parameters: FollowedCellParameters
    grid: PolarGrid
    scale: Scale
    mothers: dict[int, int] = field(default_factory=dict)
    nuclei: NucleiFile | None = None
    groups: GivenGroups | None = None

    @property
    def understood(self) -> dict[str, str]:
        """What each file was read as, in words."""
        height, width = self.masks.image_shape
        size = f"{self.masks.n_frames} frames of {height} × {width} pixels"
        what = "masks of one cell" if self.kind == "stack" else f"labels of {len(self.tracks)} cells"
        if self.parameters.label:
            what += ", the pieces of masks numbered and linked by overlap"
        elif self.parameters.link and self.kind == "labels":
            what += ", linked by overlap"
        words = {"masks": f"{what}, {size} ({self.masks.axes}, {self.masks.dtype})"}
        if self.signal is not None:
            words["signal"] = (
                f"{channels_words(self.signal)}; {self.signal.n_frames} frames "
                f"({self.signal.axes}, {self.signal.dtype})"
            )
        if self.nuclei is not None:
            words["nuclei"] = self.nuclei.words
        if self.parameters.tracks is not None:
            born = f", {len(self.mothers)} of them daughters of others" if self.mothers else ""
            words["tracks"] = f"tracks of {len(self.tracks)} cells{born}"
        if self.grid.depth_um is not None:
            words["windows"] = depth_words(self.grid)
        for role, file in self._files.items():
            if file.files:
                words[role] += f"; {file.evidence}"
        return words if self.groups is None else words | {"groups": self.groups.words}

    @property
    def notes(self) -> tuple[str, ...]:
        """What is wrong with the files, in words."""
        given = self.parameters
        notes = file_notes(self._files.values(), Scale(given.pixel_size_um, given.frame_interval_s))
        return notes if self.groups is None else (*notes, *self.groups.found.warnings)

    @property
    def _files(self) -> dict[str, FrameFile]:
        found = {"masks": self.masks, "signal": self.signal}
        found["nuclei"] = None if self.nuclei is None else self.nuclei.file
        return {role: file for role, file in found.items() if file is not None}

    @property
    def paths(self) -> dict[str, Path | list[Path]]:
        """Files by their role; a list where each frame has its own."""
        tracks = self.parameters.tracks
        paths: dict[str, Path | list[Path]] = {}
        paths |= {role: list(file.files) or file.path for role, file in self._files.items()}
        paths |= {} if self.groups is None else {"groups": self.groups.groups.path}
        return paths | ({} if tracks is None else {"tracks": Path(tracks)})

    @property
    def n_frames(self) -> int:
        """Frames of all cells together."""
        return sum(len(track.frames) for track in self.tracks)

    @property
    def keys(self) -> list[str]:
        """Parts of the study, by cell, then frame."""
        return [part_key(track.cell, frame) for track in self.tracks for frame in track.frames]


def open_movie(
    masks: str | os.PathLike[str],
    signal: str | os.PathLike[str] | None,
    parameters: FollowedCellParameters,
    signal_name: str = "",
    nuclei: str | os.PathLike[str] | None = None,
) -> MovieInputs:
    """Open the files of a run and check that they fit.

    Parameters
    ----------
    masks : path-like
        Masks of one cell by frame, or label images by frame.
    signal : path-like, optional
        Images of the shape of the masks, as many frames as they.
    parameters : MovieParameters
    signal_name : str
        What to call channels without a name, in the place of the file's name.
    nuclei : path-like, optional
        Label images or 0/1 masks of nuclei of the shape of the masks, as many frames as they.

    Returns
    -------
    MovieInputs

    Raises
    ------
    ReadError, MaskError, SignalError, NucleusError, ParameterError, MissingPartError
        A file is missing, damaged, or does not fit.
    """
    parameters = with_nucleus_layers(nuclei, parameters)
    files = open_movie_files(masks, signal, parameters, nuclei)
    signal_file, parameters = with_common_name(files.signal, signal_name, parameters)
    mask_file, scale = files.masks, files.scale
    look = look_at(mask_file, parameters.part(KindParameters))
    refuse_several(look)
    mask_file = look.file
    given = None if parameters.tracks is None else _given_tracks(mask_file, look, parameters, scale)
    link = True if parameters.label else parameters.link  # pieces are numbered frame by frame
    tracks = tuple(list_tracks(look, link, None if given is None else given.frames))
    remarks = () if given is None else given.remarks
    if look.kind == "labels" and given is None and link is None:
        remarks = tuple(filter(None, [changing_label_words(mask_file)]))
    mask_file = replace(mask_file, notes=(*mask_file.notes, *remarks))
    grid = polar_grid(parameters.part(PolarGridParameters))
    check_depths(grid, scale)
    mothers = {} if given is None else given.mothers
    if files.nuclei is not None:
        refuse_cells(files.nuclei, mask_file, look.kind)
    opened = mask_file, look.kind, tracks, signal_file, parameters, grid, scale, mothers
    return MovieInputs(*opened, files.nuclei)


def _given_tracks(
    masks: FrameFile, look: MaskLook, parameters: FollowedCellParameters, scale: Scale
) -> LabelTracks:
    """The tracks of labels by the file of another program."""
    assert parameters.tracks is not None  # whoever calls this has looked
    if parameters.link:
        raise ParameterError("link and tracks exclude each other: pass one of them (--link, --tracks)")
    if look.kind != "labels":
        raise MaskError(
            f"masks {masks.path} hold one cell a frame, and tracks are for label images: take the tracks out "
            "(--tracks), or pass label images"
        )
    return label_tracks(read_tracks(parameters.tracks, scale.frame_interval_s), masks, look.labels, scale)


def open_movie_files(
    masks: str | os.PathLike[str],
    signal: str | os.PathLike[str] | None,
    parameters: FollowedCellParameters,
    nuclei: str | os.PathLike[str] | None = None,
) -> MovieFiles:
    """Open the files of a run and check what their heads say, without looking at a frame.

    Parameters
    ----------
    masks, signal, parameters, nuclei
        As for `open_movie`.

    Returns
    -------
    MovieFiles

    Raises
    ------
    ReadError, MaskError, SignalError, NucleusError, ParameterError
        A file is missing, damaged, or does not fit.
    """
    is_path("masks", masks)
    check_signal_given(signal, parameters)
    choice = sized_like(parameters.mask_choice, masks, signal, parameters.signal_choice, "T")
    found = open_movie_masks(Path(masks), choice, signal is not None)
    mask_file = found.file
    _check_masks(mask_file)
    signal_file = None
    if signal is not None:
        is_path("signal", signal)
        signal_file = open_movie_signal(Path(signal), found, parameters.signal_choice)
        _check_frames(mask_file, signal_file)
    signal_file = name_channels(signal_file, parameters.channels)
    if signal_file is not None:
        check_signal(mask_file, signal_file)
    of_nuclei = None if nuclei is None else open_nuclei_of_movie(nuclei, mask_file, parameters)
    files = signal_file, mask_file, None if of_nuclei is None else of_nuclei.file
    opened = [file for file in files if file is not None]
    check_choice(opened, parameters.scene, parameters.z)
    scale = Scale(
        parameters.pixel_size_um or agreed(opened, "pixel_size_um"),
        parameters.frame_interval_s or agreed(opened, "frame_interval_s"),
    )
    fade_in_px(parameters.part(MovieSettings), scale)
    check_settings(nuclei is not None, parameters.part(MovieSettings))
    return MovieFiles(mask_file, signal_file, scale, of_nuclei)


def _check_masks(masks: FrameFile) -> None:
    if "T" not in masks.axes:
        channels = masks.shape[masks.axes.index("C")] if "C" in masks.axes else 1
        if channels > 1:
            raise MaskError(
                f"masks {masks.path} were understood as one frame with {channels} channels ({masks.axes} "
                f"{masks.shape}): if these are frames, pass --axes {masks.axes.replace('C', 'T')}"
            )
        raise MaskError(f"masks {masks.path} hold one frame: a movie has two at least; use cytodisk map")


def _check_frames(masks: FrameFile, signal: FrameFile) -> None:
    if signal.n_frames == masks.n_frames:
        return
    hint = "pass as many"
    if len(signal.channels) == masks.n_frames:
        hint = f"its {len(signal.channels)} channels look like frames: save it with axes TYX or TCYX"
    raise SignalError(
        f"signal {signal.path} was understood as {signal.n_frames} frames of {len(signal.channels)} channels "
        f"({signal.axes} {signal.shape}), the masks have {masks.n_frames} frames: {hint}"
    )
