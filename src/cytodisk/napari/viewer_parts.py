"""What is taken from napari, in one place."""

from __future__ import annotations

from napari import Viewer as Viewer
from napari import current_viewer as current_viewer
from napari.layers import Layer as Layer
from napari.utils.notifications import show_error as show_error
from napari.utils.notifications import show_info as show_info
from napari.utils.notifications import show_warning as show_warning
from napari.utils.theme import get_theme as get_theme
