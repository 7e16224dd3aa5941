"""Comparisons of thousands of cells as units."""

import cytodisk as cd


def test_more_ways_to_exchange_cells_than_a_number_can_hold() -> None:
    truth = cd.simulate.population(0, experiments=2, cells=300, layers=2, sectors=3, precision="float32")
    found = cd.compare_conditions(
        cd.Population(truth.values, truth.cells), "control", "drug", unit="cell", permutations=99
    )
    assert found.smallest_p == 0.01
    assert "cells as units" in {warning.name for warning in found.warnings}
    assert found.left_out.empty  # not one cell after the other
