"""What microscope files hold, in lines for the console."""

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console


def say_contents(console: "Console", files: Iterable[Path | None]) -> None:
    """Say what can be chosen of each file that is of a microscope format: scenes, channels, slices.

    Parameters
    ----------
    console : Console
    files : iterable of (Path or None)
        Others, and what is not there, are passed over.
    """
    from cytodisk.images.contents import contents, holds_scenes

    for file in files:
        if file is not None and holds_scenes(file):
            for line in contents(file).lines:
                console.print(line, markup=False, highlight=False)
