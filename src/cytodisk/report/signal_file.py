"""Find the image file that a study's signal was read from."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from cytodisk.errors import ReadError
from cytodisk.io.frames import open_frames
from cytodisk.io.study import Study


class FrameSource(Protocol):
    """A movie that gives a frame at a time, as `cytodisk.io.frames.open_frames` returns it."""

    @property
    def n_frames(self) -> int:
        """Number of frames."""
        ...

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of the channels."""
        ...

    def frame(self, number: int) -> np.ndarray[Any, Any]:
        """Pixels of a frame, shape (C, H, W)."""
        ...


@dataclass(frozen=True)
class FoundSignal:
    """The movie to show behind the windows.

    Attributes
    ----------
    source : FrameSource or None
        None if there is none to show.
    fault : str
        Why the study's signal is not shown; empty if it is, or if the study has none.
    """

    source: FrameSource | None
    fault: str = ""


def find_signal(study: Study) -> FoundSignal:
    """Open the file that a study names as its signal, if it still holds what was measured.

    Parameters
    ----------
    study : Study

    Returns
    -------
    FoundSignal
        A relative path is looked up from the current folder, then from the study's and the one around it.
    """
    told = study.provenance.get("inputs", {}).get("signal")
    if not told:
        return FoundSignal(None)
    path = Path(told["path"])
    places = [path] if path.is_absolute() else [path, study.path.parent / path, study.path / path]
    there = [place for place in places if place.is_file()]
    if not there:
        return FoundSignal(None, f"{path} is not there any more")
    try:
        same = next((place for place in there if _sha256(place) == told.get("sha256")), None)
        if same is None:
            return FoundSignal(None, f"{path} does not hold what was measured (its sha256 differs)")
        return FoundSignal(open_frames(same))
    except (ReadError, OSError) as error:
        return FoundSignal(None, str(error))


def _sha256(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
