"""What differs is counted after the correction for all comparisons with the control."""

from dataclasses import replace

import numpy as np

import cytodisk as cd
from cytodisk.runs.population.comparison_rows import comparison_row


def test_counts_are_of_what_is_corrected_for_all_conditions() -> None:
    made = cd.simulate.population(experiments=4, effect=3.0, seed=0)
    pop = cd.Population(made.values, made.cells)
    one = cd.compare_with_control(pop, "control", permutations=99)["drug"]
    row = comparison_row(one, ("a",), "experiment", one.smallest_p)
    assert row["windows_found"] > 0
    ones = {name: np.ones(len(getattr(one, name))) for name in ("clusters", "scalars")}
    lost = replace(
        one,
        windows=one.windows.assign(p_holm=one.windows["p_holm"] * 0 + 1),
        clusters=one.clusters.assign(p_holm=ones["clusters"]),
        scalars=one.scalars.assign(p_holm=ones["scalars"]),
    )
    row = comparison_row(lost, ("a",), "experiment", lost.smallest_p)
    assert [row[f"{name}_found"] for name in ("windows", "clusters", "scalars")] == [0, 0, 0]
    assert row["smallest_found"] < row["p_holm"] == 1
