"""Kernels have one signature each, and what is compiled ahead of a run is what the run needs."""

import os
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import tifffile

import cytodisk as cd

RUN = "import cytodisk as cd; cd.run_movie('masks.tif', 'out', layers=3, sectors=12)"
AHEAD = "from cytodisk.runs.warm_up import warm_up; warm_up(True)"
# Kernels that take a whole number of several kinds: a literal, of 64 bits, or a pixel's of 32 bits.
SEVERAL = {"edge_distance._add": 4, "edge_distance._is_inside": 2, "edge_distance.squared_distance": 2}


def compiled(code: str, folder: Path, name: str) -> set[tuple[str, str]]:
    """Kernels with their argument types that some code compiles, from Numba's index."""
    cache = folder / name
    environment = os.environ | {"NUMBA_CACHE_DIR": str(cache)}
    subprocess.run([sys.executable, "-c", code], env=environment, cwd=folder, check=True)
    found = set()
    for index in cache.rglob("*.nbi"):
        with index.open("rb") as file:
            pickle.load(file)  # Numba's version
            _, overloads = pickle.loads(file.read())
        kernel = index.name.rpartition("-")[0].removesuffix("-")
        found |= {(kernel, str(key[0])) for key in overloads}
    return found


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_kernels_of_nuclei_are_compiled_ahead(tmp_path: Path) -> None:
    mask, nucleus = cd.simulate.random_pair(3)
    for name, image in (("mask", mask), ("nucleus", nucleus)):
        tifffile.imwrite(tmp_path / f"{name}.tif", image.astype(np.uint8))
    run = compiled(
        "import cytodisk as cd; cd.run_map('mask.tif', 'out', nuclei='nucleus.tif', layers=3, sectors=12)",
        tmp_path,
        "run",
    )
    ahead = compiled("from cytodisk.runs.warm_up import warm_up; warm_up(False, True)", tmp_path, "ahead")
    assert {"nucleus_raster._paint", "ring_triangles.paint_ring_triangle"} <= {kernel for kernel, _ in ahead}
    assert not ahead - run


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_kernels_have_one_signature_and_are_compiled_ahead(tmp_path: Path) -> None:
    y, x = np.mgrid[:48, :50]
    masks = [np.hypot((y - 24) / 14, (x - 24 - step) / (12 + step)) < 1 for step in range(3)]
    tifffile.imwrite(tmp_path / "masks.tif", np.array(masks, np.uint8), metadata={"axes": "TYX"}, imagej=True)
    run, ahead = compiled(RUN, tmp_path, "run"), compiled(AHEAD, tmp_path, "ahead")
    kernels = [kernel for kernel, _ in run]
    assert len(set(kernels)) > 60
    assert not [kernel for kernel in set(kernels) if kernels.count(kernel) > SEVERAL.get(kernel, 1)]
    assert not ahead - run
    assert len(ahead) > len(run) / 3
