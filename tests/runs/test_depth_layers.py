"""Layers by depth are named by their borders, in lines and in pictures."""

import numpy as np
import xarray as xr

import cytodisk as cd
from cytodisk.plot.layer_looks import layer_names
from cytodisk.runs.depth_layers import layer_borders


def test_layers_are_named_by_their_borders() -> None:
    assert layer_borders(cd.polar_windows(sectors=8, depth_um=(0.5, 1, 2))) == [
        "0–0.5 µm",
        "0.5–1 µm",
        "1–2 µm",
        "> 2 µm",
    ]
    assert layer_borders(cd.polar_windows(layers=3, sectors=8)) == ["", "", ""]


def test_pictures_prefer_borders_to_a_median() -> None:
    borders = layer_borders(cd.polar_windows(sectors=8, depth_um=(0.5, 1)))
    depths = xr.DataArray(np.array([0.2, 0.7, 3.0]), {"layer": [0, 1, 2]}, attrs={"units": "µm"})
    assert layer_names([0, 2], 3, depths) == ["layer 0 (edge), 0.2 µm deep", "layer 2 (centre), 3 µm deep"]
    named = layer_names([0, 2], 3, depths.assign_attrs(borders=borders))
    assert named == ["layer 0 (edge), 0–0.5 µm", "layer 2 (centre), > 1 µm"]
