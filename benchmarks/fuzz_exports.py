"""Small good files of other programs, for `fuzz.py` to damage: outlines, tracks, microscopes, folders."""

import json
import sys
import zlib
from importlib.util import find_spec, module_from_spec, spec_from_file_location
from pathlib import Path
from typing import Any

import numpy as np
import tifffile

TRACKED, FRAMES, MASKS = "tracked", "frames", "folder"
_TESTS = Path(__file__).resolve().parents[1] / "tests"
_RINGS = ([(5, 5), (30, 5), (30, 25), (5, 25)], [(35, 30), (60, 30), (60, 52), (35, 52)])  # (x, y)
_CUBE = np.random.default_rng(5).integers(0, 4000, (2, 3, 2, 40, 50), dtype=np.uint16)  # TZCYX


def write_exports(folder: Path, labels: np.ndarray) -> None:
    """Write files of outlines and of microscopes, and OME-Zarr of both versions, beside the images."""
    outlines = _writers("outline_files.py")
    features = [outlines.feature(ring, name=f"cell {k}") for k, ring in enumerate(_RINGS)]
    planes = [outlines.feature(ring, plane={"t": t}) for t in range(2) for ring in _RINGS]
    outlines.write_geojson(folder / "cells.geojson", *features)
    outlines.write_geojson(folder / "movie.geojson", *planes)
    (folder / "tracks.xml").write_text(_trackmate(outlines))
    if find_spec("roifile"):
        _write_rois(folder)
    if find_spec("czifile"):
        _write_czi(folder)
    if find_spec("liffile"):
        lif = _writers("images/formats/microscope/test_lif_file.py")
        step = {"X": 1.6e-7, "Y": 1.6e-7, "Z": 1e-6, "T": 5.0}
        lif.write_lif(folder / "stack.lif", {"cell": (_CUBE, "TZCYX")}, step, ("Green", "Red"), (0, 5))
        scenes = {name: (_CUBE[:, 0, 0] + k, "TYX") for k, name in enumerate("ab")}
        lif.write_lif(folder / "scenes.lif", scenes, step)
    _write_zarr(folder / "labels.ome.zarr", labels)
    _write_zarr_3(folder / "stack.ome.zarr")


def write_folders(folder: Path, masks: np.ndarray, counts: np.ndarray, labels: np.ndarray) -> None:
    """Write a movie of labels with its tracks, a movie as a folder of frames, and a folder of masks."""
    tracked, frames, images = (folder / name for name in (TRACKED, FRAMES, MASKS))
    outlines = _writers("outline_files.py")
    tracked.mkdir()
    both = np.stack([labels, np.roll(labels, 1, axis=1)])
    tifffile.imwrite(tracked / "labels.tif", both, photometric="minisblack", metadata={"axes": "TYX"})
    (tracked / "tracks.xml").write_text(_trackmate(outlines))
    places = {"id": [1, 2, 3, 4], "t": [0, 0, 1, 1], "y": [15.0, 41, 15, 41], "x": [17.0, 47, 18, 48]}
    for name, version in (("tracks.geff", 2), ("tracks3.geff", 3)):
        outlines.write_geff(tracked / name, places, [(1, 3), (2, 4)], zarr_format=version)
    for place, stacks in ((frames, (masks, counts)), (images, (masks, counts))):
        for kind, stack in zip(("masks", "signal"), stacks, strict=True):
            (place / kind).mkdir(parents=True)
            for number in range(4):
                name = f"cell_t{number:02d}.tif" if place is frames else f"cell{'abcd'[number]}.tif"
                tifffile.imwrite(place / kind / name, stack[number], photometric="minisblack")


def _writers(name: str) -> Any:
    """A module of the tests that writes files as other programs do."""
    spec = spec_from_file_location(f"fuzz_{Path(name).stem}", _TESTS / name)
    assert spec is not None
    assert spec.loader is not None
    module = sys.modules[spec.name] = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _trackmate(outlines: Any) -> str:
    spots = [
        {"id": 10 * t + k, "frame": t, "x": x + t, "y": y, "radius": 9.0, "polygon": ring}
        for t in range(2)
        for k, (ring, (x, y)) in enumerate(zip(_RINGS, ((17.0, 15.0), (47.0, 41.0)), strict=True), start=1)
    ]
    text: str = outlines.trackmate_xml(spots, [(1, 11, 0), (2, 12, 1)])
    return text.replace('width="40" height="30"', 'width="70" height="60"')


