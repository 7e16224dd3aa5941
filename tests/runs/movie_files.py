"""Small movies on disk, and what two studies of one movie must have in common."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import tifffile
import xarray as xr

import cytodisk as cd
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.simulate.moving_cells import SimulatedMovie

LAYERS, SECTORS = 4, 12
SMALL = MovieParameters(layers=LAYERS, sectors=SECTORS)
TABLES = ("cells", "windows", "edge", "consistency")


class Stopped(Exception):
    """What stands for a kill."""


def stop_after(frames: int) -> Callable[[int, int], None]:
    """A progress callback that ends the run when so many frames are done."""

    def stop(done: int, total: int) -> None:
        if done == frames:
            raise Stopped

    return stop


def write_masks(path: Path, masks: np.ndarray) -> Path:
    tifffile.imwrite(path, masks, metadata={"axes": "TYX"}, compression="zlib", photometric="minisblack")
    return path


def write_movie(folder: Path, truth: SimulatedMovie) -> tuple[Path, Path]:
    """Masks, and the signal with its scale, as files."""
    assert truth.signal is not None
    masks = write_masks(folder / "masks.tif", truth.masks.astype(np.uint8))
    metadata = {
        "axes": "TCYX",
        "Channel": {"Name": [str(name) for name in truth.signal["channel"].to_numpy()]},
        "PhysicalSizeX": truth.pixel_size_um,
        "PhysicalSizeY": truth.pixel_size_um,
        "TimeIncrement": truth.frame_interval_s,
        "TimeIncrementUnit": "s",
    }
    signal = folder / "signal.ome.tif"
    options = {"compression": "zlib", "photometric": "minisblack", "ome": True}
    tifffile.imwrite(signal, truth.signal.to_numpy(), metadata=metadata, **options)
    return masks, signal


def damage(path: Path, page_number: int) -> None:
    """Overwrite the compressed pixels of one page."""
    with tifffile.TiffFile(path) as tiff:
        page = tiff.pages[page_number]
        start, count = page.dataoffsets[0], page.databytecounts[0]
    with path.open("r+b") as file:
        file.seek(start)
        file.write(b"\xff" * count)


def assert_same_movie(first: cd.Study, second: cd.Study) -> None:
    """All but the time that each frame took is the same, to the last bit."""
    for name in TABLES:
        pair = [getattr(study, name).drop(columns="seconds", errors="ignore") for study in (first, second)]
        pd.testing.assert_frame_equal(*pair, check_exact=True, obj=name)
    for name in TABLES[1:]:
        files = [(study.path / f"{name}.parquet").read_bytes() for study in (first, second)]
        assert files[0] == files[1], name
    for cell in first.cells["cell"].unique():
        xr.testing.assert_identical(*(study.activity(int(cell)).load() for study in (first, second)))
        movies = first.movie(int(cell)), second.movie(int(cell))
        np.testing.assert_array_equal(movies[0].points_yx, movies[1].points_yx)
