"""What the files of a folder must have in common: channels and pixel size."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from cytodisk.errors import CytodiskError, MaskError, SignalError
from cytodisk.images.frame_file import FrameFile
from cytodisk.images.mask_files import MaskSource
from cytodisk.runs.channel_names import name_channels
from cytodisk.runs.file_scales import most_common_size
from cytodisk.scale import alike


@dataclass(frozen=True)
class SignalFile:
    """The image of a mask file, or the reason why there is none; neither without a signal."""

    file: FrameFile | None = None
    fault: CytodiskError | None = None


def with_common_channels(
    opened: Sequence[SignalFile], names: tuple[str, ...] | None
) -> tuple[list[SignalFile], list[str]]:
    """Images with the channels that most have; the others become faults.

    Parameters
    ----------
    opened : sequence of SignalFile
        At least one with a file.
    names : tuple of str, or None
        Names for the channels, as `MapParameters` takes them.

    Returns
    -------
    signals : list of SignalFile
    remarks : list of str
        How many differ, if any.

    Raises
    ------
    ParameterError, SignalError
        The names do not fit the channels.
    """
    readable = [found.file for found in opened if found.file is not None]
    usual, _ = Counter(file.channels for file in readable).most_common(1)[0]
    example = next(file for file in readable if file.channels == usual)
    named = name_channels(example, names)
    signals = []
    for found in opened:
        if found.file is None or named is None:
            signals.append(found)
        elif found.file.channels == usual:
            signals.append(SignalFile(name_channels(found.file, named.channels)))
        else:
            signals.append(SignalFile(fault=_other_channels(found.file, example)))
    others = sum(file.channels != usual for file in readable)
    remark = (
        f"{others} of {len(readable)} images have other channels than {', '.join(usual)}: they are left out"
    )
    return signals, [remark] if others else []


def _other_channels(file: FrameFile, example: FrameFile) -> SignalError:
    return SignalError(
        f"signal {file.path} has {_channels(file)}, {example.path.name} and most others have "
        f"{_channels(example).removeprefix('the channels ')}: all images of a run must have the same"
    )


def _channels(file: FrameFile) -> str:
    if not file.unnamed:
        return f"the channels {', '.join(file.channels)}"
    count = len(file.channels)
    return "one channel without a name" if count == 1 else f"{count} channels without names"


@dataclass(frozen=True)
class Scaled:
    """Files of a folder, and the pixel size that counts for all of them.

    Attributes
    ----------
    sources : tuple of MaskSource
    signals : dict of str to SignalFile
        By name of the source.
    pixel_size_um : float or None
    remarks : list of str
        How many files do not know it, or say otherwise.
    """

    sources: tuple[MaskSource, ...]
    signals: dict[str, SignalFile]
    pixel_size_um: float | None
    remarks: list[str]


def with_common_scale(sources: Sequence[MaskSource], signals: Mapping[str, SignalFile]) -> Scaled:
    """The pixel size that most files say; a file that says otherwise becomes a fault.

    Parameters
    ----------
    sources : sequence of MaskSource
    signals : mapping of str to SignalFile
        By name of the source.

    Returns
    -------
    Scaled
    """
    pairs = [(source, signals[source.name]) for source in sources]
    said = [_sizes(source, signal) for source, signal in pairs if source.file is not None]
    size = most_common_size(one for sizes in said for one in sizes[:1])
    if size is None:
        return Scaled(tuple(sources), dict(signals), None, [])
    checked = [(_same_scale(source, size), _same_image_scale(signal, size)) for source, signal in pairs]
    silent = sum(not sizes for sizes in said)
    others = sum(any(not alike(size, one) for one in sizes) for sizes in said)
    remarks = []
    if silent:
        remarks.append(
            f"{silent} of {len(said)} files do not say their pixel size: {size:g} µm is taken for them"
        )
    if others:
        remarks.append(f"{others} of {len(said)} files have another pixel size than {size:g} µm: left out")
    found = {source.name: signal for source, signal in checked}
    return Scaled(tuple(source for source, _ in checked), found, size, remarks)


def _sizes(source: MaskSource, signal: SignalFile) -> list[float]:
    files = [file for file in (signal.file, source.file) if file is not None]
    return [file.scale.pixel_size_um for file in files if file.scale.pixel_size_um is not None]


def _same_scale(source: MaskSource, size: float) -> MaskSource:
    words = _difference(source.file, size)
    return replace(source, file=None, kind=None, fault=MaskError(words)) if words else source


def _same_image_scale(signal: SignalFile, size: float) -> SignalFile:
    words = _difference(signal.file, size)
    return SignalFile(fault=SignalError(f"signal {words}")) if words else signal


def _difference(file: FrameFile | None, size: float) -> str:
    own = None if file is None else file.scale.pixel_size_um
    if file is None or own is None or alike(size, own):
        return ""
    return (
        f"{file.path} has pixels of {own:g} µm, most files of the folder {size:g} µm: "
        "map it alone, or pass the right size for all, as --pixel-size"
    )
