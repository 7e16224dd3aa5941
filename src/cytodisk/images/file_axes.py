"""Which axis of a file's array is what: as the user says, as the file says, else as its shape suggests."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, TypeAlias

from cytodisk.errors import ReadError

Said: TypeAlias = Literal["user", "file", "nobody"]

_PLAIN = "TCYX"
_OTHERS = {
    "Z": "slices of a z-stack",
    "R": "positions",
    "M": "tiles of a mosaic",
    "A": "angles",
    "P": "phases",
    "H": "lifetimes",
    "E": "wavelengths",
    "L": "exposures",
    "V": "events",
    "J": "columns of a plate",
    "K": "rows of a plate",
}
"""What axes mean that are neither time nor channels, by the letters of tifffile."""

_NARROW = 4  # times smaller than both others is no width of an image


@dataclass(frozen=True)
class FileAxes:
    """The axes of a file's array as understood.

    Attributes
    ----------
    letters : str
        T frames, C channels, Y, X; without axes of length 1 beside Y and X.
    shape : tuple of int
        Along `letters`.
    said_by : {"user", "file", "nobody"}
        Who named them; where nobody did, the first of three is a guess.
    doubt : str
        What speaks against a guess, in words that end with the remedy; empty if nothing does.
    """

    letters: str
    shape: tuple[int, ...]
    said_by: Said = "file"
    doubt: str = ""

    @property
    def evidence(self) -> str:
        """How the axes are known, in words; empty for a plain image."""
        if self.said_by == "user":
            return f"axes {self.letters} as given"
        if len(self.letters) == 2:
            return ""
        if self.said_by == "file":
            return f"axes {self.letters} by its metadata"
        return f"axes {self.letters} guessed, as the file does not name them"


def file_axes(
    file: Path, said: str, shape: Sequence[int], unnamed: str, chosen: str | None = None
) -> FileAxes:
    """Axes of a file in the letters T, C, Y, X.

    Parameters
    ----------
    file : Path
        For messages.
    said : str
        One letter an axis, as tifffile writes them: Q, I, or an S that is not last, stand for an axis that
        the file does not name.
    shape : sequence of int
    unnamed : {"T", "C"}
        What such an axis is taken for.
    chosen : str, optional
        What the user says, in the place of the file; axes of length 1 may be left out.

    Returns
    -------
    FileAxes

    Raises
    ------
    ReadError
        The axes are not those of a movie or an image, or there are not as many as the user says.
    """
    shape = tuple(int(size) for size in shape)
    kept = long_axes(file, said, shape, chosen)
    sizes = tuple(size for _, size in kept)
    for axis, _ in kept:
        if axis in _OTHERS:
            raise ReadError(_other_words(file, axis, chosen or said, shape))
    if chosen is not None:
        return FileAxes("".join(axis for axis, _ in kept), sizes, said_by="user")
    letters, guessed = "", False
    for place, (axis, _) in enumerate(kept):
        colour = axis == "S" and place == len(kept) - 1
        guessed |= axis not in _PLAIN and not colour
        letters += axis if axis in _PLAIN else "C" if colour else unnamed
    if len(set(letters)) != len(letters) or not {"Y", "X"} <= set(letters):
        raise ReadError(
            f"{file} has {len(shape)} axes of sizes {shape}, which it calls {said}: Q and I name none. Pass "
            f"one letter an axis, such as {axes_flag('TCYX')}"
        )
    doubt = shape_doubt(file, letters, sizes) if guessed else ""
    return FileAxes(letters, sizes, "nobody" if guessed else "file", doubt)


def long_axes(
    file: Path, said: str, shape: Sequence[int], chosen: str | None = None
) -> list[tuple[str, int]]:
    """Letter and size of each axis of a file's array, without those of length 1 beside Y and X.

    Parameters
    ----------
    file, said, shape, chosen
        As of `file_axes`.

    Raises
    ------
    ReadError
        There are not as many as the user says, with or without those of length 1.
    """
    letters, sizes = chosen or said, list(shape)
    if len(letters) != len(sizes):
        sizes = [size for size in shape if size > 1]
    if len(letters) != len(sizes):
        raise ReadError(
            f"{file} has {len(shape)} axes of sizes {tuple(shape)}, {axes_flag(letters)} names "
            f"{len(letters)}: pass one letter an axis"
        )
    return [(axis, size) for axis, size in zip(letters, sizes, strict=True) if size > 1 or axis in "YX"]


_FLAGS = {
    "--signal-channels": "--signal-axes",
    "--nuclei-channel": "--nuclei-axes",
    "--mask-channel": "--axes",
    "channels": "axes",
}


def axes_named(words: str, flag: str) -> str:
    """A message that names axes, with the flag of the file whose channels are chosen by another flag."""
    return words.replace("--axes ", f"{_FLAGS[flag]} ")


def axes_flag(letters: str = "") -> str:
    """The flag that names axes, as "--axes TYX"."""
    return f"--axes {letters}" if letters else "--axes"


def shape_doubt(file: Path, letters: str, shape: Sequence[int]) -> str:
    """What a shape says against axes of which the first is a guess; empty if nothing."""
    if len(letters) != 3 or letters[1:] != "YX":
        return ""
    first, height, width = shape
    equal = first == height != width
    narrow = _NARROW * width < min(first, height)
    if not (equal or narrow):
        return ""
    return axis_words(file, letters, shape, f"YX{letters[0]}", "its shape")


def axis_words(file: Path, letters: str, shape: Sequence[int], likely: str, evidence: str) -> str:
    """What speaks against a guess of axes, with both remedies.

    Parameters
    ----------
    file : Path
    letters : str
        As guessed, such as "TYX".
    shape : sequence of int
    likely : str
        What they look like, such as "YXT".
    evidence : str
        By what, as "its shape".
    """
    first, height, width = shape
    what, name = ("frames", "time") if letters[0] == "T" else ("channels", "channels")
    place = "last" if likely.endswith(letters[0]) else "second"
    return (
        f"{file} of shape {tuple(shape)} does not name its axes, and {evidence} speaks against "
        f"{first} {what} of {height} × {width} pixels: its {place} axis looks like {name}. If it is, "
        f"pass {axes_flag(likely)}; else pass {axes_flag(letters)}"
    )


def _other_words(file: Path, axis: str, said: str, shape: tuple[int, ...]) -> str:
    if axis == "Z":
        slices = shape[said.index(axis)]
        words = (
            f"{file} is a z-stack (axes {said}, shape {shape}): project it, as --z max, or take one slice, "
            f"as --z {slices // 2}"
        )
    else:
        number = shape[said.index(axis)]
        words = f"{file} has {number} {_OTHERS[axis]} (axes {said}, shape {shape}): save one of them alone"
    frames = said.replace(axis, "T").replace("S", "C")
    usable = set(frames) <= set(_PLAIN) and "T" not in said
    return f"{words}; or if they are frames, pass {axes_flag(frames)}" if usable else words
