"""Pooled correlations, predictions and waves on the page of a batch."""

from __future__ import annotations

import base64
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from cytodisk.errors import CytodiskError
from cytodisk.store.correlation_store import list_correlations, titled
from cytodisk.store.populations.pooled_correlation import PooledCorrelation, open_pooled_correlation
from cytodisk.store.populations.pooled_prediction import PooledPrediction, open_pooled_prediction
from cytodisk.store.populations.pooled_waves import PooledWaves, open_pooled_waves
from cytodisk.store.predictions.prediction_store import list_predictions, titled_prediction
from cytodisk.store.study_kind import FIGURES
from cytodisk.store.waves.waves_store import list_waves, waves_title

Pooled = PooledCorrelation | PooledPrediction | PooledWaves


class _Kind(NamedTuple):
    """One kind of pooled result.

    Attributes
    ----------
    names : callable
        Names of those in a folder.
    title, opened : callable
    picture, alt, remark : str
        Name of the figure, what it shows, and what stands below the sentences.
    """

    names: Callable[[Path], Iterable[tuple[str, ...]]]
    title: Callable[..., str]
    opened: Callable[..., Pooled]
    picture: str
    alt: str
    remark: str


_KINDS = (
    _Kind(
        list_correlations,
        titled,
        open_pooled_correlation,
        "curves.png",
        "Correlation against lag by layer: cells, experiments and the mean of each condition",
        "Positive lag: the signal comes first. Tables: correlation/ in the folder of the batch.",
    ),
    _Kind(
        list_predictions,
        lambda *names: f"Prediction: {titled_prediction(*names)}",
        open_pooled_prediction,
        "gains.png",
        "Gain by layer of each link: experiments and the mean of each condition",
        "Gain beyond chance: ln of the error without over that with the source's past, less what shifted "
        "sources give. Tables: prediction/ in the folder of the batch.",
    ),
    _Kind(
        list_waves,
        lambda *names: f"Waves of {waves_title(*names)}",
        open_pooled_waves,
        "waves.png",
        "Order, speed, period and persistence of waves: cells, experiments and the mean of each condition",
        "Order: 0 on average where there are no waves. Speed, period and persistence: of cells with a wave. "
        "Tables: waves/ in the folder of the batch.",
    ),
)


def pooled_results(folder: Path) -> list[dict[str, Any]]:
    """What was pooled over all movies of a batch.

    Parameters
    ----------
    folder : Path

    Returns
    -------
    list of dict
        title, sentences, picture (a data URL; empty where it was not drawn as PNG), alt and remark.
    """
    return [_of_names(folder, kind, names) for kind in _KINDS for names in kind.names(folder)]


def _of_names(folder: Path, kind: _Kind, names: tuple[str, ...]) -> dict[str, Any]:
    told = {"title": kind.title(*names), "alt": kind.alt, "remark": kind.remark, "picture": ""}
    try:
        found = kind.opened(folder, *names)
        return told | {"sentences": list(_sentences(found)), "picture": _picture(found, kind.picture)}
    except CytodiskError as error:
        return told | {"sentences": [str(error)]}


def _sentences(found: Pooled) -> Iterator[str]:
    yield from found.sentences
    for one in found.warnings:
        yield f"Warning: {one['name']}: {one['finding']} {one['consequence']} {one['remedy']}"


def _picture(found: Pooled, name: str) -> str:
    path = found.path / FIGURES / name
    if not path.is_file():
        return ""
    return f"data:image/png;base64,{base64.b64encode(path.read_bytes()).decode('ascii')}"