def _write_rois(folder: Path) -> None:
    import roifile

    rois = []
    for ring in _RINGS:
        rois.append(roifile.ImagejRoi.frompoints(np.array(ring, dtype=int)))
        rois[-1].roitype = roifile.ROI_TYPE.POLYGON
    fine = roifile.ImagejRoi.frompoints(np.array(_RINGS[0]) + 0.25)
    oval = roifile.ImagejRoi()
    oval.roitype, oval.left, oval.top, oval.right, oval.bottom = roifile.ROI_TYPE.OVAL, 40, 4, 56, 24
    rois[0].tofile(folder / "cell.roi")
    fine.tofile(folder / "fine.roi")
    roifile.roiwrite(folder / "cells.zip", rois, mode="w", name=["a.roi", "b.roi"])
    roifile.roiwrite(folder / "kinds.zip", [rois[1], fine, oval], mode="w", name=["a.roi", "b.roi", "c.roi"])


def _write_czi(folder: Path) -> None:
    czi = _writers("images/formats/microscope/test_czi_file.py")
    about = czi._scaled(0.16, channels=("GFP", "mCherry"), offsets="0 5")
    tiles = [czi.Tile(_CUBE[t, 0, c], f"T{t} C{c}") for t in range(2) for c in range(2)]
    czi.write_czi(folder / "movie.czi", tiles, about)
    slices = [czi.Tile(_CUBE[0, z, 0], f"Z{z}", compression=5) for z in range(3)]
    czi.write_czi(folder / "stack.czi", slices)
    tiled = [czi.Tile(_CUBE[0, 0, 0], f"M{m} X{45 * m} Y0", compression=6) for m in range(2)]
    czi.write_czi(folder / "tiles.czi", tiled)


def _write_zarr(folder: Path, labels: np.ndarray) -> None:
    """An OME-Zarr of version 0.4 with one resolution."""
    chunk = folder / "0" / "0.0"
    chunk.parent.mkdir(parents=True)
    chunk.write_bytes(zlib.compress(labels.tobytes()))
    array = {
        "zarr_format": 2,
        "shape": labels.shape,
        "chunks": labels.shape,
        "dtype": "<u2",
        "compressor": {"id": "zlib", "level": 1},
        "fill_value": 0,
        "order": "C",
        "filters": None,
    }
    axes = [{"name": name, "type": "space", "unit": "micrometer"} for name in "yx"]
    scale = {"path": "0", "coordinateTransformations": [{"type": "scale", "scale": [0.1, 0.1]}]}
    multiscales = [{"version": "0.4", "axes": axes, "datasets": [scale]}]
    (folder / "0" / ".zarray").write_text(json.dumps(array))
    (folder / ".zgroup").write_text('{"zarr_format": 2}')
    (folder / ".zattrs").write_text(json.dumps({"multiscales": multiscales}))


def _write_zarr_3(folder: Path) -> None:
    """An OME-Zarr of version 0.5 with frames, channels and slices, in shards."""
    import zarr

    group = zarr.open_group(str(folder), mode="w", zarr_format=3)
    array = group.create_array(
        "0", shape=_CUBE.shape, chunks=(1, 1, 1, 20, 25), shards=(1, 1, 1, 40, 50), dtype="uint16"
    )
    array[...] = _CUBE
    names = (
        ("t", "time", "second"),
        ("z", "space", "micrometer"),
        ("c", "channel", None),
        ("y", "space", "micrometer"),
    )
    axes = [
        {"name": n, "type": k} | ({"unit": u} if u else {})
        for n, k, u in (*names, ("x", "space", "micrometer"))
    ]
    scale = {
        "path": "0",
        "coordinateTransformations": [{"type": "scale", "scale": [5.0, 1.0, 1.0, 0.1, 0.1]}],
    }
    said = {"version": "0.5", "multiscales": [{"axes": axes, "datasets": [scale]}]}
    said["omero"] = {"channels": [{"label": "Rac1"}, {"label": "RhoA"}]}
    group.attrs["ome"] = said
