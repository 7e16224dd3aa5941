"""The layers of one map, without a study or apart from it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from cytodisk.disk.disk_map import DiskMap
from cytodisk.napari.given.layer_kinds import MARK
from cytodisk.napari.study_layers.feature_table import short
from cytodisk.napari.study_layers.frame_lines import cell_lines
from cytodisk.napari.study_layers.layers_of_study import LINE_LOOK, LayerData, line_width
from cytodisk.runs.cells.nuclei_given import NUCLEUS_LAYERS
from cytodisk.store.study import Study
from cytodisk.windows.polar_windows import CellWindows, polar_windows
from cytodisk.windows.study_grid import polar_grid_of


def map_layers(name: str, disk: DiskMap, study: Study | None = None) -> list[LayerData]:
    """Windows of a map, with the lines between them.

    Parameters
    ----------
    name : str
        Of the map.
    disk : DiskMap
    study : Study, optional
        That it is of, whose windows are shown; without it, those that `cytodisk map` makes by default.

    Returns
    -------
    list of (data, settings, kind)
    """
    if study is None:
        grid = polar_windows(nucleus_layers=None if disk.nucleus is None else NUCLEUS_LAYERS)
        scale = disk.scale
    else:
        grid, scale = polar_grid_of(study.provenance), study.scale
    windows = grid.on(disk)
    size, unit = (1.0, "pixel") if scale.pixel_size_um is None else (scale.pixel_size_um, "micrometer")
    mark = {MARK: {"study": "" if study is None else str(study.path), "cell": None}}

    def settings(role: str, words: str, **more: Any) -> dict[str, Any]:
        place = {"scale": (size, size), "units": (unit, unit), "name": f"{words} of {name}"}
        return place | {"metadata": {MARK: mark[MARK] | {"role": role}}} | more

    diameter = 2.0 * np.sqrt(disk.placed_mask.box.sum() / np.pi)
    look = LINE_LOOK | {"edge_width": line_width(diameter, disk.placed_mask.box.shape)}
    labels = (windows.labels + 1).astype(np.int32)
    return [
        (cell_lines(windows), settings("outlines", "windows", **look), "vectors"),
        (labels, settings("windows", "labels", features=_features(windows), opacity=0.0), "labels"),
    ]


def _features(windows: CellWindows) -> pd.DataFrame:
    layer, sector = (place.ravel() for place in np.indices(windows.areas.shape))
    scale = windows.scale
    depth, area = scale.length(windows.depths[..., 0]), scale.area(windows.areas)
    return pd.DataFrame(
        {
            "index": 1 + np.arange(layer.size),
            "layer": layer,
            "sector": sector,
            f"depth ({scale.length_unit})": short(depth).ravel(),
            f"area ({scale.area_unit})": short(area).ravel(),
        }
    )
