"""A real viewer of napari, on a real or a virtual screen; tests without one are skipped with the reason."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest


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

    def make(**settings: Any) -> Any:
        made.append(Viewer(**{"show": False, **settings}))
        return made[-1]

    yield make
    for viewer in made:
        viewer.close()
