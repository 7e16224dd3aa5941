"""Names of channels, correlations and files, and what sets correlations apart, in the page's words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from cytodisk.files import file_name
from cytodisk.pages.settings_words import settings_words
from cytodisk.runs.channel_names import correlation_name, shortened
from cytodisk.store.study import Study

_LONGEST_NAME = 24  # letters of a channel in the label of a correlation


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
        words = correlation_name([shortened(name, _LONGEST_NAME) for name in names[:2]] + list(names[2:]))
        alike = [other for other, _ in correlations if tuple(other[:2]) == tuple(names[:2])]
        differs = differences({**settings, "name": ""}) if len(alike) > 1 else ""
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
    facts = settings_words(settings)
    if settings.get("against", "window") != "window":
        facts.append(f"against the {settings['against']}")
    return ", ".join(facts)


def without_folders(text: str, study: Study) -> str:
    """A reason or warning with file names in place of the paths of the run's inputs."""
    for told in study.provenance.get("inputs", {}).values():
        text = text.replace(told["path"], file_name(told["path"]))
    return text
