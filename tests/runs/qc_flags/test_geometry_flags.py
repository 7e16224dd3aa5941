"""The flag of geometry says which layers and clusters do not survive."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest

from cytodisk.runs.partial_words import lost_rows, region_left, windows_lost, without_words
from cytodisk.runs.qc_flags.geometry_flags import _remedy, geometry, geometry_not_tested


class _Found:
    """Tables of a correlation in which layer 1 and cluster 2 do not survive."""

    def __init__(self, not_tested: str = "", asked: bool = True) -> None:
        self.settings = {"geometry": asked}
        self.cells = pd.DataFrame({"cell": [0], "status": "ok", "geometry_not_tested": not_tested})
        self.layers = pd.DataFrame({"cell": 0, "layer": [0, 1], "correlation": [0.5, -0.4], "lag": [1, -2]})
        self.layers = self.layers.assign(correlation_partial=[0.5, 0.1], lag_partial=[1, 7])
        self.layers["geometry"] = [False, True]
        self.clusters = pd.DataFrame({"cell": 0, "cluster": [1, 2], "p_partial": [0.01, 0.6]})


class _Study:
    def __init__(self, found: Any) -> None:
        self.correlations = [("VASP", "velocity")]
        self.found = found

    def correlation(self, *names: str) -> Any:
        return self.found


def test_what_is_lost_is_named() -> None:
    study: Any = _Study(_Found())
    (flag,) = geometry(study)
    (place,) = flag.places
    assert flag.name == "geometry"
    assert place.note == "VASP with velocity: layer 1 −0.40 at lag −2 → +0.10 at lag 7, cluster 2"
    assert not list(geometry_not_tested(study))


@pytest.mark.parametrize("change", ["not tested", "not asked for"])
def test_nothing_is_lost_that_was_not_tested(change: str) -> None:
    found = _Found("the signal is gone" if change == "not tested" else "", change == "not tested")
    study: Any = _Study(found)
    assert not list(geometry(study))
    notes = [flag.places[0].note for flag in geometry_not_tested(study)]
    assert notes == (["VASP with velocity: the signal is gone"] if change == "not tested" else [])


def test_significant_layers_without_enough_frames_are_not_tested() -> None:
    found = _Found()
    found.layers = found.layers.assign(q=[0.01, 0.01], correlation_partial=[np.nan, 0.1])
    (flag,) = geometry_not_tested(_Study(found))  # type: ignore[arg-type]
    assert [place.note for place in flag.places] == ["VASP with velocity: too few frames in layer 0"]
    found.layers = found.layers.assign(q=[0.2, 0.01])
    assert not list(geometry_not_tested(_Study(found)))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("geometry", "not_tested", "control", "words"),
    [
        (True, "", (), "without geometry"),
        (True, "", ("volume", "actin"), "without geometry, volume and actin"),
        (True, "the signal is gone", ("volume",), "without volume"),
        (True, None, (), ""),
        (False, "", (), ""),
    ],
)
def test_what_was_regressed_out_in_words(
    geometry: bool, not_tested: Any, control: tuple[str, ...], words: str
) -> None:
    found: Any = _Found(not_tested, geometry)
    found.settings["control"] = control
    assert without_words(found, 0) == words


def test_what_is_left_of_clusters_and_windows_in_words() -> None:
    kept, lost = _Found().clusters.assign(p_partial=[0.05, 0.051]).itertuples()
    assert region_left(kept, "without volume") == "without volume p = 0.05"
    assert region_left(lost, "without volume") == "not without volume (p = 0.051)"
    assert region_left(pd.DataFrame({"p": [0.01]}), "") == ""
    windows = pd.DataFrame({"q": [0.01, 0.02, 0.3], "geometry": [True, False, False]})
    assert windows_lost(windows, "without volume") == (
        "1 of 2 windows with q < 0.05 do not survive without volume"
    )
    assert windows_lost(windows[1:], "without volume") == ""


def test_without_surrogates_nothing_is_lost() -> None:
    layers = pd.DataFrame({"layer": [0, 1]})
    assert not lost_rows(layers).any()


def test_the_remedy_where_maps_are_gone() -> None:
    assert "cytodisk movie again" in _remedy("out/maps/cell_00000_t00000.npz does not exist")
    assert "signal where it was" in _remedy("signal.tif does not exist")
