import numpy as np
import pytest

import cytodisk as cd
from cytodisk.analysis.compartment_measures import (
    compartment_measures,
    nearness,
    outer_fifth,
    outermost_share,
)
from cytodisk.arrays import FloatArray

COMPARTMENTS = ["cytoplasm", "cytoplasm", "nucleus"]


class WithAreas:
    """Stands in for windows with known areas."""

    def __init__(self, areas: FloatArray) -> None:
        self.areas = np.asarray(areas, dtype=np.float64)


def test_inequality_is_that_within_each_compartment() -> None:
    """Windows of 1 and 3 around a mean of 2; those of the nucleus are equal, though much larger."""
    windows = WithAreas([[1, 3], [3, 1], [50, 50]])
    found = compartment_measures(windows, COMPARTMENTS)  # type: ignore[arg-type]
    assert found["area_error_cytoplasm"] == pytest.approx((np.log(2) + np.log(1.5)) / 2)
    assert found["area_error_nucleus"] == 0.0
    assert outermost_share(windows, COMPARTMENTS) == 0.5  # type: ignore[arg-type]


def test_empty_windows_count_in_the_mean_alone() -> None:
    windows = WithAreas([[2, 2], [0, 0], [0, 0]])
    found = compartment_measures(windows, COMPARTMENTS)  # type: ignore[arg-type]
    assert found["area_error_cytoplasm"] == pytest.approx(np.log(2))
    assert np.isnan(found["area_error_nucleus"])
    assert np.isnan(outermost_share(WithAreas(np.zeros((3, 2))), COMPARTMENTS))  # type: ignore[arg-type]


def test_layers_by_distance_in_concentric_disks_are_as_near_as_ranks_can_be() -> None:
    """The nearer a layer, the nearer its pixels: only ranks within a layer are tied, and ways are rough."""
    cell, nucleus = cd.simulate.disk(30), cd.simulate.disk(10, margin=28)
    windows = cd.nucleus_ring_windows(cell, nucleus, 10, 1, 1)
    compartments = windows.grid.compartments
    assert nearness(windows, compartments, windows.edges) > 0.97
    sides = cd.nucleus_ring_windows(cell, nucleus, 1, 4, 1)
    assert np.isnan(nearness(sides, sides.grid.compartments, sides.edges))  # there is one layer


def test_five_layers_of_the_same_kind_are_laid() -> None:
    cell, nucleus = cd.simulate.disk(30), cd.simulate.disk(10, margin=28)
    settings = {"layers": 8, "sectors": 12, "nucleus_layers": 2}
    for windows in (
        cd.nucleus_ring_windows(cell, nucleus, **settings),
        cd.interpolated_ring_windows(cell, nucleus, **settings),
    ):
        assert outer_fifth(windows) == pytest.approx((30**2 - 26**2) / (30**2 - 10**2), abs=0.03)
    grid = cd.polar_windows(**settings)
    assert outer_fifth(grid.on(cd.map_to_disk(cell, nucleus=nucleus))) == pytest.approx(0.2, abs=0.005)


def test_rings_by_distance_hold_more_at_the_edge_than_a_fifth_of_a_disk() -> None:
    cell, nucleus = cd.simulate.disk(30), cd.simulate.disk(10, margin=28)
    windows = cd.nucleus_ring_windows(cell, nucleus, 5, 1, 1)
    share = outermost_share(windows, windows.grid.compartments)
    assert share == pytest.approx((30**2 - 26**2) / (30**2 - 10**2), abs=0.03)
