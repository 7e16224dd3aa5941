"""What a batch would take for the scale, the channels and the parameters of an input."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

import pandas as pd

from cytodisk.errors import CytodiskError
from cytodisk.images.chosen_channels import with_names
from cytodisk.runs.batch.batch_file import Batch
from cytodisk.runs.batch.batch_file_rows import SCALE
from cytodisk.runs.batch.batch_groups import masks_of
from cytodisk.runs.batch.batch_input import BatchInput
from cytodisk.runs.cells.cell_groups import cells_of
from cytodisk.runs.cells.cell_inputs import CellInputs, open_inputs
from cytodisk.runs.depth_layers import check_depths
from cytodisk.runs.groups.groups import Groups
from cytodisk.runs.map.map_parameters import WindowsOfMapsParameters
from cytodisk.runs.movie.movie_inputs import open_movie_files
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.parameters_file import toml_lines
from cytodisk.scale import Scale
from cytodisk.windows.grid_parameters import PolarGridParameters
from cytodisk.windows.polar_windows import PolarGrid, polar_grid

_APART = ("layers", "sectors", *SCALE)  # what has a column of its own


@dataclass(frozen=True)
class Understood:
    """An input as it is understood; its fields are columns of a dry run.

    Attributes
    ----------
    frames : int or None
        Number of frames of the mask file; None for images, and where a file cannot be used.
    pixel_size_um, frame_interval_s : float or None
        As given, or else as the files say.
    channels : str
        Names of the signal's channels.
    layers : int
        One more than there are depths where `depth_um` takes their place.
    sectors : int
    parameters : str
        Others that are not the default ones, as TOML.
    fault : str
        Why the files cannot be used; empty if they can, as far as that is known without any work.
    """

    frames: int | None
    pixel_size_um: float | None
    frame_interval_s: float | None
    channels: str
    layers: int
    sectors: int
    parameters: str
    fault: str = ""


def understand(item: BatchInput) -> Understood:
    """Look at the files of an input without running it.

    Parameters
    ----------
    item : BatchInput

    Returns
    -------
    Understood
    """
    parameters = item.parameters
    own = parameters if isinstance(parameters, MovieParameters) else None
    given = Understood(
        frames=None,
        pixel_size_um=parameters.pixel_size_um,
        frame_interval_s=own.frame_interval_s if own else None,
        channels=_together(parameters.channels or ()),
        layers=_grid(parameters).layers,
        sectors=parameters.sectors,
        parameters=_together(toml_lines(_not_default(parameters))),
    )
    try:
        return _with_files(given, item)
    except CytodiskError as error:
        return replace(given, fault=str(error))


def _with_files(given: Understood, item: BatchInput) -> Understood:
    if isinstance(item.parameters, MovieParameters):
        files = open_movie_files(item.masks, item.signal, item.parameters, item.nuclei)
        given = replace(given, frames=files.masks.n_frames, frame_interval_s=files.scale.frame_interval_s)
        signal, pixel_size_um = files.signal, files.scale.pixel_size_um
        if signal is not None:
            signal = with_names(signal, item.signal_name)
    else:
        inputs = _opened(item)
        signal, pixel_size_um = next(iter(inputs.signal_files), None), inputs.scale.pixel_size_um
    check_depths(_grid(item.parameters), Scale(pixel_size_um))
    channels = signal.channels if signal is not None else ()
    return replace(given, pixel_size_um=pixel_size_um, channels=_together(channels))


def refuse_groups(batch: Batch) -> tuple[str, ...]:
    """Compare the table of groups of a batch with the cells of its images, not with labels of movies.

    Parameters
    ----------
    batch : Batch

    Returns
    -------
    tuple of str
        What a user should know, where all inputs are images.

    Raises
    ------
    ParameterError
        The table does not fit.
    """
    if batch.groups is None:
        return ()
    parts = [_cells(item, batch.groups) for item in batch.inputs]
    cells = pd.concat(parts, ignore_index=True)
    number = cells.groupby(["input", "cell"], sort=False).ngroup()
    found = batch.groups.match(cells.assign(cell=number))
    return found.warnings if all(item.kind == "map" for item in batch.inputs) else ()


def _cells(item: BatchInput, groups: Groups) -> pd.DataFrame:
    """The cells of an input; one without a label for a movie, and for files that cannot be used."""
    cells = pd.DataFrame({"cell": [0], "source": [item.masks.name], "frame": [0], "label": [0]})
    if item.kind == "map":
        with suppress(CytodiskError):  # which stands in the input's line
            cells = cells_of(_opened(item).sources, groups)
    paths = [str(masks_of(item, source)) for source in cells["source"]]
    return cells.assign(input=item.name, path=paths)


def _opened(item: BatchInput) -> CellInputs:
    return open_inputs(item.masks, item.signal, item.parameters, item.signal_name, item.nuclei)


def _grid(parameters: WindowsOfMapsParameters) -> PolarGrid:
    return polar_grid(parameters.part(PolarGridParameters))


def _together(words: Sequence[str]) -> str:
    return "; ".join(words)


def _not_default(parameters: WindowsOfMapsParameters) -> dict[str, Any]:
    given = parameters.model_dump(exclude_defaults=True)
    return {name: value for name, value in given.items() if name not in _APART}
