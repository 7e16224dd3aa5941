"""The files of a run of `cytodisk map`, opened and checked against each other."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from cytodisk.checks import is_path
from cytodisk.errors import CytodiskError, ReadError, SignalError, as_data
from cytodisk.images.choice_use import check_choice
from cytodisk.images.chosen_channels import with_names
from cytodisk.images.file_parameters import KindParameters
from cytodisk.images.frame_file import FrameFile
from cytodisk.images.frames import open_frames
from cytodisk.images.image_paths import is_folder_of_files, is_pattern
from cytodisk.images.mask_files import MaskSource, open_mask_files
from cytodisk.images.nuclei.nuclei_files import NucleiFile
from cytodisk.images.signal_files import common_name, pair_images
from cytodisk.runs.cells.cell_parameters import FileParameters
from cytodisk.runs.cells.fitting_signal import check_signal
from cytodisk.runs.cells.folder_inputs import SignalFile, with_common_channels, with_common_scale
from cytodisk.runs.cells.folder_words import folder_words
from cytodisk.runs.cells.nuclei_given import with_nucleus_layers
from cytodisk.runs.cells.nuclei_inputs import (
    NucleiInput,
    open_nuclei_of,
    open_paired_nuclei,
    with_scale,
)
from cytodisk.runs.cells.outline_sources import sized_like, with_sizes
from cytodisk.runs.channel_names import channels_words, check_signal_given, name_channels, with_common_name
from cytodisk.runs.file_notes import file_notes
from cytodisk.runs.file_scales import agreed, most_common_size
from cytodisk.runs.groups.given_groups import GivenGroups
from cytodisk.scale import Scale

_KINDS = {"mask": "one mask", "stack": "a stack of masks", "labels": "a label image, one cell a label"}


@dataclass(frozen=True)
class CellInputs:
    """The files of a run.

    Attributes
    ----------
    masks : Path
        As given: a file, or a folder of them.
    sources : tuple of MaskSource
    signals : dict of str to SignalFile
        By name of the source.
    parameters : FileParameters
        As given: those of the run.
    scale : Scale
        The given pixel size, or else the files' own, in a folder that of most.
    remarks : tuple of str
        What a user should know of the files of a folder before the run.
    nuclei : dict of str to NucleiInput
        By name of the source; empty without nuclei.
    groups : GivenGroups or None
        What was done to which cell.
    given : dict of str to str
        What the user gave by role, as "_img" for a signal beside its masks.
    """

    masks: Path
    sources: tuple[MaskSource, ...]
    signals: dict[str, SignalFile]
    parameters: FileParameters
    scale: Scale
    remarks: tuple[str, ...] = ()
    nuclei: dict[str, NucleiInput] = field(default_factory=dict)
    groups: GivenGroups | None = None
    given: dict[str, str] = field(default_factory=dict)

    @property
    def is_folder(self) -> bool:
        """Whether a folder of files was given."""
        return self.sources[0].path != self.masks

    @property
    def signal_files(self) -> list[FrameFile]:
        """Images that can be read, in the order of the masks."""
        return [signal.file for signal in self.signals.values() if signal.file is not None]

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of the channels, the same in all images; empty without a signal."""
        return self.signal_files[0].channels if self.signal_files else ()

    @property
    def nuclei_files(self) -> list[NucleiFile]:
        """Files of nuclei that can be read, in the order of the masks."""
        return [found.file for found in self.nuclei.values() if found.file is not None]

    @property
    def notes(self) -> tuple[str, ...]:
        """What is wrong with the files, in words."""
        nuclei = [found.file for found in self.nuclei_files]
        return file_notes(
            [*(source.file for source in self.sources), *self.signal_files, *nuclei],
            Scale(self.parameters.pixel_size_um),
        )

    @property
    def paths(self) -> Mapping[str, Path | list[Path]]:
        """Files by their role; a list for a folder."""
        found = {
            "masks": [source.path for source in self.sources],
            "signal": [file.path for file in self.signal_files],
            "nuclei": [found.file.path for found in self.nuclei_files],
        }
        by_role = {role: paths for role, paths in found.items() if paths}
        of_groups = {} if self.groups is None else {"groups": self.groups.groups.path}
        return (
            by_role if self.is_folder else {role: paths[0] for role, paths in by_role.items()}
        ) | of_groups

    @property
    def understood(self) -> dict[str, str]:
        """What each file was read as, in words."""
        if self.is_folder:
            words = folder_words(self.sources, self.signal_files, len(self.nuclei_files))
        else:
            words = self._understood_file()
        return words if self.groups is None else words | {"groups": self.groups.words}

    def _understood_file(self) -> dict[str, str]:
        source, words = self.sources[0], {}
        if source.file is not None and source.kind is not None:
            masks = source.file
            words["masks"] = f"{_KINDS[source.kind]}, {masks.axes} {masks.shape} {masks.dtype}"
            for signal in self.signal_files:
                words["signal"] = f"{channels_words(signal)}; {signal.axes} {signal.shape} {signal.dtype}"
                if signal.n_frames < masks.n_frames:
                    words["signal"] += f"; the one image is used for all {masks.n_frames} frames of the masks"
        for nuclei in self.nuclei_files:
            words["nuclei"] = nuclei.words
        return words


