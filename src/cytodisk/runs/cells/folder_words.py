"""What the files of a folder were read as, in words."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from cytodisk.images.frame_file import FrameFile
from cytodisk.images.mask_files import MaskSource
from cytodisk.runs.channel_names import channels_words


def folder_words(sources: Sequence[MaskSource], signals: Sequence[FrameFile], nuclei: int) -> dict[str, str]:
    """How many files of each kind there are, by their role.

    Parameters
    ----------
    sources : sequence of MaskSource
    signals : sequence of FrameFile
        Images that can be read.
    nuclei : int
        Number of files of nuclei that can be read.

    Returns
    -------
    dict of str to str
    """
    kinds = Counter("" if source.kind is None else source.kind for source in sources)
    names = {"labels": "label image", "mask": "single mask", "stack": "stack", "": "unusable file"}
    counts = ", ".join(_count(kinds[kind], name) for kind, name in names.items() if kinds[kind])
    words = {"masks": f"{_count(len(sources), 'file')}: {counts}"}
    left_out = [name for source in sources for name in source.instead_of]
    if left_out:
        words["masks"] += (
            f"; {len(left_out)} left out (as {left_out[0]}): another file has masks of the same image"
        )
    if signals:
        words["signal"] = f"{_count(len(signals), 'image')} with {channels_words(signals[0])}"
    if nuclei:
        words["nuclei"] = _count(nuclei, "file")
    return words


def _count(number: int, of: str) -> str:
    return f"{number} {of}" if number == 1 else f"{number} {of}s"
