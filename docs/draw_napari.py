"""Draw the screenshots of the page "In napari", of simulated cells alone.

    xvfb-run -a -s '-screen 0 1600x1000x24' python docs/draw_napari.py

Writes into `docs/source/guides/napari`. Without a name it makes all pictures; with names, those.
"""

import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from napari import Viewer
from PIL import Image
from qtpy.QtWidgets import QApplication

TARGET = Path(__file__).resolve().parent / "source" / "guides" / "napari"
WIDTH, HEIGHT = 1280, 800
WAIT_S = 600.0
COLOURS = 200  # of a picture: a third of the bytes


def wait(until: Callable[[], bool], seconds: float = WAIT_S) -> None:
    """Let the viewer work until something is done."""
    end = time.monotonic() + seconds
    while not until():
        QApplication.processEvents()
        time.sleep(0.02)
        if time.monotonic() > end:
            raise TimeoutError("the viewer takes too long")


def settle(seconds: float = 1.5) -> None:
    """Let the viewer draw."""
    end = time.monotonic() + seconds
    wait(lambda: time.monotonic() > end)


def save(viewer: Viewer, name: str) -> None:
    """Write a screenshot of the whole window."""
    settle()
    picture = Image.fromarray(viewer.screenshot(canvas_only=False, flash=False)).convert("RGB")
    TARGET.mkdir(exist_ok=True)
    picture.quantize(COLOURS).save(TARGET / f"{name}.png", optimize=True)


def opened(sample: str) -> Viewer:
    """A viewer with simulated cells, as File, Open Sample opens them."""
    viewer = Viewer(title="napari")
    viewer.window.resize(WIDTH, HEIGHT)
    viewer.open_sample("cytodisk", sample)
    viewer.theme = "light"
    return viewer


def dock(viewer: Viewer, name: str, width: int = 340) -> tuple[Any, Any]:
    """A widget of the plugin, as the menu Plugins opens it, and what holds it."""
    holder, widget = viewer.window.add_plugin_dock_widget("cytodisk", name)
    holder.setMinimumWidth(width)
    return holder, widget


def run(widget: Any) -> None:
    """Press the button of a widget, and wait for its result."""
    widget.run()
    wait(lambda: widget.work.done)
    settle()


def check() -> None:
    """A wrong frame, found before anything is mapped."""
    viewer = opened("wrong_frame")
    _, widget = dock(viewer, "Check masks")
    run(widget)
    names = [flag.name for flag in widget.found.flags]
    jumps = widget.table.tree.topLevelItem(names.index("area jumps"))
    widget.table.tree.setCurrentItem(jumps.child(0))
    save(viewer, "check")
    viewer.close()


def map_cells() -> None:
    """Cells of an image with windows."""
    viewer = opened("cells")
    _, widget = dock(viewer, "Map cells")
    widget.form.set_values({"layers": 5, "sectors": 12})
    run(widget)
    save(viewer, "map")
    viewer.close()


def follow() -> None:
    """A movie that was followed, with its disk, and a correlation."""
    viewer = opened("movie")
    holder, widget = dock(viewer, "Follow cells")
    widget.form.set_values({"layers": 6, "sectors": 36})
    run(widget)
    viewer.dims.set_current_step(0, 20)
    save(viewer, "follow")
    holder.hide()
    if widget.flags is not None:
        widget.flags.remove()
    disk, inside = dock(viewer, "Disk", 300)
    disk.setMaximumWidth(330)
    inside.parts.picture.clicked.emit(0.85, 0.3)
    viewer.reset_view()
    save(viewer, "disk")
    disk.hide()
    _, correlate = dock(viewer, "Correlate", 380)
    run(correlate)
    if correlate.flags is not None:
        correlate.flags.remove()
    save(viewer, "correlate")
    viewer.close()


PICTURES = {"check": check, "map": map_cells, "follow": follow}

if __name__ == "__main__":
    for picture in sys.argv[1:] or PICTURES:
        PICTURES[picture]()
