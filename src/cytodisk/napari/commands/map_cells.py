"""The widget "Map cells"."""

from __future__ import annotations

from typing import Any

from cytodisk.napari.commands.layers_widget import LayersWidget
from cytodisk.napari.commands.study_runs import run_map
from cytodisk.runs.map.map_parameters import MapParameters
from cytodisk.runs.run_options import MapOptions

_WITHOUT = ("maps", "resume", "overwrite")  # maps are shown; the folder is new


class MapCells(LayersWidget):
    """Map the cells of open layers, and sample the signal in windows, as `cytodisk map` does.

    Parameters
    ----------
    napari_viewer : Viewer
    """

    command = "map"

    def __init__(self, napari_viewer: Any):
        super().__init__(napari_viewer, (MapParameters, MapOptions), "Map cells", _WITHOUT, run_map)
