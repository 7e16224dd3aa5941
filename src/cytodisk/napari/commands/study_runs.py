"""What the commands map and movie do, on layers that are open: done in a thread, without a viewer."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from typing import Any

from cytodisk.errors import CytodiskError
from cytodisk.napari.commands.made_study import MadeStudy
from cytodisk.napari.forms.own_values import with_own
from cytodisk.napari.given.chosen_layers import ChosenLayers
from cytodisk.napari.given.given_layers import GivenFiles, given_files
from cytodisk.napari.work.background import Reporter
from cytodisk.napari.work.work_folder import WorkFolder
from cytodisk.parameters import Parameters
from cytodisk.runs.map.map_parameters import MapParameters
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.run_options import MapOptions, RunOptions
from cytodisk.runs.told.compiling_words import compiling_words, with_nuclei_or_not
from cytodisk.store.study import Study

_PICTURES = "images of layers"


def run_map(
    chosen: ChosenLayers, values: Mapping[str, Any], flags: Mapping[str, str], report: Reporter
) -> MadeStudy:
    """Map the cells of layers, as `cytodisk map` does.

    Parameters
    ----------
    chosen : ChosenLayers
    values : mapping
        Parameters and options that the user chose, by name.
    flags : mapping of str to str
        What messages call them.
    report : Reporter

    Returns
    -------
    MadeStudy
    """
    from cytodisk.runs.cells.cell_inputs import open_inputs
    from cytodisk.runs.map.map_study import map_study
    from cytodisk.runs.told.map_words import lost_cell_lines, map_fault, map_lines, signal_finding_lines

    def make(files: GivenFiles, given: Mapping[str, Any], work: WorkFolder) -> tuple[Study, list[str]]:
        parameters = with_own(MapParameters, given, flags)
        inputs = open_inputs(files.masks, files.signal, parameters, nuclei=files.nuclei)
        options = with_own(MapOptions, given, flags)
        return map_study(inputs, work.study, progress=report, **dict(options)), [
            *inputs.notes,
            *inputs.remarks,
        ]

    made = _made("map", chosen, values, report, make, "cells", MapParameters, MapOptions)
    made.lines = [*signal_finding_lines(made.study), *map_lines(made.study, of_folder=False)]
    made.losses = list(lost_cell_lines(made.study, of_folder=False))
    made.fault = map_fault(made.study, of_folder=False)
    return made


def run_movie(
    chosen: ChosenLayers, values: Mapping[str, Any], flags: Mapping[str, str], report: Reporter
) -> MadeStudy:
    """Follow the cells of layers, as `cytodisk movie` does; see `run_map`."""
    from cytodisk.runs.movie.movie_inputs import open_movie
    from cytodisk.runs.movie.movie_study import movie_study
    from cytodisk.runs.told.movie_words import finding_line, lost_frame_lines, movie_fault, movie_lines

    def make(files: GivenFiles, given: Mapping[str, Any], work: WorkFolder) -> tuple[Study, list[str]]:
        parameters = with_own(MovieParameters, given, flags)
        inputs = open_movie(files.masks, files.signal, parameters, nuclei=files.nuclei)
        options = with_own(RunOptions, given, flags)
        return movie_study(inputs, work.study, progress=report, **dict(options)), list(inputs.notes)

    made = _made("movie", chosen, values, report, make, "frames", MovieParameters, RunOptions)
    made.lines = [*list(finding_line(made.study))[:1], *movie_lines(made.study)]
    made.losses = list(lost_frame_lines(made.study))
    made.fault = movie_fault(made.study)
    return made


Make = Callable[[GivenFiles, Mapping[str, Any], WorkFolder], tuple[Study, list[str]]]


def _made(
    command: str,
    chosen: ChosenLayers,
    values: Mapping[str, Any],
    report: Reporter,
    make: Make,
    unit: str,
    *models: type[Parameters],
) -> MadeStudy:
    """A study out of layers; without one nothing of it is left."""
    from cytodisk.runs.qc_flags.study_flags import qc_flags

    work = WorkFolder()
    try:
        report.stage("Reading the layers", _PICTURES)
        files = given_files(chosen, work.inputs, values, report)
        known = {name for model in models for name in model.model_fields}
        given = {name: one for name, one in files.values.items() if name in known} | dict(values)
        kind = with_nuclei_or_not(command, files.nuclei)
        report.stage(compiling_words(kind) or "Opening the files", unit)
        study, notes = make(files, given, work)
        report.stage("Looking for QC flags")
        return MadeStudy(command, study, work, files, given, warnings=notes, flags=qc_flags(study))
    except CytodiskError as error:
        work.remove()
        raise type(error)(_by_name(error, work)) from error
    except BaseException:
        work.remove()
        raise


def _by_name(error: CytodiskError, work: WorkFolder) -> str:
    """What an error says, where layers that were written are called by their names alone."""
    return str(error).replace(f"{work.inputs}{os.sep}", "")
