"""The nuclei of a movie's cell, frame by frame beside its masks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import xarray as xr

from cytodisk.errors import CytodiskError, NucleusError, ParameterError
from cytodisk.motion.nucleus.cell_and_nucleus import CellAndNucleus
from cytodisk.motion.tracking_parameters import MovieSettings


@dataclass(frozen=True)
class CellsWithNuclei(Sequence[Any]):
    """Frames of a movie, each with mask and nucleus.

    Attributes
    ----------
    masks, nuclei : sequence of array_like of shape (H, W)
        As many of each. An entry may be an error of this package, a nucleus None.
    """

    masks: Any
    nuclei: Any

    def __len__(self) -> int:
        return len(self.masks)

    def __getitem__(self, frame: Any) -> Any:
        """`CellAndNucleus`, or the error that stands for its mask."""
        mask = self.masks[frame]
        return mask if isinstance(mask, CytodiskError) else CellAndNucleus(mask, self.nuclei[frame])


def parse_nuclei(nuclei: Any, masks: Any) -> Any:
    """A sequence of masks of nuclei that goes with one of masks.

    Parameters
    ----------
    nuclei : array_like, DataArray or sequence
        See `map_movie`.
    masks : sequence of array_like of shape (H, W)
        As `parse_masks` returns them.

    Returns
    -------
    sequence of array_like of shape (H, W)

    Raises
    ------
    NucleusError
        They are no movie, or not one of as many frames of the same size.
    """
    if isinstance(nuclei, xr.DataArray):
        if set(nuclei.dims) != {"time", "y", "x"}:
            raise NucleusError(f"nuclei have the dims {list(nuclei.dims)}: those of a movie have time, y, x")
        nuclei = nuclei.transpose("time", "y", "x").to_numpy()
    if not (hasattr(nuclei, "__getitem__") and hasattr(nuclei, "__len__")):
        raise NucleusError(
            f"nuclei must be an array (T, H, W) or a sequence of frames, got {type(nuclei).__name__}"
        )
    if getattr(nuclei, "ndim", 3) == 2:
        raise NucleusError(
            f"nuclei have the shape {tuple(nuclei.shape)}, one frame, the masks {len(masks)} frames: pass "
            "nuclei of each frame, (T, H, W)"
        )
    if len(nuclei) != len(masks):
        raise NucleusError(
            f"nuclei have {len(nuclei)} frames, the masks {len(masks)}: pass one of each frame; in a frame "
            "without a nucleus it is empty"
        )
    if hasattr(nuclei, "shape") and hasattr(masks, "shape") and nuclei.shape != masks.shape:
        raise NucleusError(
            f"nuclei have the shape {tuple(nuclei.shape)}, the masks {tuple(masks.shape)}: pass images of "
            "the same height and width"
        )
    return nuclei


def check_settings(with_nuclei: bool, settings: MovieSettings) -> None:
    """Refuse settings that do not go with nuclei, or need them.

    Parameters
    ----------
    with_nuclei : bool
        Whether nuclei are given.
    settings : MovieSettings

    Raises
    ------
    ParameterError
    """
    if not with_nuclei:
        if settings.align == "nucleus":
            raise ParameterError('align "nucleus" needs nuclei: pass them (nuclei=…, --nuclei)')
        return
    if settings.method != "newton":
        raise ParameterError(f'nuclei need method "newton", got {settings.method!r}')
    if settings.interior == "still":
        raise ParameterError(
            'interior "still" maps no nucleus, whose outline is followed by itself: pass --interior area '
            '(interior="area"), or leave the nuclei out'
        )
