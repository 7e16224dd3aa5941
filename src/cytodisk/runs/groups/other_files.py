"""Files that a table of groups names, and that are there, but not of this run."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path

from cytodisk.images.mask_names import base_name, image_stem


class OtherFiles:
    """The files beside those of a run.

    Parameters
    ----------
    folders : iterable of Path
        Where files of the run, and the table, lie.
    """

    def __init__(self, folders: Iterable[Path]):
        self._folders = list(dict.fromkeys(folders))
        self._names: dict[Path, set[str]] = {}

    def has(self, text: str) -> bool:
        """Whether a file that a user names is there.

        Parameters
        ----------
        text : str
            A name, with or without its ending, or a path.
        """
        *parents, name = text.replace("\\", "/").split("/")
        given = "/".join(parents)
        absolute = text.startswith("/") or re.match(r"[A-Za-z]:", text) is not None
        return any(name in self._names_in(place) for place in self._places(given, absolute))

    def _places(self, given: str, absolute: bool) -> Iterator[Path]:
        """Folders that a file in `given` may lie in; paths count from any folder above the files, too."""
        if absolute:
            yield Path(given or "/")
            return
        for folder in self._folders:
            yield folder / given
            if given:
                yield folder.parent / given

    def _names_in(self, folder: Path) -> set[str]:
        """Names of the files of a folder, also without their endings; none where it cannot be read."""
        if folder not in self._names:
            try:
                names = [file.name for file in folder.iterdir() if not file.name.startswith(".")]
            except OSError:
                names = []
            said = (words for name in names for words in (name, image_stem(name), base_name(name)))
            self._names[folder] = set(said)
        return self._names[folder]
