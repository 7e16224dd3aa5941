"""A real viewer of napari, on a real or a virtual screen; tests without one are skipped with the reason."""

import ctypes
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile

import cytodisk as cd
from cytodisk.store.study import Study

_LOST_BY_A_VIEWER = 60_000


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Warnings of napari, Qt and their parts are theirs; ours are errors, as everywhere."""
    here = Path(__file__).parent
    for item in items:
        if here in item.path.parents:
            item.add_marker(pytest.mark.filterwarnings("default"))
            item.add_marker(pytest.mark.filterwarnings("error:::cytodisk"))


@pytest.fixture(scope="session")
def movie(tmp_path_factory: pytest.TempPathFactory) -> Study:
    """Two cells in four frames; the first is in two pieces in frame 2, so it has no map there."""
    folder = tmp_path_factory.mktemp("movie")
    truth = cd.simulate.movie("fluctuating", frames=4, radius_px=14.0)
    one = truth.masks.astype(np.uint8)
    labels = np.concatenate([one, 2 * one], axis=2)
    labels[2][:, : one.shape[2]] *= np.arange(one.shape[1])[:, None] % 30 < 15
    signal = np.concatenate([truth.signal.to_numpy()] * 2, axis=3).astype(np.float32)
    tifffile.imwrite(folder / "masks.tif", labels, photometric="minisblack", metadata={"axes": "TYX"})
    tifffile.imwrite(folder / "signal.tif", signal, metadata={"axes": "TCYX"})
    return cd.run_movie(
        folder / "masks.tif",
        folder / "out",
        signal=folder / "signal.tif",
        layers=3,
        sectors=12,
        kind="labels",
        channels=("Rac1", "RhoA"),
        pixel_size_um=0.2,
        frame_interval_s=5.0,
    )


@pytest.fixture
def make_viewer(request: pytest.FixtureRequest) -> Iterator[Callable[..., Any]]:
    """Make viewers, which are closed at the end; `make_viewer(show=True)` draws on the screen."""
    if not request.config.pluginmanager.hasplugin("pytestqt.plugin"):
        pytest.skip("there is no screen, or no napari: pip install 'cytodisk[dev]', and run with xvfb-run")
    request.getfixturevalue("qtbot")
    from napari import Viewer

    made: list[Any] = []
    _more_of_none()

    def make(**settings: Any) -> Any:
        made.append(Viewer(**{"show": False, **settings}))
        return made[-1]

    yield make
    for viewer in made:
        viewer.close()


def _more_of_none() -> None:
    """Make up for references to None that PySide6 loses, some 15 000 a viewer: without any Python aborts.

    From Python 3.12 on None needs no references.
    """
    if sys.version_info < (3, 12):
        for _ in range(_LOST_BY_A_VIEWER):
            ctypes.pythonapi.Py_IncRef(ctypes.py_object(None))
