"""The masks of open layers, looked at as `cytodisk check` looks at files."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cytodisk.images.mask_files import list_images
from cytodisk.napari.check.found_flags import FlagPlace, FoundFlag
from cytodisk.napari.given.chosen_layers import ChosenLayers
from cytodisk.napari.given.given_layers import GivenFiles, given_files
from cytodisk.napari.work.background import Reporter
from cytodisk.number_words import counted
from cytodisk.runs.cells.cell_inputs import open_inputs
from cytodisk.runs.cells.cell_parameters import CheckParameters
from cytodisk.runs.map.checked_cells import check_cells
from cytodisk.runs.told.checked_words import Checked
from cytodisk.runs.told.mask_faults import FaultPlace, MaskFault

_FOLLOW = 'the widget "Follow cells"'


@dataclass(frozen=True)
class CheckedLayers:
    """What was found.

    Attributes
    ----------
    flags : list of FoundFlag
        The gravest first.
    lines : tuple of str
        On all masks together.
    notes : tuple of str
        What a user should know of the layers and their files.
    files : GivenFiles
    values : dict of str to object
        Parameters of the command.
    """

    flags: list[FoundFlag]
    lines: tuple[str, ...]
    notes: tuple[str, ...]
    files: GivenFiles
    values: dict[str, Any]


def check_layers(
    chosen: ChosenLayers, folder: Path, values: Mapping[str, Any], flags: Mapping[str, str], report: Reporter
) -> CheckedLayers:
    """Look at the masks of layers.

    Parameters
    ----------
    chosen : ChosenLayers
    folder : Path
        Where layers are written that have no file.
    values : mapping of str to object
        Parameters that the user typed.
    flags : mapping of str to str
        What parameters are called in messages.
    report : Reporter
        Called with what is done.

    Returns
    -------
    CheckedLayers

    Raises
    ------
    ReadError, MaskError, SignalError, NucleusError, ParameterError
        Layers cannot be used, or not together.
    """
    report.stage("Reading the layers", "images")
    files = given_files(chosen, folder, values, report)
    told = {name: value for name, value in files.values.items() if name in CheckParameters.model_fields}
    every = {**told, **values}
    parameters = CheckParameters.called(every, flags)
    inputs = open_inputs(files.masks, files.signal, parameters, nuclei=files.nuclei)
    images = list_images(inputs.sources)
    is_stack = inputs.sources[0].kind == "stack"
    report.stage("Looking at the masks", "frames" if is_stack else "cells")
    found, total = Checked(inputs), sum(image.n_cells for image in images)
    for number, checked in enumerate(check_cells(inputs), start=1):
        found.add(checked)
        report(number, total)
    notes = (*files.notes, *inputs.notes, *inputs.remarks)
    flags_found = [_flag(fault, is_stack) for fault in _of_all_labels(found.faults_found())]
    return CheckedLayers(flags_found, tuple(found.totals(follow=_FOLLOW)), notes, files, every)


def _of_all_labels(faults: Sequence[MaskFault]) -> list[MaskFault]:
    """Faults, of which those between frames come once for all labels."""
    kept: dict[str, MaskFault] = {}
    found = []
    for fault in faults:
        if fault.name in kept:
            kept[fault.name].places.extend(fault.places)
            continue
        found.append(fault)
        if fault.is_between_frames:
            kept[fault.name] = fault
    return found


def _flag(fault: MaskFault, is_stack: bool) -> FoundFlag:
    places = tuple(_place(one, is_stack) for one in fault.places)
    if fault.is_between_frames:
        what = fault.words.removeprefix(f"{fault.name}: ").partition(" (")[0]
        what = re.sub(r" of label \d+", "", what)
        where = counted(len(places), "frame")
        return FoundFlag(fault.name, f"{what} in {where}", fault.advice, fault.meaning, places)
    more = ", and the like" if fault.differs else ""
    where = counted(len(places), "frame" if is_stack else "cell")
    return FoundFlag(fault.kind, f"{where}: {fault.words}{more}", fault.advice, fault.meaning, places)


def _place(place: FaultPlace, is_stack: bool) -> FlagPlace:
    cell = "" if is_stack or not place.label else str(place.label)
    return FlagPlace(place.frame, cell, place.words, place.yx)


def command_words(files: GivenFiles, chosen: Sequence[tuple[str, Path | None]]) -> list[str]:
    """Files of a command as one types them: the masks, then the others behind their flags."""
    return [str(files.masks), *(word for flag, path in chosen if path for word in (flag, str(path)))]
