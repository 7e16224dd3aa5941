"""The page "The paper, re-measured": its verdicts follow its numbers, and its template lacks none of them."""

import importlib
import json
import sys
from pathlib import Path
from string import Formatter
from types import SimpleNamespace
from typing import Any

import pandas as pd
import pytest
import tifffile

import cytodisk as cd

DOCS = Path(__file__).parents[2] / "docs"


def part(name: str) -> Any:
    """A part of the script that measures."""
    sys.path.insert(0, str(DOCS))
    try:
        return importlib.import_module(f"remeasured.{name}")
    finally:
        sys.path.remove(str(DOCS))


@pytest.fixture(scope="module")
def claims() -> Any:
    return part("claims")


def comparison(springs: dict[str, list[float]] | None = None, **edge: list[float]) -> SimpleNamespace:
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
        for name, values in (("newton", ours), ("edge", theirs), ("springs", theirs | (springs or {})))
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


def verdicts(claims: Any, **edge: Any) -> list[str]:
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


def test_verdicts_name_the_windows_where_they_differ(claims: Any) -> None:
    found = verdicts(claims, springs={"completeness": [1.0, 0.9, 0.8], "eccentricity_cv": [0.1] * 3})
    assert found[1] == found[2] == "edge-based yes, with springs no"


def movie(method: str, frames: int, **measures: float) -> tuple[pd.DataFrame, ...]:
    """Rows of one method in a comparison of a movie, two layers, the same in all frames."""
    consistency = pd.DataFrame(
        [
            {
                "method": method,
                "channel": "VASP",
                "frame": frame,
                "layer": layer,
                "correlation": measures.get("correlation", 0.9),
                "centroid_displacement": measures.get("moved", 1.0) * (10.0 if frame == 1 else 1.0),
            }
            for frame in range(frames)
            for layer in range(10)
        ]
    )
    complete = measures.get("completeness", 1.0)
    layers = pd.DataFrame({"layer": range(10), "completeness": complete}).assign(
        method=method, eccentricity=0.8, eccentricity_cv=0.1
    )
    by_method = pd.DataFrame(
        [{"method": method, "coverage": 1.0, "folded": measures.get("folded", float("nan"))}]
    )
    return consistency, layers, by_method.assign(carried_outside=measures.get("folded", float("nan")))


def test_movies_are_compared_with_each_kind_of_windows(claims: Any) -> None:
    parts = [
        movie("newton", 8),
        movie("edge", 8, completeness=0.4, correlation=0.8, moved=3.0),
        movie("springs", 8, completeness=0.6, correlation=0.95),
        movie("registered", 8, folded=0.02),
    ]
    consistency, layers, by_method = (
        pd.concat(tables, ignore_index=True) for tables in zip(*parts, strict=True)
    )
    one = SimpleNamespace(
        consistency=consistency,
        by_layer=layers,
        by_method=by_method,
        methods=("newton", "edge", "springs", "registered"),
        provenance={"length_unit": "px"},
    )
    found = list(claims.movie_claims({"movies": {"melanoma": one}}))
    assert found[0].verdict == "edge-based yes, with springs no"
    assert "higher: edge-based yes, with springs no, registered no" in found[1].verdict
    assert found[2].verdict == "edge-based no, with springs yes"
    assert found[3].verdict == "no"  # ours has a peak, too
    assert found[4].here.startswith("melanoma: the field folds in 2 % of the cell")
    assert found[4].verdict == "folds in more than 1 %: yes"


def test_registered_windows_are_compared_by_displacement_and_correlation(claims: Any) -> None:
    parts = [movie("newton", 8), movie("registered", 8, folded=0.02, moved=0.5, correlation=0.8)]
    consistency, layers, by_method = (
        pd.concat(tables, ignore_index=True) for tables in zip(*parts, strict=True)
    )
    one = SimpleNamespace(
        consistency=consistency,
        by_layer=layers,
        by_method=by_method,
        methods=("newton", "registered"),
        provenance={"length_unit": "px"},
    )
    assert claims.registered_words({"melanoma": one}) == {
        "calmer_registered": "1 of 1",
        "alike_registered": "0 of 1",
        "registered_kept": "100 % and 100 % (melanoma)",
    }


