"""Commands that do a run or a correlation again in another way, whole, to be pasted into a terminal."""

from __future__ import annotations

import os
import shlex
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from cytodisk.runs.qc_flags.qc_flag import Place
from cytodisk.store.study import Study
from cytodisk.store.study_kind import PARAMETERS
from cytodisk.store.window_blocks import window_blocks

_LONGEST_NAME = 60
_MOST_LEFT_OUT = 0.25  # of the frames of a movie: more leave no series
_RANGES = ("frames", "sectors")
_WITHOUT = "without_jumps"


def correlate_again(study: Study, names: Sequence[str], variant: str, **changes: Any) -> str:
    """The command that correlates again in another way, beside what is there.

    Parameters
    ----------
    study : Study
    names : sequence of str
        Signal, what it was correlated with, and the name of a variant, as of `Study.correlations`.
    variant : str
        Name of the new one.
    **changes
        Parameters of `cytodisk correlate`. All others stay as they were given.

    Returns
    -------
    str
        As "cytodisk correlate out --signal Rac1 --with velocity --skip-lags=-1,0 --name without_jitter".
    """
    signal, with_, *own = names
    settings = study.correlation(*names).settings if tuple(names) in study.correlations else {}
    given = dict(settings.get("given") or {})
    given.pop("name", None)
    cells = [f"--cell={cell}" for cell in settings.get("cells") or ()]
    called = "_".join(filter(None, [*own, variant]))[:_LONGEST_NAME]
    words = ["cytodisk", "correlate", shown_path(str(study.path)), "--signal", signal, "--with", with_]
    return shlex.join([*words, *cells, *_flags(given | changes), "--name", called])


def predict_again(study: Study, names: Sequence[str], variant: str, **changes: Any) -> str:
    """The command that tests a prediction again in another way, beside what is there.

    Parameters
    ----------
    study : Study
    names : sequence of str
        Source, target and the name of a variant, as of `Study.predictions`; none for a network.
    variant : str
        Name of the new one.
    **changes
        Parameters of `cytodisk predict`. All others stay as they were given.

    Returns
    -------
    str
        As "cytodisk predict out --source Rac1 --target velocity --given RhoA --name given".
    """
    source, target, *own = (*names, "", "")[:3] if len(names) < 3 else names
    settings = study.prediction(*names).settings if tuple(names) in study.predictions else {}
    asked = dict(settings.get("asked") or {})
    asked.pop("name", None)
    cells = [f"--cell={cell}" for cell in settings.get("cells") or ()]
    called = "_".join(filter(None, [*own, variant]))[:_LONGEST_NAME]
    words = ["cytodisk", "predict", shown_path(str(study.path))]
    words += ["--source", source, "--target", target] if source else []
    return shlex.join([*words, *cells, *_flags(asked | changes), "--name", called])


def waves_again(study: Study, names: Sequence[str], variant: str, **changes: Any) -> str:
    """The command that looks for waves again in another way, beside what is there.

    Parameters
    ----------
    study : Study
    names : sequence of str
        The signal and the name of a variant, as of `Study.wave_signals`.
    variant : str
        Name of the new one.
    **changes
        Parameters of `cytodisk waves`. All others stay as they were given.

    Returns
    -------
    str
        As "cytodisk waves out --signal Rac1 --without-frames 12,13 --name without_jumps".
    """
    signal, *own = names
    settings = study.waves(*names).settings
    given = dict(settings.get("given") or {})
    given.pop("name", None)
    cells = [f"--cell={cell}" for cell in settings.get("cells") or ()]
    called = "_".join(filter(None, [*own, variant]))[:_LONGEST_NAME]
    words = ["cytodisk", "waves", shown_path(str(study.path)), "--signal", signal]
    return shlex.join([*words, *cells, *_flags(given | changes), "--name", called])


def correlate_command(study: Study, signal: str) -> str:
    """The command that correlates a channel with the edge, as "cytodisk correlate out --signal Rac1"."""
    return shlex.join(["cytodisk", "correlate", shown_path(str(study.path)), "--signal", signal])


