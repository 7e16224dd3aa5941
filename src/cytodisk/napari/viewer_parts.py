"""What is taken from napari, in one place."""

from __future__ import annotations

from napari import Viewer as Viewer
from napari.utils.notifications import show_error as show_error
from napari.utils.notifications import show_info as show_info
from napari.utils.notifications import show_warning as show_warning
