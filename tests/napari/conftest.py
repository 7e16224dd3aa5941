"""A real viewer of napari, on a real or a virtual screen; tests without one are skipped with the reason."""

import ctypes
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

_LOST_BY_A_VIEWER = 60_000


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Warnings of napari, Qt and their parts are theirs; ours are errors, as everywhere."""
    here = Path(__file__).parent
    for item in items:
        if here in item.path.parents:
            item.add_marker(pytest.mark.filterwarnings("default"))
            item.add_marker(pytest.mark.filterwarnings("error:::cytodisk"))


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
