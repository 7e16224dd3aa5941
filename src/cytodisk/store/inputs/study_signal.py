"""Find the image file that a study's signal was read from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import pandas as pd
import xarray as xr

from cytodisk.errors import ReadError, SignalError
from cytodisk.files import file_name
from cytodisk.images.file_parameters import SignalFileParameters
from cytodisk.images.frame_file import FrameFile
from cytodisk.images.sequences.movie_signals import open_movie_images, reopened
from cytodisk.images.signal_files import FrameSource
from cytodisk.store.inputs.input_hashes import described


class MeasuredStudy(Protocol):
    """What is asked of a study."""

    @property
    def path(self) -> Path: ...
    @property
    def cells(self) -> pd.DataFrame: ...
    @property
    def provenance(self) -> dict[str, Any]: ...

    def activity(self, cell: int) -> xr.Dataset: ...


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


def find_signal(study: MeasuredStudy) -> FoundSignal:
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
    path, name = Path(told["path"]), file_name(told["path"])
    places = [path] if path.is_absolute() else [path, study.path.parent / path, study.path / path]
    there = [place for place in places if place.exists()]
    if not there:
        return FoundSignal(None, f"{name} is not there any more")
    try:
        same = next((place for place in there if _hash_of(place, told) == told.get("sha256")), None)
        if same is None:
            return FoundSignal(None, f"{name} does not hold what was measured (its sha256 differs)")
        source = open_signal(study, same, list(told.get("files", ())))
    except (ReadError, OSError) as error:
        words = str(error)
        for place in there:
            words = words.replace(str(place), name)
        return FoundSignal(None, words)
    fault = misfit(study, source)
    return (
        FoundSignal(None, f"{name} is not the movie that was measured: it {fault}")
        if fault
        else FoundSignal(source)
    )


def open_signal(study: MeasuredStudy, path: Path, files: Sequence[str] = ()) -> FrameFile:
    """Open a movie's images as the study's were: with the same axes, scene, slice and channels.

    Parameters
    ----------
    study : Study
    path : Path
        A file; a folder or a pattern of files of one frame each.
    files : sequence of str
        Those of the folder, by frame, where they are known.

    Raises
    ------
    ReadError
        It cannot be read.
    """
    settings = study.provenance["parameters"]
    known = {name: settings[name] for name in SignalFileParameters.model_fields if name in settings}
    choice = SignalFileParameters.of(**known).signal_choice
    if files:
        return reopened(path, [path / name for name in files], choice)
    return open_movie_images(path, choice)


def shown_signal(study: MeasuredStudy, signal: FrameSource | None = None) -> FoundSignal:
    """The movie to show behind a study's windows: the one that is given, or else the one that it names.

    Parameters
    ----------
    study : Study
        Study of a movie.
    signal : FrameSource, optional

    Returns
    -------
    FoundSignal

    Raises
    ------
    SignalError
        The given one is not of the size of the study's masks, or has other channels or fewer frames.
    """
    if signal is None:
        return find_signal(study)
    fault = misfit(study, signal)
    if fault:
        raise SignalError(f"signal {fault}: pass the movie that was measured")
    return FoundSignal(signal)


def misfit(study: MeasuredStudy, source: FrameSource) -> str:
    """Why a movie cannot lie behind a study's windows, as "has …"; empty if it can."""
    (height, width), (mask_height, mask_width) = source.image_shape, study.provenance["image_shape"]
    if (height, width) != (mask_height, mask_width):
        return f"has images of {height} × {width} pixels, the study's masks have {mask_height} × {mask_width}"
    activity = study.activity(int(study.cells["cell"].iloc[0]))
    channels = activity.sizes["channel"] if "mean" in activity else 0
    last = int(study.cells["frame"].max())
    if len(source.channels) != channels or source.n_frames <= last:
        return (
            f"has {source.n_frames} frames of {len(source.channels)} channels, the study's has {channels} "
            f"channels and at least {last + 1} frames"
        )
    return ""


def _hash_of(path: Path, told: Mapping[str, Any]) -> str:
    files = [path / name for name in told.get("files", ())]
    return str(described(files or path)["sha256"])
