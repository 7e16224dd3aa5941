"""The page "The paper, re-measured": its verdicts follow its numbers, and its template lacks none of them."""

import sys
from pathlib import Path
from string import Formatter
from types import SimpleNamespace
from typing import Any

import pandas as pd
import pytest

DOCS = Path(__file__).parents[2] / "docs"


@pytest.fixture(scope="module")
def claims() -> Any:
    sys.path.insert(0, str(DOCS))
    try:
        from remeasured import claims
    finally:
        sys.path.remove(str(DOCS))
    return claims


def comparison(**edge: list[float]) -> SimpleNamespace:
    """A comparison of three layers, with the measures of edge-based windows that are given."""
    ours = {
        "completeness": [1.0] * 3,
        "area_cv": [0.05] * 3,
        "eccentricity_cv": [0.1] * 3,
        "eccentricity": [0.8] * 3,
    }
    theirs = (
        ours | {"completeness": [1.0, 0.6, 0.2], "area_cv": [0.5] * 3, "eccentricity_cv": [0.2] * 3} | edge
    )
    tables = [
        pd.DataFrame(values).assign(layer=range(3), method=name)
        for name, values in (("newton", ours), ("edge", theirs))
    ]
    methods = pd.DataFrame(
        {
            "method": ["newton", "harmonic", "advection"],
            "area_error": [0.02, 0.3, 0.05],
            "area_cv": [0.03, 0.2, 0.04],
            "invalid_maps": [0, 0, 2],
            "mapped": [9, 9, 9],
        }
    )
    return SimpleNamespace(by_layer=pd.concat(tables), by_method=methods)


def verdicts(claims: Any, **edge: list[float]) -> list[str]:
    one = comparison(**edge)
    return [claim.verdict for claim in claims.shape_claims({"cells": {"12x60": one}})]


def test_claims_hold_where_the_numbers_say_so(claims: Any) -> None:
    assert verdicts(claims) == ["yes, with our windows", "yes", "yes", "yes"]


def test_completeness_that_stays_is_no_decrease(claims: Any) -> None:
    assert verdicts(claims, completeness=[1.0, 0.9, 0.8])[1] == "no"


def test_one_layer_with_more_variation_of_ours_is_a_no_and_so_is_a_missing_one(claims: Any) -> None:
    assert verdicts(claims, eccentricity_cv=[0.2, 0.1, 0.2])[2] == "no"
    assert verdicts(claims, eccentricity_cv=[0.2, 0.2, float("nan")])[2] == "no"
    assert verdicts(claims, eccentricity_cv=[0.05, 0.2, 0.2])[2] == "yes"  # the claim leaves layer 0 out


def test_flips_that_leave_triangles_turned_over_do_not_ensure_bijectivity(claims: Any) -> None:
    one = comparison()
    assert [claim.verdict for claim in claims.map_claims({"cells": {"12x60": one}})][1] == "no"
    one.by_method.loc[one.by_method["method"] == "advection", "invalid_maps"] = 0
    assert [claim.verdict for claim in claims.map_claims({"cells": {"12x60": one}})][1] == "yes"


def test_the_written_page_came_from_the_template() -> None:
    page = (DOCS / "source" / "paper_remeasured.rst").read_text(encoding="utf-8")
    template = (DOCS / "remeasured" / "page.rst.in").read_text(encoding="utf-8")
    place = 0
    for text, field, _, _ in Formatter().parse(template):
        found = page.find(text, place)
        assert found >= place, f"the page was not written anew after the template changed, before {field}"
        place = found + len(text)
