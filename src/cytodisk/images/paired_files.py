"""Files that go with the mask files of a folder, such as images or nuclei, found by their names."""

from __future__ import annotations

import os
import shlex
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from cytodisk.errors import CytodiskError, NucleusError, ReadError, SignalError
from cytodisk.images.image_paths import is_folder_of_files, is_pattern
from cytodisk.images.mask_files import MaskSource
from cytodisk.images.mask_names import (
    base_name,
    best_masks,
    image_stem,
    is_mask_name,
    natural_order,
    visible_files,
)

_PIXELS = (".tif", ".tiff", ".png", ".nd2", ".czi", ".lif")
_STARTS_OF_ENDINGS = ("_", "-", ".")


@dataclass(frozen=True)
class Role:
    """What files are for that go with mask files.

    Attributes
    ----------
    name : str
        Of the argument, "signal"; the flag is the same.
    one, many : str
        As "image" and "images".
    endings : tuple of str
        How names usually go on, where a folder is given; the last as an example.
    fault : type
        Of errors.
    """

    name: str
    one: str
    many: str
    endings: tuple[str, ...]
    fault: Callable[[str], CytodiskError]

    @property
    def example(self) -> str:
        """As "--signal _img"."""
        return f"--{self.name} {self.endings[-1]}"


IMAGES = Role("signal", "image", "images", ("", "_img"), SignalError)
NUCLEI = Role("nuclei", "file of nuclei", "files of nuclei", ("", "_nuclei"), NucleusError)


def pair_files(
    sources: Sequence[MaskSource], given: str | os.PathLike[str], role: Role
) -> tuple[Path | CytodiskError, ...]:
    """Find the file that goes with each mask file of a folder, by its name.

    Parameters
    ----------
    sources : sequence of MaskSource
        As `open_mask_files` finds them in a folder.
    given : path-like
        A folder, where `a.tif`, or for a signal `a_img.tif`, belongs to `a_masks.tif`; or how the names go
        on, as "_img" or "_w1.tif", with the folder in front if it is another than that of the masks; or the
        same as a pattern, "images/*_w1.tif".
    role : Role

    Returns
    -------
    tuple of (Path or CytodiskError)
        By mask file; the error says that there is none, or more than one.

    Raises
    ------
    ReadError
        There is no such folder.
    SignalError, NucleusError
        It is a single file, or no mask file has one.
    """
    pairing = _Pairing.of(Path(given), sources, role)
    found = tuple(pairing.file_of(source) for source in sources)
    if all(isinstance(file, CytodiskError) for file in found):
        raise role.fault(f"{role.name} {given} fits no mask file: {found[0]}{pairing.advice(sources)}")
    return found


@dataclass(frozen=True)
class _Pairing:
    """The files of a folder by the names that they go by."""

    role: Role
    folder: Path
    endings: tuple[str, ...]
    files: dict[str, list[Path]]
    masks: dict[str, Path]  # files whose names end as those of masks do, by the name of their image

    @classmethod
    def of(cls, given: Path, sources: Sequence[MaskSource], role: Role) -> _Pairing:
        folder, endings = _where(given, sources[0].path.parent, role)
        visible = visible_files(folder)
        files: dict[str, list[Path]] = {}
        for file in visible:
            for name in {file.name, image_stem(file.name)}:
                files.setdefault(name, []).append(file)
        masks = [] if role is IMAGES else [file for file in visible if is_mask_name(file.name)]
        best = {base_name(file.name): file for file, _ in best_masks(masks)}
        return cls(role, folder, endings, files, best)

    def file_of(self, source: MaskSource) -> Path | CytodiskError:
        """The file that goes with a mask file."""
        names = [base_name(source.name) + ending for ending in self.endings]
        own = [mask for name in names if (mask := self.masks.get(name)) not in (None, source.path)]
        every = own or [file for name in names for file in self.files.get(name, [])]
        found = [file for file in every if file != source.path]
        if len(found) == 1:
            return found[0]
        if found:
            several = ", ".join(file.name for file in found)
            return self.role.fault(
                f"{source.name} has several {self.role.many} in {self.folder} ({several}): "
                f"pass how the names of the right ones go on, as {self.role.example}.tif"
            )
        looked_for = " or ".join(name if Path(name).suffix else f"{name}.tif" for name in names)
        return self.role.fault(
            f"{source.name} has no {self.role.one} in {self.folder}: {looked_for} (or .png) is not there"
        )

    def advice(self, sources: Sequence[MaskSource]) -> str:
        """What to type, or to rename, where no mask file has one; empty where nothing fits."""
        masks, first = {source.path for source in sources}, base_name(sources[0].name)
        others = [file for files in self.files.values() for file in files if file not in masks]
        named = [file for file in self.files.get(first, []) if file not in masks]
        flag = f"--{self.role.name}"
        if named:
            return f", but {named[0].name} is: pass {flag} {shlex.quote(str(self.folder))}"
        pixels = [
            file.name
            for file in others
            if file.suffix.lower() in _PIXELS and base_name(file.name) == image_stem(file.name)
        ]
        longer = [
            name for name in pixels if name.startswith(first) and name[len(first)] in _STARTS_OF_ENDINGS
        ]
        if longer:
            ending = Path(longer[0][len(first) :])
            place = ending if self.folder == sources[0].path.parent else self.folder / ending
            return f", but {longer[0]} is: pass {flag} {shlex.quote(str(place))}"
        if not pixels:
            return ""
        return (
            f"; {min(pixels, key=natural_order)} and others are there: give the {self.role.many} the names "
            "of their masks, or if the files are the frames of one movie, use cytodisk movie"
        )


def _where(given: Path, masks: Path, role: Role) -> tuple[Path, tuple[str, ...]]:
    if is_folder_of_files(given):
        return given, role.endings
    if given.exists():
        raise role.fault(
            f"{role.name} {given} is one file for a folder of masks: pass a folder of {role.many} with names "
            f"as those of the masks, or how their names go on, as {role.example}"
        )
    if is_pattern(given) and given.name.startswith("*"):
        given = given.with_name(given.name.lstrip("*") or "*")
    folder = masks if given.parent == Path() else given.parent
    if not given.name.startswith(_STARTS_OF_ENDINGS) or not folder.is_dir():
        raise ReadError(
            f"{role.name} {given} does not exist: pass a folder of {role.many}, or how the names of "
            f"{role.many} go on beside the masks, as {role.example}"
        )
    return folder, (given.name,)
