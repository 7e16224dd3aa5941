"""A choice that no file offers is told, as it may be meant for another file."""

from __future__ import annotations

from collections.abc import Iterable

from cytodisk.errors import ParameterError
from cytodisk.images.frame_file import FrameFile

_SEVERAL = {"scene": "scenes", "z": "slices in z"}


def check_choice(
    files: Iterable[FrameFile | None], scene: str | None, z: str | None, flags: str = "--"
) -> None:
    """Raise if a scene or a slice is chosen, and there is no choice of one in any file.

    Parameters
    ----------
    files : iterable of (FrameFile or None)
        Of masks and signals together.
    scene, z : str or None
        As a user chose.
    flags : str
        What stands before their names, for messages.

    Raises
    ------
    ParameterError
        No file has several scenes, or slices.
    """
    there = [file for file in files if file is not None]
    for name, value in (("scene", scene), ("z", z)):
        if value is not None and there and not any(name in file.offers for file in there):
            names = ", ".join(dict.fromkeys(file.path.name for file in there[:3]))
            raise ParameterError(
                f"{flags}{name} {value} chooses nothing: no file has several {_SEVERAL[name]} ({names}); "
                f"leave out {flags}{name}"
            )
