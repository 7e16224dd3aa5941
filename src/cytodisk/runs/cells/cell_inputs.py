"""The files of a run of `cytodisk map`, opened and checked against each other."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
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
from cytodisk.images.signal_files import common_name, pair_images
from cytodisk.runs.cells.cell_parameters import FileParameters
from cytodisk.runs.cells.folder_inputs import SignalFile, with_common_channels, with_common_scale
from cytodisk.runs.cells.outline_sources import sized_like, with_sizes
from cytodisk.runs.channel_names import channels_words, check_signal_given, name_channels, with_common_name
from cytodisk.runs.file_notes import file_notes
from cytodisk.runs.file_scales import agreed
from cytodisk.scale import Scale

_MOST_UNNAMED = 10  # more planes than that are hardly channels
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
    """

    masks: Path
    sources: tuple[MaskSource, ...]
    signals: dict[str, SignalFile]
    parameters: FileParameters
    scale: Scale
    remarks: tuple[str, ...] = ()

    @property
    def is_folder(self) -> bool:
        """Whether a folder of files was given."""
        return self.sources[0].path != self.masks

    @property
    def signal_files(self) -> list[FrameFile]:
        """Images that can be read, in the order of the masks."""
        return [signal.file for signal in self.signals.values() if signal.file is not None]

    @property
    def notes(self) -> tuple[str, ...]:
        """What is wrong with the files, in words."""
        return file_notes(
            [*(source.file for source in self.sources), *self.signal_files],
            Scale(self.parameters.pixel_size_um),
        )

    @property
    def paths(self) -> Mapping[str, Path | list[Path]]:
        """Files by their role; a list for a folder."""
        masks, signals = [source.path for source in self.sources], [file.path for file in self.signal_files]
        by_role = {"masks": masks, "signal": signals} if signals else {"masks": masks}
        return by_role if self.is_folder else {role: paths[0] for role, paths in by_role.items()}

    @property
    def understood(self) -> dict[str, str]:
        """What each file was read as, in words."""
        if self.is_folder:
            return self._understood_folder()
        source, words = self.sources[0], {}
        if source.file is not None and source.kind is not None:
            masks = source.file
            words["masks"] = f"{_KINDS[source.kind]}, {masks.axes} {masks.shape} {masks.dtype}"
            for signal in self.signal_files:
                words["signal"] = f"{channels_words(signal)}; {signal.axes} {signal.shape} {signal.dtype}"
                if signal.n_frames < masks.n_frames:
                    words["signal"] += f"; the one image is used for all {masks.n_frames} frames of the masks"
        return words

    def _understood_folder(self) -> dict[str, str]:
        kinds = Counter("" if source.kind is None else source.kind for source in self.sources)
        names = {"labels": "label image", "mask": "single mask", "stack": "stack", "": "unusable file"}
        counts = ", ".join(_count(kinds[kind], name) for kind, name in names.items() if kinds[kind])
        words = {"masks": f"{_count(len(self.sources), 'file')}: {counts}"}
        left_out = [name for source in self.sources for name in source.instead_of]
        if left_out:
            words["masks"] += (
                f"; {len(left_out)} left out (as {left_out[0]}): another file has masks of the same image"
            )
        signals = self.signal_files
        if signals:
            words["signal"] = f"{_count(len(signals), 'image')} with {channels_words(signals[0])}"
        return words


def _count(number: int, of: str) -> str:
    return f"{number} {of}" if number == 1 else f"{number} {of}s"


def open_inputs(
    masks: str | os.PathLike[str],
    signal: str | os.PathLike[str] | None,
    parameters: FileParameters,
    signal_name: str = "",
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

    Returns
    -------
    CellInputs
        In a folder, a file that cannot be used, or has no image, is kept with its fault.

    Raises
    ------
    ReadError, MaskError, SignalError, ParameterError
        A file is missing, damaged, or does not fit.
    """
    is_path("masks", masks)
    check_signal_given(signal, parameters)
    if is_folder_of_files(Path(masks)) or is_pattern(Path(masks)):
        return _open_folder(Path(masks), signal, parameters, signal_name)
    choice = sized_like(parameters.mask_choice, masks, signal, parameters.signal_choice, "C")
    sources = open_mask_files(masks, parameters.part(KindParameters), choice=choice)
    image, parameters = with_common_name(
        _open_signal(sources[0], signal, parameters), signal_name, parameters
    )
    files = [file for file in (image, sources[0].file) if file is not None]
    check_choice(files, parameters.scene, parameters.z)
    pixel_size_um = parameters.pixel_size_um or agreed(files, "pixel_size_um")
    return CellInputs(
        Path(masks), sources, {sources[0].name: SignalFile(image)}, parameters, Scale(pixel_size_um)
    )


def _open_folder(
    masks: Path, signal: str | os.PathLike[str] | None, parameters: FileParameters, signal_name: str
) -> CellInputs:
    sources = open_mask_files(masks, parameters.part(KindParameters), images=_endings_beside(masks, signal))
    sources = with_sizes(sources, signal, parameters)
    signals, remarks = _open_signals(sources, signal, parameters, signal_name)
    opened = [source.file for source in sources] + [found.file for found in signals.values()]
    check_choice(opened, parameters.scene, parameters.z)
    pixel_size_um = parameters.pixel_size_um
    if pixel_size_um is None:
        scaled = with_common_scale(sources, signals)
        sources, signals, pixel_size_um = scaled.sources, scaled.signals, scaled.pixel_size_um
        remarks = [*remarks, *scaled.remarks]
    replaced = [
        f"{source.name} is used: {', '.join(source.damaged)} cannot be"
        for source in sources
        if source.damaged
    ]
    return CellInputs(masks, sources, signals, parameters, Scale(pixel_size_um), (*replaced, *remarks))


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


def check_signal(masks: FrameFile, signal: FrameFile) -> None:
    """Raise SignalError unless an image can be sampled with masks."""
    if signal.image_shape != masks.image_shape:
        if signal.doubt:
            raise SignalError(f"signal {signal.doubt}")
        raise SignalError(
            f"signal {signal.path} has images of {signal.image_shape}, the masks of {masks.image_shape}: "
            "they must have the same height and width"
        )
    if signal.dtype.kind not in "biuf":
        raise SignalError(
            f"signal {signal.path} holds values of type {signal.dtype}, which cannot be measured: "
            "save it as uint16 or float32"
        )
    if len(signal.channels) > _MOST_UNNAMED and signal.unnamed:
        raise SignalError(
            f"signal {signal.path} has {len(signal.channels)} planes without names, where one image is due: "
            "pass one frame, or name its axes in the file, and its channels there or with --channels"
        )
    if signal.n_frames not in (1, masks.n_frames):
        raise SignalError(
            f"signal {signal.path} has {signal.n_frames} frames, the masks {masks.n_frames}: "
            "pass as many, or a single image"
        )
