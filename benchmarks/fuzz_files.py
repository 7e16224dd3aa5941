"""Small good files of every kind that cytodisk reads, for `fuzz.py` to damage."""

import io
import shutil
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import tifffile

import cytodisk as cd
from cytodisk.runs.correlate.correlate_study import correlate_study
from fuzz_exports import write_exports, write_folders

STUDY, MAPPED, COMPARED = "movie_study", "map_study", "compared"
IMAGES = "images"

_write = partial(tifffile.imwrite, photometric="minisblack")


def make_files(folder: Path) -> None:
    """Write all files, and the studies that are made of some of them.

    Parameters
    ----------
    folder : Path
        Is made.
    """
    images = folder / IMAGES
    images.mkdir(parents=True)
    truth = cd.simulate.movie("growing", frames=14, radius_px=10.0)
    masks = truth.masks.astype(np.uint8)
    counts = np.random.default_rng(0).integers(1, 4000, masks.shape).astype(np.uint16)
    labels = np.zeros((60, 70), dtype=np.uint16)
    labels[5:25, 5:30], labels[30:52, 35:60] = 1, 2
    _write_tiffs(images, masks, counts, labels)
    _write_arrays(images, labels)
    write_exports(images, labels)
    write_folders(folder, masks, counts, labels)
    _write(folder / "masks.tif", masks, metadata={"axes": "TYX"})
    _write(folder / "signal.tif", counts, metadata={"axes": "TYX"})
    _write(folder / "labels.tif", labels, metadata={"axes": "YX"})
    _write_texts(folder)
    study = cd.run_movie(
        folder / "masks.tif",
        folder / STUDY,
        signal=folder / "signal.tif",
        channels=("Rac1",),
        layers=2,
        sectors=6,
    )
    settings: dict[str, Any] = {"surrogates": 19, "min_pairs": 5, "max_lag": 2, "clusters": True}
    correlate_study(study, "Rac1", "velocity", **settings)
    cd.run_map(folder / "labels.tif", folder / MAPPED, layers=2, sectors=6)
    cd.run_compare_windows(
        folder / "labels.tif", folder / COMPARED, layers=2, sectors=6, methods=("newton", "edge")
    )
    cd.run_batch(folder / "batch.toml", folder / "batch")


def _write_tiffs(folder: Path, masks: np.ndarray, counts: np.ndarray, labels: np.ndarray) -> None:
    few = masks[:3]
    size = {"PhysicalSizeX": 0.1, "PhysicalSizeXUnit": "µm", "PhysicalSizeY": 0.1, "PhysicalSizeYUnit": "µm"}
    two = np.stack([counts[:3], counts[3:6]], axis=1)
    names = {"Channel": {"Name": ["Rac1", "RhoA"]}}
    _write(folder / "plain.tif", few)
    _write(folder / "shaped.tif", few, metadata={"axes": "TYX"})
    _write(folder / "labels.tif", labels, compression="zlib", predictor=True)
    _write(folder / "tiled.tif", labels, tile=(32, 32), compression="lzw")
    _write(folder / "packed.tif", few[0], compression="packbits")
    _write(folder / "zstd.tif", counts[0], compression="zstd")
    _write(folder / "float.tif", counts[0].astype(np.float32))
    _write(folder / "big.tif", few, bigtiff=True, byteorder=">")
    _write(folder / "movie.ome.tif", two, metadata={"axes": "TCYX", "TimeIncrement": 5.0, **size, **names})
    imagej = {"axes": "TCYX", "unit": "um", "finterval": 5.0}
    _write(folder / "imagej.tif", two, imagej=True, resolution=(10.0, 10.0), metadata=imagej)
    tifffile.imwrite(folder / "rgb.tif", np.stack([few[0]] * 3, axis=-1), photometric="rgb")
    with tifffile.TiffWriter(folder / "pages.tif") as file:
        for page in few:
            file.write(page, contiguous=False, compression="zlib", photometric="minisblack")


def _write_arrays(folder: Path, labels: np.ndarray) -> None:
    from PIL import Image

    np.save(folder / "labels.npy", labels)
    np.save(folder / "stack.npy", np.stack([labels, labels]))
    cellpose = {
        "masks": labels,
        "outlines": labels,
        "filename": "a.tif",
        "chan_choose": [0, 0],
        "est_diam": 30.0,
    }
    np.save(folder / "cells_seg.npy", cellpose, allow_pickle=True)
    Image.fromarray((labels > 0).astype(np.uint8) * 255).save(folder / "mask.png")
    Image.fromarray(labels).save(folder / "labels16.png")
    Image.fromarray(labels > 0).save(folder / "bits.png")
    palette = Image.fromarray(labels.astype(np.uint8))
    palette.putpalette([value for grey in range(256) for value in (grey, 0, 0)])
    palette.save(folder / "palette.png")


def _write_texts(folder: Path) -> None:
    (folder / "parameters.toml").write_text(
        'layers = 3\nsectors = 12\nmethod = "newton"\nalign = [10.0, 20.0]\nshape_weight = 0.003\n'
        'pixel_size_um = 0.1\nchannels = ["Rac1", "RhoA"]\nnan = "omit"\ntracker = "matching"\n'
    )
    (folder / "inputs.csv").write_text("masks,signal,condition,pixel_size_um\nlabels.tif,,control,0.1\n")
    (folder / "batch.toml").write_text(
        '[study]\nkind = "map"\ncolumns = ["day"]\ntable = "inputs.csv"\n[parameters]\nlayers = 2\n'
        'sectors = 6\n[[inputs]]\nmasks = "masks.tif"\nname = "{stem}-a"\nkind = "movie"\nday = 3\n'
        'parameters = {inertia = 0.5}\nsignal = "signal.tif"\n'
    )


def copied(files: Path, root: str, target: Path) -> Path:
    """A copy, by links, of a folder or a file of the good files, with the inputs of runs beside it.

    What is to be damaged in it must be written anew, not changed in place.

    Parameters
    ----------
    files : Path
    root : str
        Relative to it; "" for the inputs of runs alone.
    target : Path

    Returns
    -------
    Path
        The copy of `root`.
    """
    for file in files.iterdir():
        if file.is_file():
            _link(str(file), str(target / file.name))
    if (files / root).is_dir() and root:
        shutil.copytree(files / root, target / root, copy_function=_link)
    return target / root


def _link(source: str, target: str) -> None:
    Path(target).hardlink_to(source)


def content_of(array: np.ndarray) -> bytes:
    """An array as `.npy` has it."""
    content = io.BytesIO()
    np.save(content, array, allow_pickle=False)
    return content.getvalue()
