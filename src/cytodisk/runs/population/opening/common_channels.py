"""The channels that all studies have."""

from __future__ import annotations

import shlex
from collections.abc import Sequence

from cytodisk.errors import PopulationError
from cytodisk.images.short_lists import shortened
from cytodisk.runs.population.opening.alike_settings import command_of_study
from cytodisk.runs.population.opening.found_studies import FoundStudy
from cytodisk.runs.population.opening.map_values import window_table


def chosen_channels(studies: Sequence[FoundStudy], channels: Sequence[str] | None) -> list[str]:
    """Names of the channels to read.

    Parameters
    ----------
    studies : sequence of FoundStudy
    channels : sequence of str, optional
        By default those of the first study.

    Returns
    -------
    list of str

    Raises
    ------
    PopulationError
        A study has no signal, or lacks a channel; the message names it, and the channels that all have.
    """
    there = {study.name: window_table(study).channels() for study in studies}
    if without := [study for study in studies if not there[study.name]]:
        names = shortened([study.name for study in without])
        raise PopulationError(
            f"no signal in {names}: run {command_of_study(without[0])} with --signal; shapes alone are "
            "compared by cytodisk shapes"
        )
    if isinstance(channels, str):
        raise PopulationError(f"channels must be a list of names, got {channels!r}: write [{channels!r}]")
    wanted = list(dict.fromkeys(name for names in there.values() for name in names))
    wanted = wanted if channels is None else list(dict.fromkeys(channels))
    if not wanted:
        raise PopulationError("channels is an empty list: leave it out for all channels, or name some")
    for name in wanted:
        lacking = [study for study, names in there.items() if name not in names]
        if lacking:
            raise PopulationError(_lacking_words(name, lacking, there))
    return wanted


def _lacking_words(name: str, lacking: Sequence[str], there: dict[str, list[str]]) -> str:
    if len(lacking) == len(there):
        every = ", ".join(dict.fromkeys(one for names in there.values() for one in names))
        return f"channel {name!r} is in no study: they have {every}"
    common = [one for one in next(iter(there.values())) if all(one in names for names in there.values())]
    has = f"{lacking[0]} has {', '.join(there[lacking[0]])}"
    if common:
        flag = f"--channel {shlex.quote(','.join(common))}"
        remedy = f"all have {', '.join(common)}: pass {flag}, in Python channels={common!r}"
    else:
        remedy = "no channel is in all: name them alike with --channels, and run the studies again"
    return f"channel {name!r} is missing in {shortened(lacking)} ({has}); {remedy}"
