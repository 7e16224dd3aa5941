"""Which versions of Qt and Python are warned of."""

import pytest

pytest.importorskip("napari.viewer")
pytest.importorskip("qtpy")

pytestmark = pytest.mark.slow  # they import napari


@pytest.mark.parametrize(
    ("binding", "version", "python", "is_told"),
    [
        ("PySide6", "6.12.0", (3, 11, 7), True),
        ("PySide6", "6.11.3", (3, 11, 7), False),
        ("PySide6", "6.12.0", (3, 13, 0), False),
        ("PyQt6", "6.12.0", (3, 11, 7), False),
        ("PySide6", "", (3, 11, 7), False),
    ],
)
def test_versions_that_end_python_are_told(
    binding: str, version: str, python: tuple[int, ...], is_told: bool
) -> None:
    from cytodisk.napari.qt_fault import fault_words

    words = fault_words(binding, version, python)

    assert bool(words) == is_told
    assert not is_told or "pip install 'PySide6<6.12'" in words
