"""The files of a run of `cytodisk map`, opened and checked against each other."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from cytodisk.errors import CytodiskError, ReadError, SignalError
from cytodisk.io.frames import FrameFile, open_frames
from cytodisk.io.mask_files import MaskSource, open_mask_files
from cytodisk.io.signal_files import pair_images
from cytodisk.study.parameters import MapParameters
from cytodisk.study.run_steps import name_channels
from cytodisk.windows.grid import polar_windows

_MOST_UNNAMED = 10  # more planes than that are hardly channels
_KINDS = {"mask": "one mask", "stack": "a stack of masks", "labels": "a label image, one cell a label"}


@dataclass(frozen=True)
class SignalFile:
    """The image of a mask file, or the reason why there is none; neither without a signal."""

    file: FrameFile | None = None
    fault: CytodiskError | None = None


@dataclass(frozen=True)
class MapInputs:
    """The files of a run.

    Attributes
    ----------
    masks : Path
        As given: a file, or a folder of them.
    sources : tuple of MaskSource
    signals : dict of str to SignalFile
        By name of the source.
    parameters : MapParameters
        As given.
    pixel_size_um : float or None
        The given one, or else the files' own; None when nobody knows.
    """

    masks: Path
    sources: tuple[MaskSource, ...]
    signals: dict[str, SignalFile]
    parameters: MapParameters
    pixel_size_um: float | None

    @property
    def is_folder(self) -> bool:
        """Whether a folder of files was given."""
        return self.sources[0].path != self.masks

    @property
    def signal_files(self) -> list[FrameFile]:
        """Images that can be read, in the order of the masks."""
        return [signal.file for signal in self.signals.values() if signal.file is not None]

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
                names = ", ".join(signal.channels)
                words["signal"] = f"channels {names}; {signal.axes} {signal.shape} {signal.dtype}"
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
            words["signal"] = (
                f"{_count(len(signals), 'image')} with the channels {', '.join(signals[0].channels)}"
            )
        return words


def _count(number: int, of: str) -> str:
    return f"{number} {of}" if number == 1 else f"{number} {of}s"


def open_inputs(
    masks: str | os.PathLike[str], signal: str | os.PathLike[str] | None, parameters: MapParameters
) -> MapInputs:
    """Open the files of a run and check that they fit.

    Parameters
    ----------
    masks : path-like
        One mask, a stack of masks, or a label image (or a stack of those); or a folder of such files, see
        `open_mask_files`.
    signal : path-like, optional
        An image with the shape of the masks, with as many frames as they, or one. For a folder of masks a
        folder, or an ending of names; see `pair_images`.
    parameters : MapParameters

    Returns
    -------
    MapInputs
        In a folder, a file that cannot be used, or has no image, is kept with its fault.

    Raises
    ------
    ReadError, MaskError, SignalError, ParameterError
        A file is missing, damaged, or does not fit.
    """
    sources = open_mask_files(masks, parameters.kind)
    if Path(masks).is_dir():
        signals = _open_signals(sources, signal, parameters)
    else:
        signals = {sources[0].name: _open_signal(sources[0], signal, parameters)}
    polar_windows(parameters.layers, parameters.sectors, parameters.spacing)  # raises if it makes no sense
    opened = [*(found.file for found in signals.values()), *(source.file for source in sources)]
    files = [file for file in opened if file is not None]
    pixel_size_um = parameters.pixel_size_um or common_pixel_size(files)
    return MapInputs(Path(masks), sources, signals, parameters, pixel_size_um)


def _open_signal(
    source: MaskSource, signal: str | os.PathLike[str] | None, parameters: MapParameters
) -> SignalFile:
    found = None if signal is None else _fitting_image(source, Path(signal))
    return SignalFile(name_channels(found, parameters.channels))


def _fitting_image(source: MaskSource, path: Path) -> FrameFile | None:
    if source.file is None:
        return None
    found = open_frames(path, unnamed="T" if source.file.n_frames > 1 else "C")
    check_signal(source.file, found)
    return found


def _open_signals(
    sources: Sequence[MaskSource], signal: str | os.PathLike[str] | None, parameters: MapParameters
) -> dict[str, SignalFile]:
    if signal is None:
        name_channels(None, parameters.channels)  # raises if there are names and nothing to name
        return {source.name: SignalFile() for source in sources}
    images = pair_images(sources, signal)
    opened = [_open_paired(source, image) for source, image in zip(sources, images, strict=True)]
    readable = [found.file for found in opened if found.file is not None]
    if not readable:
        faults = [found.fault for found in opened if found.fault is not None]
        raise SignalError(f"signal {signal}: no image can be used: {faults[0] if faults else 'no mask can'}")
    named = name_channels(readable[0], parameters.channels)
    alike = [_with_channels_of(readable[0], named, found) for found in opened]
    return {source.name: found for source, found in zip(sources, alike, strict=True)}


def _open_paired(source: MaskSource, image: Path | SignalError) -> SignalFile:
    if isinstance(image, SignalError):
        return SignalFile(fault=image)
    try:
        return SignalFile(_fitting_image(source, image))
    except (ReadError, SignalError) as fault:
        return SignalFile(fault=fault)


def _with_channels_of(first: FrameFile, named: FrameFile | None, found: SignalFile) -> SignalFile:
    """The image with the names that were given, or a fault if it has other channels than the first."""
    if found.file is None or named is None:
        return found
    if found.file.channels != first.channels:
        here, there = ", ".join(found.file.channels), ", ".join(first.channels)
        return SignalFile(
            fault=SignalError(
                f"signal {found.file.path} has the channels {here}, {first.path.name} has {there}: "
                "all images of a run must have the same"
            )
        )
    return SignalFile(name_channels(found.file, named.channels))


def common_pixel_size(files: Sequence[FrameFile]) -> float | None:
    """The pixel size that files agree on, in µm; None when none of them knows.

    Raises
    ------
    SignalError
        They differ by more than 1 %.
    """
    known = {file.path: file.pixel_size_um for file in files if file.pixel_size_um is not None}
    if not known:
        return None
    first, size = next(iter(known.items()))
    for path, other in known.items():
        if max(size, other) > 1.01 * min(size, other):
            raise SignalError(
                f"pixel sizes differ: {first} says {size:g} µm, {path} {other:g} µm: "
                "pass the right one, as --pixel-size"
            )
    return size


def check_signal(masks: FrameFile, signal: FrameFile) -> None:
    """Raise SignalError unless an image can be sampled with masks."""
    if signal.image_shape != masks.image_shape:
        raise SignalError(
            f"signal {signal.path} has images of {signal.image_shape}, the masks of {masks.image_shape}: "
            "they must have the same height and width"
        )
    if signal.dtype.kind not in "biuf":
        raise SignalError(f"signal {signal.path} has dtype {signal.dtype}: it must be numbers")
    if len(signal.channels) > _MOST_UNNAMED and signal.channels[0] == "0":
        raise SignalError(
            f"signal {signal.path} has {len(signal.channels)} planes without names, where one image is due: "
            "pass one frame, or name its axes in the file, and its channels there or with --channels"
        )
    if signal.n_frames not in (1, masks.n_frames):
        raise SignalError(
            f"signal {signal.path} has {signal.n_frames} frames, the masks {masks.n_frames}: "
            "pass as many, or a single image"
        )
