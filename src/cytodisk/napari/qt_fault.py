"""A fault of some versions of PySide6 that ends Python after a while, told before it happens."""

from __future__ import annotations

import sys
from functools import cache

import qtpy

from cytodisk.napari.viewer_parts import show_warning

_FAULTY = (6, 12)  # each signal that carries True or None loses a reference to it: 6.9 to 6.11.3 lose none
_MORTAL = (3, 12)  # until then Python counts references to True and None, and ends where none is left


def fault_words(binding: str, version: str, python: tuple[int, ...]) -> str:
    """What is wrong with the versions of Qt and Python; empty if nothing is.

    Parameters
    ----------
    binding, version : str
        Of Qt, as "PySide6" and "6.11.3".
    python : tuple of int
    """
    known = tuple(int(part) for part in version.split(".")[:2] if part.isdigit())
    if binding != "PySide6" or known != _FAULTY or python >= _MORTAL:
        return ""
    return (
        f"PySide6 {version} on Python {'.'.join(map(str, python[:2]))} ends napari without a word after some "
        "hundred changes of frame: type pip install 'PySide6<6.12', or use Python 3.12 or newer"
    )


@cache
def warn_of_qt() -> None:
    """Say once, as a notification, if this napari can end without a word."""
    words = fault_words(qtpy.API_NAME, qtpy.PYSIDE_VERSION or "", sys.version_info[:3])
    if words:
        show_warning(words)