def run_again(study: Study, suffix: str, **changes: Any) -> str:
    """The command that makes a study again in another way, beside what is there.

    Parameters
    ----------
    study : Study
    suffix : str
        Behind the name of the new folder.
    **changes
        Parameters of the command. All others stay as they were.

    Returns
    -------
    str
        As "cytodisk movie masks.tif --parameters out/parameters.toml --sectors 48 -o out_48".
    """
    inputs = study.provenance.get("inputs", {})
    told = {role: inputs.get(role, {}) for role in ("masks", "signal", "nuclei")}
    paths = {role: one.get("given") or one.get("path") for role, one in told.items()}
    masks = _from_here(study, paths.pop("masks") or "masks.tif")
    words = ["cytodisk", "movie" if study.is_movie else "map", masks]
    words += [word for role, path in paths.items() if path for word in (f"--{role}", _from_here(study, path))]
    words += ["--parameters", shown_path(str(study.path / PARAMETERS))]
    return shlex.join([*words, *_flags(changes), "-o", f"{shown_path(str(study.path))}_{suffix}"])


def without_frames(study: Study, places: Iterable[Place], after: int = 0) -> str:
    """How to do without the frames of a flag what was done with them.

    Parameters
    ----------
    study : Study
    places : iterable of Place
        Frames of all cells are left out of all.
    after : int
        The wrong mask may also be so many frames later.

    Returns
    -------
    str
        A command for the first correlation, the first prediction and the first waves, of those there are;
        of a study without any for the correlation of its first channel. Empty without a signal then, or
        where more than a quarter of the movie would be left out.
    """
    frames = sorted(
        {place.frame + k for place in places if place.frame is not None for k in range(after + 1)}
    )
    if len(frames) > _MOST_LEFT_OUT * study.cells["frame"].nunique():
        return ""
    again = list(_without(study, frames))
    return f" Or leave these frames out: {'; '.join(again)}" if again else ""


def _first_channel(study: Study) -> str | None:
    blocks = (block["channel"].dropna() for block in window_blocks(study, "channel"))
    return next((str(channels.iloc[0]) for channels in blocks if not channels.empty), None)


def _without(study: Study, frames: Sequence[int]) -> Iterator[str]:
    """Commands without frames, and without those that were left out before."""
    made = (
        (correlate_again, study.correlation, study.correlations),
        (predict_again, study.prediction, study.predictions),
        (waves_again, study.waves, study.wave_signals),
    )
    done = [(again, opened, there[0]) for again, opened, there in made if there]
    for again, opened, names in done:
        earlier = opened(*names).settings.get("without_frames") or ()
        yield again(study, names, _WITHOUT, without_frames=sorted({*frames, *earlier}))
    if not done and (channel := _first_channel(study)) is not None:
        yield correlate_again(study, (channel, "velocity"), _WITHOUT, without_frames=list(frames))


def shown_path(path: str) -> str:
    """A path as it was given, or from the working folder if that is shorter."""
    try:
        near = os.path.relpath(path)
    except ValueError:  # on another drive
        return path
    return near if len(near) < len(path) else path


def _from_here(study: Study, path: str) -> str:
    """The path of an input, which lies in the study itself if napari saved it."""
    inside = study.path / path  # an absolute path stays
    return shown_path(str(inside) if inside.exists() else path)


def _flags(values: Mapping[str, Any]) -> list[str]:
    return [word for name, value in values.items() if value is not None for word in _flag(name, value)]


def _flag(name: str, value: Any) -> list[str]:
    flag = name.replace("_", "-")
    if isinstance(value, bool):
        return [f"--{flag}" if value else f"--no-{flag}"]
    if isinstance(value, (list, tuple)):
        value = (":" if name in _RANGES else ",").join(str(item) for item in value)
    text = str(value)
    return [f"--{flag}={text}"] if text.startswith("-") else [f"--{flag}", text]
