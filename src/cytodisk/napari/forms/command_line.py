"""What one types in a terminal for what a widget does."""

from __future__ import annotations

import os
import shlex
import subprocess
from collections.abc import Mapping, Sequence
from typing import Any

from cytodisk.napari.forms.editors import text_of
from cytodisk.parameter_words import flag_of, kinds, tuple_items
from cytodisk.parameters import Parameters
from cytodisk.runs.cells.cell_parameters import CheckParameters
from cytodisk.runs.correlate.correlate_parameters import CorrelateParameters
from cytodisk.runs.map.map_parameters import MapParameters
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.run_options import MapOptions, RunOptions, TableOptions
from cytodisk.taking import fields_of

MODELS: dict[str, tuple[type[Parameters], ...]] = {
    "check": (CheckParameters,),
    "map": (MapParameters, MapOptions),
    "movie": (MovieParameters, RunOptions),
    "correlate": (CorrelateParameters, TableOptions),
}
"""The models of commands, whose fields are their flags."""


def command_line(command: str, arguments: Sequence[str | os.PathLike[str]], values: Mapping[str, Any]) -> str:
    """The line for a shell that runs a command with these parameters.

    Parameters
    ----------
    command : {"check", "map", "movie", "correlate"}
    arguments : sequence of str or path-like
        Files and what has a flag without a model, as ("masks.tif", "--signal", "image.tif").
    values : mapping
        Parameters by name, as `ParameterForm.values` gives them.

    Returns
    -------
    str
        Quoted for the shell of this system.

    Examples
    --------
    >>> from cytodisk.napari.forms.command_line import command_line
    >>> command_line("map", ["cells.tif", "-o", "out"], {"layers": 8, "depth_um": (0.5, 1.0), "maps": False})
    'cytodisk map cells.tif -o out --layers 8 --depth-um 0.5,1 --no-maps'
    """
    fields = fields_of(MODELS[command])
    words = ["cytodisk", command, *(os.fspath(one) for one in arguments)]
    for name, value in values.items():
        words += _option(fields[name], flag_of(name, fields[name]), value)
    return subprocess.list2cmdline(words) if os.name == "nt" else shlex.join(words)


def _option(field: Any, flag: str, value: Any) -> list[str]:
    if isinstance(value, bool):
        return [flag if value else f"--no-{flag.removeprefix('--')}"]
    text = text_of(value)
    if tuple in kinds(field.annotation) and tuple_items(field.annotation) == (int, int):
        text = text.replace(",", ":")
    return [f"{flag}={text}"] if text.startswith("-") else [flag, text]