def test_flips_that_leave_triangles_turned_over_do_not_ensure_bijectivity(claims: Any) -> None:
    one = comparison()
    assert [claim.verdict for claim in claims.map_claims({"cells": {"maps": one}})][1] == "no"
    one.by_method.loc[one.by_method["method"] == "advection", "invalid_maps"] = 0
    assert [claim.verdict for claim in claims.map_claims({"cells": {"maps": one}})][1] == "yes"


@pytest.mark.parametrize(
    ("share", "words"),
    [(0.0, "0 %"), (8e-5, "< 0.1 %"), (0.3, "30 %"), (0.9995, "> 99.9 %"), (0.99, "99 %"), (1.0, "100 %")],
)
def test_shares_are_all_or_nothing_only_if_they_are(share: float, words: str) -> None:
    assert part("cells").percent(share) == words


def test_times_of_the_page_that_stands_are_kept_and_what_has_none_is_not_timed(tmp_path: Path) -> None:
    times, masks = part("times"), pd.DataFrame({"mask": ["star"], "map": ["newton"], "seconds": ["0.01"]})
    masks.to_csv(tmp_path / "reference_masks.csv", index=False)
    methods = pd.DataFrame({"windows": ["default"], "seconds a cell": ["0.03"], "cells": ["9 of 9"]})
    methods.to_csv(tmp_path / "by_method.csv", index=False)
    kept = times.of_page(tmp_path)
    masks.assign(seconds="7.00").to_csv(tmp_path / "reference_masks.csv", index=False)
    slow = methods.assign(**{"seconds a cell": "5.00", "cells": "8 of 9"})
    new = slow.assign(windows="springs")
    pd.concat([slow, new]).to_csv(tmp_path / "by_method.csv", index=False)
    assert times.NOT_TIMED in times.put(tmp_path, kept)["times"]
    assert pd.read_csv(tmp_path / "reference_masks.csv", dtype=str).equals(masks)
    found = pd.read_csv(tmp_path / "by_method.csv", dtype=str)
    assert list(found) == ["windows", "seconds a cell", "cells"]
    assert found["seconds a cell"].tolist() == ["0.03", "not timed"]
    assert found["cells"].tolist() == ["8 of 9"] * 2


def test_maps_made_before_must_be_of_the_same_cells(tmp_path: Path) -> None:
    cells, masks = part("cells"), tmp_path / "mask.tif"
    tifffile.imwrite(masks, cd.simulate.disk(9).astype("uint8"))
    settings: Any = {"layers": 2, "sectors": 6, "fragments": "largest", "methods": ("newton",)}
    found = cd.run_compare_windows(masks, tmp_path / "out", **settings)
    with pytest.raises(SystemExit, match=r"out is no comparison of newton, harmonic, advection .*--maps"):
        cells.made_before(found.path, masks)
    provenance = json.loads((found.path / "provenance.json").read_text())
    provenance["parameters"] |= {
        "layers": 12,
        "sectors": 60,
        "methods": ["newton", "harmonic", "advection", "edge"],
    }
    del provenance["parameters"]["fragments"]  # as a version wrote that had no choice
    (found.path / "provenance.json").write_text(json.dumps(provenance))
    assert cells.made_before(found.path, masks).methods == ("newton", "harmonic", "advection", "edge")
    tifffile.imwrite(masks, cd.simulate.disk(8).astype("uint8"))
    with pytest.raises(SystemExit, match=r"no comparison of newton"):
        cells.made_before(found.path, masks)


def test_the_written_page_came_from_the_template() -> None:
    page = (DOCS / "source" / "paper_remeasured.rst").read_text(encoding="utf-8")
    template = (DOCS / "remeasured" / "page.rst.in").read_text(encoding="utf-8")
    place = 0
    for text, field, _, _ in Formatter().parse(template):
        found = page.find(text, place)
        assert found >= place, f"the page was not written anew after the template changed, before {field}"
        place = found + len(text)