def open_inputs(
    masks: str | os.PathLike[str],
    signal: str | os.PathLike[str] | None,
    parameters: FileParameters,
    signal_name: str = "",
    nuclei: str | os.PathLike[str] | None = None,
) -> CellInputs:
    """Open the files of a run and check that they fit.

    Parameters
    ----------
    masks : path-like
        One mask, a stack of masks, or a label image (or a stack of those); or a folder of such files, see
        `open_mask_files`.
    signal : path-like, optional
        An image with the shape of the masks, with as many frames as they, or one. For a folder of masks a
        folder, or an ending of names; see `pair_images`.
    parameters : FileParameters
        Those of the run, which has more.
    signal_name : str
        What to call channels without a name, in the place of the file's name.
    nuclei : path-like, optional
        A label image or a 0/1 mask of nuclei with the shape and the frames of the masks. For a folder of
        masks a folder, or an ending of names; see `pair_files`.

    Returns
    -------
    CellInputs
        In a folder, a file that cannot be used, or has no image, is kept with its fault.

    Raises
    ------
    ReadError, MaskError, SignalError, NucleusError, ParameterError
        A file is missing, damaged, or does not fit.
    """
    is_path("masks", masks)
    check_signal_given(signal, parameters)
    parameters = with_nucleus_layers(nuclei, parameters)
    by_role = {"masks": masks, "signal": signal, "nuclei": nuclei}
    given = {role: os.fspath(path) for role, path in by_role.items() if path is not None}
    if is_folder_of_files(Path(masks)) or is_pattern(Path(masks)):
        return replace(_open_folder(Path(masks), signal, nuclei, parameters, signal_name), given=given)
    choice = sized_like(parameters.mask_choice, masks, signal, parameters.signal_choice, "C")
    sources = open_mask_files(masks, parameters.part(KindParameters), choice=choice)
    image, parameters = with_common_name(
        _open_signal(sources[0], signal, parameters), signal_name, parameters
    )
    of_nuclei = {} if nuclei is None else {sources[0].name: open_nuclei_of(sources[0], nuclei, parameters)}
    files = [file for file in (image, sources[0].file, *_files(of_nuclei)) if file is not None]
    check_choice(files, parameters.scene, parameters.z)
    pixel_size_um = parameters.pixel_size_um or agreed(files, "pixel_size_um")
    signals = {sources[0].name: SignalFile(image)}
    scale = Scale(pixel_size_um)
    return CellInputs(Path(masks), sources, signals, parameters, scale, nuclei=of_nuclei, given=given)


def _files(nuclei: Mapping[str, NucleiInput]) -> list[FrameFile]:
    return [found.file.file for found in nuclei.values() if found.file is not None]


