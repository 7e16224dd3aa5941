"""`match_nuclei`: which nucleus belongs to which cell."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
import pandas as pd

from cytodisk.errors import MaskError, NucleusError
from cytodisk.geometry.fragments import several_words
from cytodisk.images.evidence.frame_labels import single_label
from cytodisk.images.frame_pixels import FramePixels, whole_pixels
from cytodisk.images.label_boxes import label_boxes
from cytodisk.images.nuclei.frame_matches import match_frame
from cytodisk.images.nuclei.nucleus_match import NucleusMatch
from cytodisk.images.nuclei.numbered_pieces import mask_labels


def match_nuclei(cells: Any, nuclei: Any) -> pd.DataFrame:
    """Find the nuclei of cells: a nucleus belongs to the cell that holds most of it.

    Parameters
    ----------
    cells : array_like of shape ([T,] H, W)
        A label image, or the 0/1 mask of one cell; perhaps a stack of those. Holes of a cell count as part
        of it.
    nuclei : array_like of the same shape
        A label image of nuclei, whatever their numbers; or a 0/1 mask, whose pieces are numbered from 1.

    Returns
    -------
    DataFrame
        A row for each cell, then one for each nucleus that no cell holds (with half of its area at least):

        * frame: only for stacks.
        * cell: label; missing for a nucleus without a cell.
        * nuclei: labels of the cell's nuclei, the largest first, as "3" or "3,7". Specks of less than a tenth
          of the largest are left out.
        * n_nuclei: their number.
        * overlap: share of their area that lies inside the cell.
        * status: "ok"; "none"; "several"; "partly outside", if that are more than 10 %; "shared", if another
          cell has more than 10 % of the nucleus; or "no cell".
        * reason: the same in words; empty for "ok".

    Raises
    ------
    NucleusError
        Sizes or numbers of frames differ, the nuclei are no mask, are the cells' own masks, or the two are
        swapped.
    MaskError
        The cells are no mask, or a 0/1 mask of several cells.

    See Also
    --------
    fit_nucleus : Fits a nucleus into its cell.
    map_to_disk : Maps a cell with its nucleus.

    Examples
    --------
    >>> import numpy as np
    >>> import cytodisk as cd
    >>> cells = np.zeros((30, 60), dtype=int)
    >>> cells[5:25, 5:25], cells[5:25, 30:50] = 1, 2
    >>> nuclei = np.zeros_like(cells)
    >>> nuclei[10:15, 10:15], nuclei[10:15, 55:58] = 7, 8
    >>> cd.match_nuclei(cells, nuclei)[["cell", "nuclei", "n_nuclei", "status"]]
       cell nuclei  n_nuclei   status
    0     1      7         1       ok
    1     2                0     none
    2  <NA>      8         1  no cell
    """
    of_cells, of_nuclei = _parsed(cells, "cells", MaskError), _parsed(nuclei, "nuclei", NucleusError)
    _check_shapes(of_cells.shape, of_nuclei.shape)
    is_stack = of_cells.ndim == 3
    if not is_stack:
        of_cells, of_nuclei = of_cells[None], of_nuclei[None]
    numbered = _nucleus_frames(of_nuclei)
    found = [
        match_frame(of_cell, of_nucleus)
        for of_cell, of_nucleus in zip(_cell_frames(of_cells), numbered, strict=True)
    ]
    rows = [
        ({"frame": frame} if is_stack else {}) | match_row(match)
        for frame, matches in enumerate(found)
        for match in (*matches.by_cell.values(), *matches.without_cell)
    ]
    columns = (["frame"] if is_stack else []) + list(match_row(_NOTHING))
    return pd.DataFrame(rows, columns=columns).astype({"cell": "Int64", "n_nuclei": "int64"})


_NOTHING = NucleusMatch(None, (), (), np.nan, "none", "")


def match_row(match: NucleusMatch) -> dict[str, Any]:
    """A row of the table of matches.

    Parameters
    ----------
    match : NucleusMatch
    """
    return {
        "cell": match.cell,
        "nuclei": match.labels,
        "n_nuclei": len(match.nuclei),
        "overlap": match.overlap,
        "status": match.status,
        "reason": match.reason,
    }


def _check_shapes(cells: tuple[int, ...], nuclei: tuple[int, ...]) -> None:
    if len(cells) == len(nuclei) == 3 and cells[1:] == nuclei[1:] and cells[0] != nuclei[0]:
        raise NucleusError(
            f"nuclei have {nuclei[0]} frames, the cells {cells[0]}: pass nuclei of the same frames"
        )
    if cells != nuclei:
        raise NucleusError(
            f"nuclei have the shape {nuclei}, the cells {cells}: pass images of the same frames, with the "
            "same height and width"
        )


def _parsed(image: Any, name: str, fault: type[MaskError]) -> np.ndarray[Any, Any]:
    """Labels, or a boolean mask, with the axes ([T,] Y, X)."""
    dims = getattr(image, "dims", ())
    if {"y", "x"} <= set(dims) <= {"time", "y", "x"}:  # a DataArray goes by its names
        image = image.transpose(*(dim for dim in ("time", "y", "x") if dim in dims))
    try:
        array = np.asarray(image)
    except ValueError as error:
        raise fault(f"{name} must be an array of shape (H, W) or (T, H, W): {error}") from error
    if array.ndim not in (2, 3):
        raise fault(f"{name} must have the shape (H, W), or (T, H, W) of a stack, got {array.shape}")
    if array.dtype.kind == "f":
        if not (np.isfinite(array).all() and (array == np.rint(array)).all()):
            raise fault(
                f"{name} hold numbers that are not whole: pass labels, or a mask as image > threshold"
            )
        array = array.astype(np.int64)
    if array.dtype.kind not in "biu":
        raise fault(f"{name} must be labels or a mask, got dtype {array.dtype}")
    if array.dtype.kind == "i" and array.min(initial=0) < 0:
        raise fault(f"{name} have negative labels (down to {array.min()}): set the background to 0")
    return array


def _cell_frames(stack: np.ndarray[Any, Any]) -> Iterator[FramePixels]:
    """Frames of labels; of a stack of masks the cell has the label 1, or the one of its mask."""
    labels = _labels(stack)
    if not labels:
        raise MaskError("cells hold no cell: all pixels are 0")
    if len(labels) > 1:
        yield from (whole_pixels(frame[None]) for frame in stack)
        return
    label = single_label(stack.dtype, labels.pop(), True)
    for number, frame in enumerate(stack):
        if words := several_words(frame):
            where = f" in frame {number}" if len(stack) > 1 else ""
            raise MaskError(
                f"the mask of cells has {words}{where}, so it holds several cells: give each a label of its "
                "own, as skimage.measure.label does, or pass one cell"
            )
        yield whole_pixels((frame != 0)[None] * np.int64(label))


def _nucleus_frames(stack: np.ndarray[Any, Any]) -> Iterable[FramePixels]:
    """Frames of labels; the pieces of 0/1 masks are numbered."""
    frames = (whole_pixels(frame[None]) for frame in stack)
    return map(mask_labels, frames) if len(_labels(stack)) == 1 else frames


def _labels(stack: np.ndarray[Any, Any]) -> set[int]:
    return {label for frame in stack for label, _ in label_boxes(whole_pixels(frame[None]).strips())}
