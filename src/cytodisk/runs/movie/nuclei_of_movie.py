"""The nuclei of a movie's cells: their file, and the nucleus of each cell in a frame."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from cytodisk.checks import is_path
from cytodisk.errors import CytodiskError, MaskError, NucleusError, ReadError, as_data
from cytodisk.geometry.placed_mask import PlacedMask
from cytodisk.images.file_parameters import Kind
from cytodisk.images.frame_file import FrameFile
from cytodisk.images.frame_pixels import FramePixels
from cytodisk.images.image_paths import is_folder_of_files, is_pattern
from cytodisk.images.nuclei.frame_matches import FrameMatches, match_frame
from cytodisk.images.nuclei.nuclei_files import NucleiFile, check_nuclei_file, one_cell, open_nuclei
from cytodisk.images.nuclei.nuclei_parameters import NucleiFileParameters
from cytodisk.images.sequences.movie_files import open_movie_masks
from cytodisk.images.tracks import CellsInFrame, open_cells
from cytodisk.images.what_it_is import look_at
from cytodisk.motion.nucleus.cell_and_nucleus import CellAndNucleus, with_room
from cytodisk.parameters import Parameters
from cytodisk.runs.cells.cell_nuclei import CellNucleus
from cytodisk.runs.cells.outline_sources import is_of_outlines


def open_nuclei_of_movie(
    path: str | os.PathLike[str], masks: FrameFile, parameters: Parameters
) -> NucleiFile:
    """Open the nuclei of a movie: one file, or a folder or pattern of files of one frame each.

    Parameters
    ----------
    path : path-like
    masks : FrameFile
    parameters : Parameters
        Those of the run; only what is said of nuclei counts.

    Returns
    -------
    NucleiFile

    Raises
    ------
    ReadError, NucleusError
        It is missing, damaged, no mask, or of another size or number of frames than the masks.
    """
    is_path("nuclei", path)
    how = parameters.part(NucleiFileParameters)
    if is_folder_of_files(Path(path)) or is_pattern(Path(path)):
        try:
            file = open_movie_masks(Path(path), how.nuclei_choice).file
            found = NucleiFile(look_at(file, how.kind_of(file.n_frames)))
        except MaskError as error:
            raise NucleusError(f"nuclei {path}: {error}") from error
    else:
        like = (masks.n_frames, *masks.image_shape) if is_of_outlines(path) else None
        found = open_nuclei(path, how, like)
    check_nuclei_file(masks, found.file)
    return found


def refuse_cells(nuclei: NucleiFile, masks: FrameFile, kind: Kind) -> None:
    """Raise NucleusError where the nuclei of the first frame are its cells, or the two are swapped.

    Parameters
    ----------
    nuclei : NucleiFile
    masks : FrameFile
    kind : {"stack", "labels"}
    """
    found = MovieNuclei(nuclei, kind).matches(open_cells(masks, 0, kind), 0)
    if isinstance(found, NucleusError):
        raise NucleusError(f"nuclei {nuclei.file.path}: {found}")


@dataclass(frozen=True)
class MovieNuclei:
    """The nuclei of the cells of a movie.

    Attributes
    ----------
    nuclei : NucleiFile
    kind : {"stack", "labels"}
        Of the masks.
    """

    nuclei: NucleiFile
    kind: Kind

    def matches(self, cells: CellsInFrame | CytodiskError, frame: int) -> FrameMatches | CytodiskError:
        """The nuclei of the cells of a frame; a fault comes as data.

        Parameters
        ----------
        cells : CellsInFrame or CytodiskError
            As `open_cells` returns it.
        frame : int
        """
        if isinstance(cells, CytodiskError):
            return cells
        try:
            return match_frame(self._labels(cells.pixels), self.nuclei.frame(frame))
        except (ReadError, NucleusError) as fault:
            return as_data(fault)

    def _labels(self, pixels: FramePixels) -> FramePixels:
        return pixels if self.kind == "labels" else one_cell(pixels)


def with_nucleus_of(
    matches: FrameMatches | CytodiskError, label: int | None, mask: PlacedMask, is_first: bool
) -> tuple[CellAndNucleus, CellNucleus]:
    """A cell of a frame with its nucleus, and what the file of nuclei says of it.

    Parameters
    ----------
    matches : FrameMatches or CytodiskError
        Of the frame; the error says why the nuclei cannot be used.
    label : int or None
        Of the cell in the frame; None for masks of one cell.
    mask : PlacedMask
        The cell, with one more pixel on every side where the image goes on.
    is_first : bool
        The first cell of the frame.

    Returns
    -------
    cell : CellAndNucleus
        Its box has room for both; an error in the place of the nucleus says why there is none.
    nucleus : CellNucleus
    """
    if isinstance(matches, CytodiskError):
        return CellAndNucleus(mask, matches), CellNucleus(fault=matches)
    by_cell, strays = matches.by_cell, matches.without_cell if is_first else ()
    match = next(iter(by_cell.values()), None) if label is None else by_cell.get(label)
    told = CellNucleus(match, strays=strays)
    if match is None or not match.nuclei:
        why = "the frame has no cell to match nuclei with" if match is None else match.reason
        return CellAndNucleus(mask, NucleusError(f"{why}: correct the masks")), told
    if (refusal := told.refusal("plain")) is not None:  # it shares a nucleus
        return CellAndNucleus(mask, refusal), told
    labels = (*match.nuclei, *match.specks)
    for nucleus in labels:
        mask = with_room(mask, matches.boxes[nucleus])
    try:
        cut = matches.nuclei.cut(*mask.slices)[0]
    except ReadError as error:
        damaged = as_data(error)
        return CellAndNucleus(mask, damaged), replace(told, fault=damaged)
    return CellAndNucleus(mask, np.where(np.isin(cut, labels), cut, 0)), told