def _open_folder(
    masks: Path,
    signal: str | os.PathLike[str] | None,
    nuclei: str | os.PathLike[str] | None,
    parameters: FileParameters,
    signal_name: str,
) -> CellInputs:
    beside = _endings_beside(masks, signal, nuclei)
    sources = open_mask_files(masks, parameters.part(KindParameters), images=beside)
    sources = with_sizes(sources, signal, parameters)
    signals, remarks = _open_signals(sources, signal, parameters, signal_name)
    of_nuclei = {} if nuclei is None else open_paired_nuclei(sources, nuclei, parameters)
    opened = [source.file for source in sources] + [found.file for found in signals.values()]
    check_choice([*opened, *_files(of_nuclei)], parameters.scene, parameters.z)
    pixel_size_um = parameters.pixel_size_um
    if pixel_size_um is None:
        scaled = with_common_scale(sources, signals)
        sources, signals, pixel_size_um = scaled.sources, scaled.signals, scaled.pixel_size_um
        pixel_size_um = pixel_size_um or most_common_size(
            size for file in _files(of_nuclei) if (size := file.scale.pixel_size_um) is not None
        )
        of_nuclei, more = with_scale(of_nuclei, pixel_size_um)
        remarks = [*remarks, *scaled.remarks, *more]
    replaced = [
        f"{source.name} is used: {', '.join(source.damaged)} cannot be"
        for source in sources
        if source.damaged
    ]
    scale = Scale(pixel_size_um)
    return CellInputs(masks, sources, signals, parameters, scale, (*replaced, *remarks), of_nuclei)


def _endings_beside(masks: Path, *others: str | os.PathLike[str] | None) -> tuple[str, ...]:
    """How the names of files go on that lie in the folder of the masks, and are none."""
    beside = masks.parent if is_pattern(masks) else masks
    return tuple(
        Path(other).name.lstrip("*")
        for other in others
        if other is not None and not Path(other).exists() and Path(other).parent in (Path(), beside)
    )


def _open_signal(
    source: MaskSource, signal: str | os.PathLike[str] | None, parameters: FileParameters
) -> FrameFile | None:
    found = None if signal is None else _fitting_image(source, Path(signal), parameters)
    return name_channels(found, parameters.channels)


def _fitting_image(source: MaskSource, path: Path, parameters: FileParameters) -> FrameFile | None:
    if source.file is None:
        return None
    unnamed = "T" if source.file.n_frames > 1 else "C"
    found = open_frames(path, unnamed=unnamed, choice=parameters.signal_choice)
    check_signal(source.file, found)
    return found


def _open_signals(
    sources: Sequence[MaskSource],
    signal: str | os.PathLike[str] | None,
    parameters: FileParameters,
    signal_name: str,
) -> tuple[dict[str, SignalFile], list[str]]:
    """The image of each mask file by its name, and remarks."""
    if signal is None:
        name_channels(None, parameters.channels)  # raises if there are names and nothing to name
        return {source.name: SignalFile() for source in sources}, []
    images = pair_images(sources, signal)
    opened = [_open_paired(source, image, parameters) for source, image in zip(sources, images, strict=True)]
    if all(found.file is None for found in opened):
        faults = [found.fault for found in opened if found.fault is not None]
        raise SignalError(f"signal {signal}: no image can be used: {faults[0] if faults else 'no mask can'}")
    name = signal_name or common_name(Path(signal))
    opened = [found if found.file is None else SignalFile(with_names(found.file, name)) for found in opened]
    alike, remarks = with_common_channels(opened, parameters.channels)
    return {source.name: found for source, found in zip(sources, alike, strict=True)}, remarks


def _open_paired(source: MaskSource, image: Path | CytodiskError, parameters: FileParameters) -> SignalFile:
    if isinstance(image, CytodiskError):
        return SignalFile(fault=image)
    try:
        return SignalFile(_fitting_image(source, image, parameters))
    except (ReadError, SignalError) as fault:
        return SignalFile(fault=as_data(fault))
