from itertools import pairwise

import numpy as np
import pytest
import xarray as xr

from cytodisk.plot.layer_looks import (
    cytoplasm_layers_of,
    layer_colours,
    layer_dashes,
    layer_names,
    layer_word,
    shown_layers,
)


def test_layers_of_a_nucleus_are_shown_beside_those_of_the_cytoplasm() -> None:
    assert shown_layers(11, 8) == [0, 4, 7, 8, 10]
    assert shown_layers(4, 2) == [0, 1, 2, 3]
    assert shown_layers(2, 1) == [0, 1]
    assert shown_layers(8) == [0, 2, 5, 7]


def test_names_tell_the_compartment() -> None:
    compartment = ["cytoplasm"] * 2 + ["nucleus"] * 2
    depths = xr.DataArray(
        [[0.5, 2.0, 4.0, 5.0]],
        {"layer": range(4), "compartment": ("layer", compartment)},
        ("time", "layer"),
        attrs={"units": "µm"},
    )
    assert cytoplasm_layers_of(depths) == 2
    assert layer_names([0, 1, 2, 3], 4, depths) == [
        "layer 0 (edge), 0.5 µm deep",
        "layer 1 (at the nucleus), 2 µm deep",
        "layer 2 (nucleus 1), 4 µm deep",
        "layer 3 (nucleus 2), 5 µm deep",
    ]
    assert layer_word(2, 4) == "layer 2"
    assert cytoplasm_layers_of(depths.drop_vars("compartment")) is None
    assert cytoplasm_layers_of(np.zeros(3)) is None


def test_colours_tell_the_compartment() -> None:
    colours = layer_colours([0, 4, 7, 8, 10], 8)
    assert (colours[:3, 0] > colours[:3, 2]).all()  # more red than blue
    assert (colours[3:, 0] < colours[3:, 2]).all()
    lightness = colours[:, :3] @ np.array([0.3, 0.6, 0.1])
    assert (np.diff(lightness[:3]) > 0).all()
    assert (np.diff(lightness[3:]) > 0).all()


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5])
def test_lines_of_neighbouring_layers_are_told_apart_without_colours(count: int) -> None:
    dashes = layer_dashes(range(count))
    assert len(dashes) == count
    assert all(one != other for one, other in pairwise(dashes)) or count == 2
    assert dashes[0] == dashes[-1] == "-"
