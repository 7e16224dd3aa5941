import sys
import warnings

import numpy as np
import pandas as pd
import pytest
from drawn_shapes import ellipse, star
from scipy.stats import spearmanr

import cytodisk as cd
from cytodisk.analysis.shape.complexity import principal_axis, standardised
from cytodisk.errors import MissingPartError, ParameterError


@pytest.fixture(scope="module")
def features() -> pd.DataFrame:
    """From round over long to stars with ever longer arms; one mask that is empty."""
    round_ones = [ellipse(20 + n, 20) for n in range(0, 40, 5)]
    stars = [star(arms, 40, 0.9 - 0.1 * n) for arms in (4, 5, 6) for n in range(7)]
    return cd.shape_features([*round_ones, np.zeros((9, 9), dtype=bool), *stars])


def test_spikier_cells_score_higher(features: pd.DataFrame) -> None:
    score = cd.complexity_score(features)
    ok = features["status"] == "ok"
    assert spearmanr(score.loc[ok, "complexity"], features.loc[ok, "circularity"]).statistic < -0.6
    assert score["complexity"].idxmin() < 8 < score["complexity"].idxmax()
    assert 0.5 <= score.attrs["axis_share"] <= 1
    assert score.attrs["first_component"] > 0.8


def test_the_score_is_the_place_along_the_axis_of_the_plane(features: pd.DataFrame) -> None:
    score = cd.complexity_score(features).dropna()
    plane = score[["umap_1", "umap_2"]].to_numpy()
    np.testing.assert_allclose(plane.mean(axis=0), 0, atol=1e-9)
    np.testing.assert_allclose(plane @ score.attrs["axis"], score["complexity"])
    across = plane @ np.array([-score.attrs["axis"][1], score.attrs["axis"][0]])
    assert across.var() < score["complexity"].var(ddof=0)
    assert np.corrcoef(across, score["complexity"])[0, 1] == pytest.approx(0, abs=1e-6)


def test_a_seed_gives_the_same_bits_and_a_refused_cell_has_none(features: pd.DataFrame) -> None:
    first, second = cd.complexity_score(features, seed=3), cd.complexity_score(features, seed=3)
    pd.testing.assert_frame_equal(first, second, check_exact=True)
    assert first["status"].tolist() == features["status"].tolist()
    assert first.loc[8, ["complexity", "umap_1", "umap_2"]].isna().all()
    assert first["complexity"].isna().sum() == 1


def test_the_index_of_the_features_is_kept(features: pd.DataFrame) -> None:
    named = features.rename(index=lambda n: f"cell {n}")
    assert cd.complexity_score(named).index.tolist() == named.index.tolist()


def test_size_does_not_count(features: pd.DataFrame) -> None:
    larger = features.copy()
    larger[["area", "perimeter", "feret_max"]] *= np.linspace(1, 9, len(larger))[:, None]
    expected = cd.complexity_score(features)["complexity"]
    np.testing.assert_array_equal(cd.complexity_score(larger)["complexity"], expected)


def test_ten_cells_are_enough_and_nine_are_not(features: pd.DataFrame) -> None:
    assert cd.complexity_score(features.iloc[9:19])["complexity"].notna().all()
    with pytest.raises(ParameterError, match=r"9 cells .* at least 10"):
        cd.complexity_score(features.iloc[9:18])


@pytest.mark.parametrize(
    "wrong", [{"seed": -1}, {"seed": 0.5}, {"n_neighbors": 1}, {"min_dist": 2.0}, {"min_dist": "a"}]
)
def test_a_parameter_out_of_its_range_is_an_error(features: pd.DataFrame, wrong: dict[str, object]) -> None:
    with pytest.raises(ParameterError, match=next(iter(wrong))):
        cd.complexity_score(features, **wrong)  # type: ignore[arg-type]


def test_a_missing_feature_is_an_error(features: pd.DataFrame) -> None:
    with pytest.raises(ParameterError, match="'solidity'"):
        cd.complexity_score(features.drop(columns="solidity"))


def test_without_umap_the_error_says_what_to_install(
    features: pd.DataFrame, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "umap", None)
    with pytest.raises(MissingPartError, match=r"pip install 'cytodisk\[umap\]'"):
        cd.complexity_score(features)


def test_no_warning_comes_out(features: pd.DataFrame) -> None:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        cd.complexity_score(features)
    assert not caught


def test_standardised_features_are_comparable_and_constant_ones_are_dropped() -> None:
    random = np.random.default_rng(0)
    values = np.column_stack(
        [random.normal(5.0, 2.0, 999), 1e6 * random.normal(size=999), np.full(999, 3.0), np.arange(999) == 7]
    )
    found = standardised(values)
    assert found.shape == (999, 3)
    np.testing.assert_allclose(np.median(found, axis=0), 0, atol=1e-12)
    quartiles = np.percentile(found[:, :2], (25, 75), axis=0)
    np.testing.assert_allclose(quartiles, np.arcsinh([[-0.67], [0.67]]) * np.ones(2), atol=0.05)
    values[0, 0] = 1e9
    assert standardised(values)[0, 0] < 25  # an outlier does not rule


def test_the_principal_axis_of_a_line_is_its_direction() -> None:
    steps = np.linspace(-1, 1, 20)
    axis, share = principal_axis(np.column_stack([3 * steps, 4 * steps]))
    np.testing.assert_allclose(np.abs(axis), [0.6, 0.8])
    assert share == pytest.approx(1)


def test_the_seed_hardly_matters(features: pd.DataFrame) -> None:
    scores = [cd.complexity_score(features, seed=seed)["complexity"].dropna() for seed in range(3)]
    assert np.min(spearmanr(np.transpose(scores)).statistic) > 0.9
