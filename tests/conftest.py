import compileall
import gc
import os
import sys
from contextlib import suppress
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, settings

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.mapping import map_to_disk
from cytodisk.runs.told.compiling_words import compiles
from cytodisk.runs.warm_up import warm_up
from cytodisk.simulate import random_pair
from cytodisk.windows.polar_windows import CellWindows, polar_windows
from deadlines import wait_until


def _has_screen() -> bool:
    """Whether widgets of Qt can be made here."""
    screens = ("DISPLAY", "WAYLAND_DISPLAY")
    if sys.platform.startswith("linux") and not any(os.environ.get(name) for name in screens):
        return False
    return all(find_spec(name) is not None for name in ("napari", "qtpy", "pytestqt"))


# The plugins of napari and Qt are loaded with a screen only: they import much, and without one Qt may fail.
pytest_plugins = ["pytestqt.plugin"] if _has_screen() else []

_COMMON = {"deadline": None, "suppress_health_check": [HealthCheck.too_slow]}
settings.register_profile("here", max_examples=30, **_COMMON)
settings.register_profile("ci", max_examples=30, derandomize=True, **_COMMON)
settings.load_profile("ci" if os.environ.get("CI") else "here")

_MANY = 1000  # tests of a session that needs nearly all kernels
gc.disable()  # while tests are collected, of which a third went into looking for garbage that is not there


def pytest_configure(config: pytest.Config) -> None:
    """Compile the package to bytecode once, not in each process that tests start."""
    if getattr(config.option, "numprocesses", None):
        gc.enable()  # here nothing is collected but by the workers
    if not hasattr(config, "workerinput"):
        compileall.compile_dir(Path(__file__).parents[1] / "src" / "cytodisk", quiet=2)


def pytest_collection_finish() -> None:
    """Leave what was imported and collected alone from now on: it stays to the end."""
    gc.freeze()
    gc.enable()


@pytest.fixture(scope="session", autouse=True)
def _kernels(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> None:
    """Compile missing kernels once: two workers share them, where each would compile nearly all."""
    worker = os.environ.get("PYTEST_XDIST_WORKER", "")
    if (
        worker not in ("gw0", "gw1")
        or os.environ.get("PYTEST_XDIST_WORKER_COUNT") == "1"
        or len(request.session.items) < _MANY
        or not compiles("movie with nuclei")
    ):
        return
    gc.disable()
    if worker == "gw0":
        mask, nucleus = random_pair(3)
        map_to_disk(mask), map_to_disk(mask, nucleus=nucleus)
    else:
        warm_up(True, True)
    gc.enable()
    folder = tmp_path_factory.getbasetemp().parent  # of all workers
    (folder / f"kernels_{worker}").touch()
    with suppress(pytest.fail.Exception):  # then this worker compiles them
        wait_until(lambda: len(list(folder.glob("kernels_gw[01]"))) == 2, "the other worker had its kernels")


@pytest.fixture(scope="session")
def data_dir() -> Path:
    """Folder of the real data; a test that asks for it is skipped where it is absent."""
    default = Path(__file__).parents[1].parent / "shared" / "data"
    folder = Path(os.environ.get("CYTODISK_DATA", default))
    if not folder.is_dir():
        pytest.skip(f"real data is absent: set CYTODISK_DATA to its folder (looked at {folder})")
    return folder


@pytest.fixture(scope="session")
def mask() -> BoolArray:
    """An ellipse of 61 × 31 pixels, off the centre of its image."""
    y, x = np.mgrid[:50, :90]
    return np.asarray(((y - 22) / 15.5) ** 2 + ((x - 50) / 30.5) ** 2 <= 1)


@pytest.fixture(scope="session")
def disk(mask: BoolArray) -> DiskMap:
    return map_to_disk(mask)


@pytest.fixture(scope="session")
def windows(disk: DiskMap) -> CellWindows:
    return polar_windows(3, 8).on(disk)


@pytest.fixture(scope="session")
def image(mask: BoolArray) -> FloatArray:
    """Brighter to the right: 10 counts a column."""
    return np.broadcast_to(10.0 * np.arange(mask.shape[1]), mask.shape).copy()
