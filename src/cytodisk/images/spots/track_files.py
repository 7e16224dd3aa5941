"""Files of tracks, whatever their format."""

from __future__ import annotations

import os
from pathlib import Path

from cytodisk.errors import ReadError
from cytodisk.images.image_paths import is_zarr
from cytodisk.images.spots.spots import Spots
from cytodisk.images.spots.trackmate_file import read_trackmate


def read_tracks(path: str | os.PathLike[str], interval_s: float | None = None) -> Spots:
    """The tracks of a file of TrackMate (XML) or of a GEFF.

    Parameters
    ----------
    path : path-like
    interval_s : float, optional
        Seconds between frames, for a GEFF whose positions have times rather than frames.

    Returns
    -------
    Spots

    Raises
    ------
    ReadError
        The file is missing, is damaged, or is none of these.
    """
    from cytodisk.images.spots.geff_file import read_geff  # zarr takes its time to import

    file = Path(path)
    if not file.exists():
        raise ReadError(f"tracks {file} do not exist: check the path")
    if is_zarr(file):
        return read_geff(file, interval_s)
    if file.is_file() and file.suffix.lower() == ".xml":
        return read_trackmate(file)
    raise ReadError(f"{file} holds no tracks that can be read: pass an XML file of TrackMate, or a GEFF")
