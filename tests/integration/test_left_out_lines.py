"""Cells and files that are in no mean are told by reason, with their number."""

from types import SimpleNamespace
from typing import Any

import pandas as pd

from cytodisk.cli.population.population_said import left_out_lines


def test_reasons_are_told_from_the_commonest_on() -> None:
    few = "2 protrusions with a known onset, at least 3 are needed"
    study: Any = SimpleNamespace(
        cells=pd.DataFrame({"left_out": ["", few, few, None]}),
        excluded=pd.DataFrame({"reason": ["its condition is empty", None]}),
    )
    assert left_out_lines(study) == [
        f"left out (2): {few}",
        "left out (1): its condition is empty",
        "left out (1): it cannot be read",
    ]
