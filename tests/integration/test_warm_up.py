"""Kernels have one signature each, and what is compiled ahead of a run is what the run needs.

The run comes first, in an empty folder of kernels: what is compiled ahead must then be there already. Of a
kernel that is there, those that it calls are not loaded, so what two processes load is what they call from
Python, and can be compared.
"""

import json
import os
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import tifffile

import cytodisk as cd

pytestmark = [pytest.mark.slow, pytest.mark.timeout(900)]

MOVIE = "cd.run_movie('masks.tif', 'out', layers=3, sectors=12, overwrite=True)"
NUCLEI = "cd.run_map('mask.tif', 'nuclei_out', nuclei='nucleus.tif', layers=3, sectors=12)"
# Kernels that take a whole number of several kinds: a literal, of 64 bits, or a pixel's of 32 bits.
SEVERAL = {"edge_distance._add": 4, "edge_distance._is_inside": 2, "edge_distance.squared_distance": 2}
_PROGRAM = """
import gc, json, sys
import cytodisk as cd
from cytodisk.runs.warm_up import warm_up
from numba.core.dispatcher import Dispatcher
gc.disable()  # a sixth of the time of compiling
exec(sys.argv[1])
kernels = [kernel for kernel in gc.get_objects() if isinstance(kernel, Dispatcher)]
names = {kernel: f"{kernel.py_func.__module__}.{kernel.py_func.__qualname__}" for kernel in kernels}
print(json.dumps([[names[kernel], str(types)] for kernel in kernels for types in kernel.signatures]))
"""
Kernels = set[tuple[str, str]]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A movie, a cell with its nucleus, and kernels, of which there are none yet."""
    here = tmp_path_factory.mktemp("warm_up")
    y, x = np.mgrid[:48, :50]
    masks = [np.hypot((y - 24) / 14, (x - 24 - step) / (12 + step)) < 1 for step in range(3)]
    tifffile.imwrite(here / "masks.tif", np.array(masks, np.uint8), metadata={"axes": "TYX"}, imagej=True)
    mask, nucleus = cd.simulate.random_pair(3)
    for name, image in (("mask", mask), ("nucleus", nucleus)):
        tifffile.imwrite(here / f"{name}.tif", image.astype(np.uint8))
    return here


def used(code: str, folder: Path) -> Kernels:
    """Kernels with their argument types that some code compiles or loads, in a process of its own."""
    environment = os.environ | {"NUMBA_CACHE_DIR": str(folder / "kernels")}
    command = [sys.executable, "-c", _PROGRAM, code]
    done = subprocess.run(command, env=environment, cwd=folder, check=True, stdout=subprocess.PIPE, text=True)
    loaded = json.loads(done.stdout.splitlines()[-1])
    return {(name, types) for name, types in loaded if name.startswith("cytodisk.")}


def compiled(folder: Path) -> Kernels:
    """Kernels with their argument types that are in the folder, from Numba's index."""
    found = set()
    for index in (folder / "kernels").rglob("*.nbi"):
        with index.open("rb") as file:
            pickle.load(file)  # Numba's version
            _, overloads = pickle.loads(file.read())
        kernel = index.name.rpartition("-")[0].removesuffix("-")
        found |= {(kernel, str(key[0])) for key in overloads}
    return found


@pytest.fixture(scope="module")
def run(folder: Path) -> Kernels:
    """What a movie compiles."""
    used(MOVIE, folder)
    return compiled(folder)


def test_kernels_have_one_signature_and_are_compiled_ahead(folder: Path, run: Kernels) -> None:
    kernels = [kernel for kernel, _ in run]
    assert len(set(kernels)) > 60
    assert not [kernel for kernel in set(kernels) if kernels.count(kernel) > SEVERAL.get(kernel, 1)]
    ahead = used("warm_up(True)", folder)
    assert compiled(folder) == run
    assert len(ahead) > len(used(MOVIE, folder)) / 3


@pytest.mark.usefixtures("run")
def test_kernels_of_nuclei_are_compiled_ahead(folder: Path) -> None:
    run = used(NUCLEI, folder)
    there = compiled(folder)
    assert {"nucleus_raster._paint", "ring_triangles.paint_ring_triangle"} <= {kernel for kernel, _ in there}
    ahead = used("warm_up(False, True)", folder)
    assert "cytodisk.windows.nucleus.nucleus_raster._paint" in {kernel for kernel, _ in ahead}
    assert compiled(folder) == there
    assert not ahead - run
