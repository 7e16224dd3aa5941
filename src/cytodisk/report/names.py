"""Names of channels, correlations and files, and what sets correlations apart, in the page's words."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict
from pathlib import PureWindowsPath
from typing import Any

from cytodisk.io.study import Study
from cytodisk.study.correlation_settings import CorrelationSettings

_UNTOLD = frozenset(
    {"signal", "with", "name", "unit", "cytodisk", "max_lag", "detrend_frames", "seed", "pairs"}
)
"""Settings that the page shows elsewhere, or that change no number that it shows."""


def shown_name(name: str) -> str:
    """Name of a channel: files without names number them."""
    return f"channel {name}" if name.isdigit() else name


def correlation_name(names: Sequence[str]) -> str:
    """Words for a correlation.

    Parameters
    ----------
    names : sequence of str
        Signal, what it was correlated with, and the name of a variant if it has one, as an item of
        `Study.correlations`.

    Returns
    -------
    str
        As "edge with velocity (early frames)".
    """
    signal, with_, *variant = names
    words = f"{shown_name(signal)} with {shown_name(with_)}"
    return f"{words} ({variant[0]})" if variant and variant[0] else words


def labels_of(correlations: Sequence[tuple[Sequence[str], Mapping[str, Any]]]) -> list[str]:
    """Labels of correlations to choose from, each its own.

    Parameters
    ----------
    correlations : sequence of (names, settings)

    Returns
    -------
    list of str
        Those of the same names are told apart by their settings.
    """
    labels = []
    for names, settings in correlations:
        words = correlation_name(names)
        alike = [other for other, _ in correlations if tuple(other[:2]) == tuple(names[:2])]
        differs = differences(settings) if len(alike) > 1 else ""
        labels.append(f"{words}: {differs}" if differs else words)
    return labels


def differences(settings: Mapping[str, Any]) -> str:
    """What in a correlation's settings is not the default.

    Parameters
    ----------
    settings : dict
        As in settings.json.

    Returns
    -------
    str
        As "linear detrending, without lags −1, 0"; empty if all is the default.
    """
    return ", ".join(_differences(settings))


def _differences(settings: Mapping[str, Any]) -> Iterator[str]:
    usual = asdict(CorrelationSettings())
    for name, value in settings.items():
        default = usual.get(name)
        if (
            name in _UNTOLD
            or value == default
            or value in (None, [], {})
            or _as_list(value) == _as_list(default)
        ):
            continue
        words = _WORDS.get(name, lambda value, _, name=name: f"{name.replace('_', ' ')} {_listed(value)}")
        yield words(value, settings)


def _detrending(value: Any, settings: Mapping[str, Any]) -> str:
    frames = settings.get("detrend_frames")
    if value != "median":
        return f"{value} detrending"
    return "moving median taken out" + (f" ({frames} frames)" if frames else "")


_WORDS: dict[str, Callable[[Any, Mapping[str, Any]], str]] = {
    "detrend": _detrending,
    "difference": lambda value, _: "changes between frames",
    "skip_lags": lambda value, _: f"without lags {_listed(value)}",
    "rule": lambda value, _: f"{value} peak",
    "against": lambda value, _: f"against the {value}",
    "sectors": lambda value, _: f"sectors {_listed(value)}",
    "cells": lambda value, _: f"cells {_listed(value)}",
    "frames": lambda value, _: f"frames {_listed(value)}",
    "without_frames": lambda value, _: f"without frames {_listed(value)}",
    "min_pairs": lambda value, _: f"{value} frames a lag at least",
    "surrogates": lambda value, _: f"{value} surrogates" if value else "no surrogates",
    "null": lambda value, _: f"chance by {value}",
}


def file_name(path: str) -> str:
    """Last part of a path of any system: folders are nobody's business but the owner's."""
    return PureWindowsPath(path).name or path


def without_folders(text: str, study: Study) -> str:
    """A reason or warning with file names in place of the paths of the run's inputs."""
    for told in study.provenance.get("inputs", {}).values():
        text = text.replace(told["path"], file_name(told["path"]))
    return text


def _as_list(value: Any) -> Any:
    return list(value) if isinstance(value, tuple) else value


def _listed(value: Any) -> str:
    """Numbers with runs drawn together, as "3–9, 12"; other values as they are."""
    if not isinstance(value, list | tuple):
        return str(value).replace("-", "−") if isinstance(value, int | float) else str(value)
    if not all(isinstance(item, int) for item in value):
        return ", ".join(str(item) for item in value)
    runs: list[list[int]] = []
    for item in value:
        if runs and item == runs[-1][-1] + 1:
            runs[-1].append(item)
        else:
            runs.append([item])
    return ", ".join(text for run in runs for text in _run(run))


def _run(run: list[int]) -> list[str]:
    """Two numbers, or those below 0, in full; more as a range."""
    if len(run) > 2 and run[0] >= 0:
        return [f"{run[0]}–{run[-1]}"]
    return [str(item).replace("-", "−") for item in run]
