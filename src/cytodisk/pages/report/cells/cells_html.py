"""The page of a study of single cells."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from cytodisk.errors import ParameterError
from cytodisk.files import real_path
from cytodisk.pages.report.cells.cell_pictures import CellPictures, means_limits, size_of
from cytodisk.pages.report.cells.cell_table import CONDITION, EXPERIMENT, listed_cells
from cytodisk.pages.report.cells.cells_words import (
    cell_names,
    facts,
    flag_words,
    groups_words,
    left_out,
    lost_groups,
)
from cytodisk.pages.report.cells.window_numbers import WindowNumbers, window_numbers
from cytodisk.pages.report.encode import json_for_script
from cytodisk.pages.report.listed import rows_words
from cytodisk.pages.report.palettes import palette
from cytodisk.pages.report.pictures import OUTSIDE
from cytodisk.pages.report.provenance_words import input_words, run_words, value_words, version_of
from cytodisk.pages.report.template import jinja, rendered
from cytodisk.plot.layer_looks import layer_place
from cytodisk.plot.style import SIGNAL_COLOURS, signal_limits
from cytodisk.runs.channel_names import shown_name
from cytodisk.runs.depth_layers import layer_borders
from cytodisk.runs.findings.cells_finding import cells_finding
from cytodisk.runs.map.input_files import FoundInputs, find_inputs
from cytodisk.runs.qc_flags.study_flags import qc_flags
from cytodisk.store.provenance_file import other_maps, writer_of
from cytodisk.store.study import Study
from cytodisk.windows.polar_windows import PolarGrid
from cytodisk.windows.study_grid import polar_grid_of

MOST_CELLS = 400
"""With a picture on one page."""
MOST_BYTES = 12_000_000
"""Of all pictures together, as text."""

_BYTES_A_CELL, _BYTES_A_WINDOW = 12_000, 5  # about, to know beforehand how many cells there is room for
_SCRIPTS = ("decode", "elements", "numbers", "disk", "pixels", "frame", "list", "cell", "cells")

Progress = Callable[[int, int], None]


def cells_page(
    study: Study,
    first: int = 0,
    *,
    found: FoundInputs | None = None,
    most: int = MOST_CELLS,
    progress: Progress | None = None,
) -> str:
    """The page of a study of single cells, as text.

    Parameters
    ----------
    study : Study
    first : int
        The first cell with a picture.
    found : FoundInputs, optional
        Masks and images of the study; by default those that it names.
    most : int
        How many cells have a picture, at most.
    progress : callable, optional
        Called with the number of cells done and that of all.

    Returns
    -------
    str

    Raises
    ------
    ParameterError
        The study has no such cell, or a page cannot hold so many windows.
    MissingPartError
        Jinja2 is not installed.
    """
    jinja()  # before any work is done
    grid = polar_grid_of(study.provenance)
    _check(study, first, grid)
    found = find_inputs(study) if found is None else found
    wanted = [int(cell) for cell in study.cells.loc[study.cells["label"] != 0, "cell"] if cell >= first]
    room = MOST_BYTES // (_BYTES_A_CELL + _BYTES_A_WINDOW * grid.n_windows)
    chosen = wanted[: max(1, min(most, room))]
    numbers = window_numbers(study, chosen, grid.n_windows)
    maker = CellPictures(study, found.inputs, numbers)
    pictures = _within_bytes(maker, chosen, progress)
    data = _data(study, grid, numbers, pictures)
    flags = qc_flags(study)
    finding = cells_finding(study, flags)
    words = {
        "title": real_path(study.path).name,
        "facts": list(facts(study)),
        "finding": list(finding.sentences),
        "groups": groups_words(study),
        "command": finding.command,
        "lost": lost_groups(study),
        "flags": [*_earlier(study), *flag_words(flags, study)],
        "left_out": [
            *left_out(study, list(pictures), wanted, found.fault, len(maker.mapped)),
            *filter(None, [rows_words(study.cells, "cells.parquet")]),
        ],
        "settings": list(_settings(study)),
        "version": version_of(study.provenance),
        "data": data,
        "texts": [("data", json_for_script(data)), ("pictures", json_for_script(list(pictures.values())))],
    }
    return rendered("cells", ["page", "cells"], _SCRIPTS, words)


def _check(study: Study, first: int, grid: PolarGrid) -> None:
    if not (study.cells["cell"] == first).any():
        raise ParameterError(
            f"cell must be a number of the study's {len(study.cells)} cells from 0, got {first}"
        )
    if grid.n_windows >= OUTSIDE:
        raise ParameterError(
            f"study {study.path} has {grid.n_windows} windows a cell, a page holds fewer than {OUTSIDE}: "
            "run it with fewer layers or sectors"
        )


def _within_bytes(
    maker: CellPictures, cells: Sequence[int], progress: Progress | None
) -> dict[int, dict[str, Any] | None]:
    """Pictures by cell, as many as there is room for; None of a cell without anything to show."""
    pictures: dict[int, dict[str, Any] | None] = {}
    size = 0
    for cell, picture in maker.of(cells, progress):
        size += size_of(picture)
        if size > MOST_BYTES and pictures:
            break
        pictures[cell] = picture
    return pictures


def _data(
    study: Study, grid: PolarGrid, numbers: WindowNumbers, pictures: dict[int, dict[str, Any] | None]
) -> dict[str, Any]:
    """What the scripts need to know beside the pictures."""
    outer = grid.cytoplasm_layers if grid.nucleus_layers else None
    unit = study.cells.attrs["units"]
    return {
        "folder": shlex.quote(str(study.path)),
        "table": listed_cells(study, numbers),
        "names": {str(cell): name for cell, name in cell_names(study.cells).items()},
        "pictured": list(pictures),
        "group_columns": [name for name in (CONDITION, EXPERIMENT) if name in study.cells],
        "channels": [
            {"name": shown_name(name), "full": name, "unit": "a.u.", "limits": signal_limits(means)}
            for name, means in zip(numbers.channels, means_limits(numbers), strict=True)
        ],
        "layers": grid.layers,
        "sectors": grid.sectors,
        "radii": grid.radii.tolist() if grid.has_radii else None,
        "cytoplasm_layers": outer,
        "layer_places": [layer_place(layer, grid.layers, outer) for layer in range(grid.layers)],
        "layer_borders": layer_borders(grid),
        "pixel_size_um": study.scale.pixel_size_um,
        "units": {"area": unit.get("area", "px²"), "depth": study.scale.length_unit},
        "palette": palette(SIGNAL_COLOURS),
    }


def _earlier(study: Study) -> list[dict[str, Any]]:
    if not other_maps(study.provenance):
        return []
    return [
        {
            "name": "earlier maps",
            "what": f"the maps were made by {writer_of(study.provenance)}",
            "meaning": "Windows lie at other places than in studies made now.",
            "advice": "Do not compare window by window with those; run cytodisk map again where you must.",
            "cells": [],
            "count": 0,
        }
    ]


def _settings(study: Study) -> Iterator[tuple[str, str]]:
    told = study.provenance
    yield from input_words(told)
    for name, value in told.get("parameters", {}).items():
        yield name, "not set" if value is None else value_words(value)
    yield from run_words(told)
