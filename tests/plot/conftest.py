from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.mapping import map_to_disk
from cytodisk.windows.cell_windows import CellWindows
from cytodisk.windows.grid import polar_windows


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


@pytest.fixture
def ax() -> Axes:
    return Figure().add_subplot()


@pytest.fixture
def saved(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[Figure]]:
    """Every page that was written, and that nothing of it is cut off or smaller than 6 points."""
    figures: list[Figure] = []
    write = Figure.savefig

    def note(figure: Figure, *args: object, **options: object) -> None:
        figures.append(figure)
        write(figure, *args, **options)  # type: ignore[arg-type]

    monkeypatch.setattr(Figure, "savefig", note)
    yield figures
    assert_whole_and_readable(figures)


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[Figure]]:
    """As `saved`, but the files are empty, which is far quicker."""
    figures: list[Figure] = []

    def note(figure: Figure, path: Path, **_: object) -> None:
        figures.append(figure)
        path.touch()

    monkeypatch.setattr(Figure, "savefig", note)
    yield figures
    assert_whole_and_readable(figures)


def assert_whole_and_readable(figures: list[Figure]) -> None:
    for figure in figures:
        extent = figure.get_tightbbox()
        assert extent.x0 >= 0
        assert extent.y0 >= 0
        assert (extent.max <= figure.get_size_inches()).all()
        texts = figure.findobj(lambda artist: hasattr(artist, "get_fontsize"))
        assert min(text.get_fontsize() for text in texts if text.get_text()) >= 6.0
