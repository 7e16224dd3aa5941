"""Names of mask files, and of the images that they belong to."""

from __future__ import annotations

import glob
import re
from collections.abc import Iterable
from pathlib import Path

from cytodisk.errors import ReadError
from cytodisk.images.image_paths import is_folder_of_files, is_pattern

# Endings of mask files; where one image has several, the one that stands first here is taken.
ENDINGS = (
    "_masks.tif",
    "_masks.tiff",
    "_masks.png",
    "_cp_masks.tif",
    "_cp_masks.tiff",
    "_cp_masks.png",
    "_seg.npy",
    *(
        f"_{kind}{suffix}"  # as ilastik calls its exports
        for kind in ("object identities", "simple segmentation", "object predictions")
        for suffix in (".tif", ".tiff", ".png")
    ),
)
IMAGES = (".tif", ".tiff", ".png", ".npy")
"""Endings of images, of which a folder can hold many."""
_OUTLINES = re.compile(r"(.+?)([-_ ]?roi(s|set)?)?\.(zip|roi|geojson)", re.IGNORECASE)


def base_name(name: str) -> str:
    """The name of the image that a mask file belongs to, without its ending: "a" of "a_cp_masks.png"."""
    lower = name.lower()
    fitting = [ending for ending in ENDINGS if lower.endswith(ending)]
    if (outlines := _OUTLINES.fullmatch(name)) is not None:  # as "a_rois.zip" or "a.tif.geojson"
        return image_stem(outlines[1])
    return name[: -max(map(len, fitting))] if fitting else image_stem(name)


def is_mask_name(name: str) -> bool:
    """Whether a file's name ends as those of masks do."""
    return name.lower().endswith(ENDINGS)


def image_stem(name: str) -> str:
    """A file's name without the ending that says how it is stored: "a" of "a.ome.tif"."""
    return re.sub(r"(\.ome)?\.(tiff?|png|npy|nd2|czi|lif|zarr)$", "", name, flags=re.IGNORECASE)


def natural_order(name: str) -> list[tuple[int, str]]:
    """A key that sorts names with numbers as a person would: a2 before a10."""
    return [(int(part), "") if part.isdecimal() else (0, part) for part in re.split(r"(\d+)", name.lower())]


def visible_files(folder: Path) -> list[Path]:
    """Files of a folder in natural order, but for hidden ones; a link that leads nowhere is one too.

    Raises
    ------
    ReadError
        The folder cannot be read.
    """
    try:
        found = [file for file in folder.iterdir() if not file.is_dir() and not file.name.startswith(".")]
    except OSError as error:
        raise ReadError(f"folder {folder} cannot be read: {error.strerror}") from error
    return sorted(found, key=lambda file: natural_order(file.name))


def files_of(place: Path) -> list[Path]:
    """Files of a folder or a pattern in natural order.

    Raises
    ------
    ReadError
        The folder cannot be read, or the pattern fits no file.
    """
    if not is_pattern(place):
        return visible_files(place)
    if place.parent.is_dir():  # whose own name may have brackets
        found = [file for file in place.parent.glob(place.name) if not file.name.startswith(".")]
    else:
        found = [Path(name) for name in glob.glob(str(place), recursive=True)]  # noqa: PTH207  may be absolute
    files = [file for file in found if not is_folder_of_files(file)]
    if not files:
        raise ReadError(f"no file fits the pattern {place}: check the folder and the names")
    return sorted(files, key=lambda file: natural_order(str(file)))


def without_name(reason: str, name: str) -> str:
    """A reason that names its own file first, without that name, for where it stands already.

    Parameters
    ----------
    reason : str
    name : str
        Name of the file, without its folder.

    Returns
    -------
    str
    """
    before, found, after = reason.partition(name)
    return after.lstrip(": ") if found and ": " not in before and after.startswith((":", " ")) else reason


def mask_names(folder: Path, images_end: tuple[str, ...] = ()) -> list[tuple[Path, list[Path]]]:
    """Find the mask files of a folder, or of a pattern.

    Parameters
    ----------
    folder : Path
    images_end : tuple of str
        As `open_mask_files` takes it.

    Returns
    -------
    list of (Path, list of Path)
        The first mask file of each image, and others for the same image.

    Raises
    ------
    ReadError
        The folder cannot be read, or holds no masks, or a pattern fits files of several folders.
    """
    files = files_of(folder)
    if len(folders := {file.parent for file in files}) > 1:
        raise ReadError(
            f"{folder} fits files of {len(folders)} folders: pass the files of one, or all as inputs of "
            "cytodisk batch"
        )
    named = [file for file in files if is_mask_name(file.name)]
    if not named and (outlines := [file for file in files if _OUTLINES.fullmatch(file.name)]):
        return [(file, []) for file in outlines]
    if not named:
        images = [file for file in files if file.suffix.lower() in IMAGES]
        if images_end:
            images = [file for file in images if not any(_ends(file.name, end) for end in images_end)]
        if not images:
            raise ReadError(
                f"folder {folder} holds no masks: neither files that end in {', '.join(ENDINGS[:7])}, "
                f"nor outlines (.zip, .roi, .geojson), nor other images ({', '.join(IMAGES)})"
            )
        return [(file, []) for file in images]
    return best_masks(named)


def best_masks(files: Iterable[Path]) -> list[tuple[Path, list[Path]]]:
    """Of mask files with one of `ENDINGS` the first of each image, and others for the same image."""
    by_image: dict[str, list[Path]] = {}
    for file in files:
        by_image.setdefault(base_name(file.name), []).append(file)
    ranked = [sorted(group, key=lambda file: _rank(file.name)) for group in by_image.values()]
    return [(first, others) for first, *others in ranked]


def _ends(name: str, ending: str) -> bool:
    return name.endswith(ending) or image_stem(name).endswith(ending)


def _rank(name: str) -> int:
    """Place of the longest ending that fits: `_cp_masks.tif` ends in `_masks.tif` too."""
    fitting = [ending for ending in ENDINGS if name.lower().endswith(ending)]
    return ENDINGS.index(max(fitting, key=len))
