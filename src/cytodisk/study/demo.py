"""The demo's input files, and how far its results are from the known answer."""

from pathlib import Path
from typing import Any

import numpy as np
import tifffile

from cytodisk.errors import ReadError, StudyError
from cytodisk.files import replacing
from cytodisk.io.frames import open_frames
from cytodisk.io.study_folder import Study
from cytodisk.simulate.signals import SimulatedCell, cell_with_signal
from cytodisk.windows.grid import polar_windows
from cytodisk.windows.sample import sample


def write_demo_input(folder: Path, seed: int, *, overwrite: bool = False) -> tuple[SimulatedCell, Path, Path]:
    """Write a simulated cell as a mask file and an OME-TIFF; files that hold it already are left alone.

    Parameters
    ----------
    folder : Path
        Is made if need be.
    seed : int
    overwrite : bool
        Replace files that hold something else.

    Returns
    -------
    cell : SimulatedCell
    mask, signal : Path

    Raises
    ------
    StudyError
        The folder cannot be written, or holds something else.
    """
    cell = cell_with_signal(seed)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise StudyError(f"output folder {folder} cannot be written: {error.strerror}") from error
    mask, signal = folder / "mask.tif", folder / "signal.ome.tif"
    _write(mask, cell.mask.astype(np.uint8), {"axes": "YX"}, overwrite)
    pixel = cell.signal.attrs["pixel_size_um"]
    metadata = {
        "axes": "CYX",
        "Channel": {"Name": [str(name) for name in cell.signal["channel"].to_numpy()]},
        "PhysicalSizeX": pixel,
        "PhysicalSizeXUnit": "µm",
        "PhysicalSizeY": pixel,
        "PhysicalSizeYUnit": "µm",
    }
    _write(signal, cell.signal.to_numpy(), metadata, overwrite)
    return cell, mask, signal


def compare_with_truth(study: Study, cell: SimulatedCell) -> dict[str, str]:
    """How far the window means of a demo are from the expected counts, in words by channel.

    The noise of a window's mean is known: expected counts are Poisson, so its variance is the weighted mean
    of the expected counts over the number of pixels. Deviations that this explains have a root mean square
    of 1 in units of their own standard deviation.

    Parameters
    ----------
    study : Study
        Of the files that `write_demo_input` wrote.
    cell : SimulatedCell

    Returns
    -------
    dict of str to str
    """
    disk = study.map(0)
    settings = study.provenance["parameters"]
    windows = polar_windows(settings["layers"], settings["sectors"], settings["spacing"]).on(disk)
    expected = sample(windows, cell.truth)
    spread = np.sqrt(windows.weights.power(2) @ cell.truth.to_numpy()[:, disk.mask].T).T
    answers = {}
    for number, channel in enumerate(cell.signal["channel"].to_numpy()):
        found = study.windows[study.windows["channel"] == channel]
        known = expected["mean"].to_numpy()[number].ravel()
        off = found["mean"].to_numpy() - known
        sigmas = off / (spread[number] / windows.areas.ravel())
        total = float((found["mean"] * found["n_pixels"]).sum())
        counted = float(cell.signal.to_numpy()[number][disk.mask].sum(dtype=np.float64))
        answers[str(channel)] = (
            f"window means within {np.abs(off / known).max():.1%} of the known ones (rms "
            f"{np.sqrt(np.mean((off / known) ** 2)):.1%}; {np.sqrt(np.mean(sigmas**2)):.2f} of what photon "
            f"noise explains); sum over windows {total:.0f}, counts in the cell {counted:.0f}"
        )
    return answers


def _write(path: Path, values: Any, metadata: dict[str, Any], overwrite: bool) -> None:
    if path.exists() and _holds(path, values):
        return
    if path.exists() and not overwrite:
        raise StudyError(f"{path} holds something else than this demo: pass --overwrite, or another folder")
    with replacing(path) as temporary:
        tifffile.imwrite(temporary, values, metadata=metadata, ome=path.name.endswith(".ome.tif"))


def _holds(path: Path, values: Any) -> bool:
    try:
        return np.array_equal(open_frames(path, unnamed="C").frame(0), values.reshape(-1, *values.shape[-2:]))
    except ReadError:
        return False  # a file that cannot be read is written anew
