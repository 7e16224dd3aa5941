import numpy as np
import pandas as pd
import pytest

from cytodisk.analysis.shape.features import FEATURES
from cytodisk.errors import PopulationError
from cytodisk.runs.population.shape_values import joined_shapes, shape_scalars


def table(cells: int, seed: int = 0, unit: str = "px") -> pd.DataFrame:
    """Features that vary without meaning, as `open_shapes` returns them."""
    rng = np.random.default_rng(seed)
    found = pd.DataFrame({feature.name: rng.normal(size=cells) for feature in FEATURES})
    found.insert(0, "complexity", rng.normal(size=cells))
    found = found.assign(cell=range(cells), status="ok", qc_flags="", umap_1=0.0, umap_2=0.0)
    found.attrs = {
        "units": {feature.name: feature.unit.replace("length", unit) for feature in FEATURES},
        "scale_free": [feature.name for feature in FEATURES if feature.scale_free],
    }
    return found


def test_the_score_comes_first_and_what_does_not_vary_is_left_out_with_a_sentence() -> None:
    shapes = table(12)
    constant = FEATURES[3].name
    shapes[constant] = 2.0
    shapes.loc[3, "status"] = "refused"
    found = shape_scalars(shapes)
    assert found.names[0] == "complexity"
    assert constant not in found.names
    assert found.units["area"] == "px²"
    assert "of all 11 cells together" in found.sentences[0]
    assert constant in found.sentences[1]


def test_without_a_score_it_says_why() -> None:
    shapes = table(5).assign(complexity=np.nan)
    found = shape_scalars(shapes)
    assert "complexity" not in found.names
    assert "at least 10" in found.sentences[0]


def test_cells_too_small_for_curvature_are_told() -> None:
    shapes = table(12)
    shapes.loc[:3, "qc_flags"] = (
        "too small for curvature and roughness to be those of the shape: D = 40 px, below 75 px"
    )
    assert any(text.startswith("4 of 12 cells are too small") for text in shape_scalars(shapes).sentences)


@pytest.mark.slow  # UMAP is compiled
def test_cells_of_several_runs_are_scored_together() -> None:
    pytest.importorskip("umap", reason="umap-learn is not installed")
    parts = [table(12, 1), table(9, 2)]
    joined = joined_shapes(parts)
    assert len(joined) == 21
    assert joined["complexity"].notna().all()
    assert abs(joined["complexity"].mean()) < 1e-6
    assert not np.allclose(joined["complexity"][:12], parts[0]["complexity"])


def test_one_run_stays_and_other_units_are_refused() -> None:
    alone = table(12)
    assert joined_shapes([alone]) is alone
    with pytest.raises(PopulationError, match="px² and µm²: run cytodisk shapes with --pixel-size"):
        joined_shapes([alone, table(12, unit="µm")])
    with pytest.raises(PopulationError, match="no tables of shapes"):
        joined_shapes([])
