"""Make room for a run in a folder, without touching what is not a study's."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from cytodisk.errors import OtherRunError, StudyError
from cytodisk.store.provenance_file import PROVENANCE, differences, read_provenance, write_json

LOCK = ".lock"


def make_room(
    folder: Path, provenance: dict[str, Any], own: Sequence[str], resume: bool, overwrite: bool
) -> None:
    """Check that a run may write to a folder that is not empty, and remove what it replaces.

    Parameters
    ----------
    folder : Path
    provenance : dict
        Provenance of the run.
    own : sequence of str
        Names, or patterns of names, of what belongs to a study; nothing else is removed.
    resume, overwrite : bool
        See `StudyFolder.start`.

    Raises
    ------
    StudyError
        The folder holds something else, or another run (`OtherRunError`).
    """
    there = read_provenance(folder)
    if there is None:
        raise StudyError(f"output folder {folder} is not empty and holds no study: pass another folder")
    if overwrite:
        # The old provenance stays, marked, until the new one replaces it: a kill leaves a known study.
        write_json(folder / PROVENANCE, there | {"status": "being replaced", "fingerprint": {}})
        for name in own:
            for file in folder.glob(name):
                _remove(file)
        return
    if not resume:
        raise StudyError(
            f"output folder {folder} holds a study: pass --resume to go on, --overwrite to replace it"
        )
    if there.get("fingerprint") != provenance["fingerprint"]:
        raise OtherRunError(
            f"output folder {folder} holds another run ({differences(there, provenance)}): "
            "pass --overwrite to replace it, or another folder"
        )


def remove_left_overs(places: Iterable[Path]) -> None:
    """Remove the temporary files of a run that was killed while writing; other files are not ours."""
    for place in places:
        for file in place.iterdir():
            if file.name != LOCK and is_left_over(file):
                _remove(file)


def is_left_over(file: Path) -> bool:
    """Whether a file is the lock, or a temporary file of a run."""
    return file.name == LOCK or re.fullmatch(r"\..+\.\d+\.tmp\.\w+", file.name) is not None


def _remove(target: Path) -> None:
    if target.is_dir():
        shutil.rmtree(target)
    else:
        target.unlink(missing_ok=True)
