from collections.abc import Iterator
from pathlib import Path

import pytest
from matplotlib.figure import Figure
from readable_pages import assert_readable


@pytest.fixture
def saved(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[Figure]]:
    """Every page that was written, and that nothing of it is cut off or too small, or lies on other text."""
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
    assert_readable(figures)
    for figure in figures:
        extent = figure.get_tightbbox()
        assert extent.x0 >= 0
        assert extent.y0 >= 0
        assert (extent.max <= figure.get_size_inches()).all()
