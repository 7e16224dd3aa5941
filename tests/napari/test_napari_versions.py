"""What is private in napari is asked in one module."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import cytodisk

_NAPARI = Path(cytodisk.__file__).parent / "napari"
_PRIVATE = re.compile(r"(?<!self)(?<!cls)\._[a-z]\w*")


def test_nothing_private_of_another_is_used_elsewhere() -> None:
    private = {
        f"{path.relative_to(_NAPARI)}: {found}"
        for path in _NAPARI.rglob("*.py")
        for found in _PRIVATE.findall(path.read_text(encoding="utf-8"))
        if path.name != "napari_versions.py"
    }

    assert private == set()


@pytest.mark.slow
def test_the_colour_of_text_follows_the_theme(make_viewer: Callable[..., Any]) -> None:
    from cytodisk.napari.napari_versions import text_colour_of

    viewer = make_viewer()
    viewer.theme = "dark"
    on_dark = text_colour_of(viewer)
    viewer.theme = "light"
    on_light = text_colour_of(viewer)

    assert min(on_dark) > 200 > 60 > max(on_light)
