import sys
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd
import pytest
from drawn_shapes import ellipse, star
from scipy.stats import spearmanr

import cytodisk as cd
from cytodisk.analysis.shape import complexity
from cytodisk.analysis.shape.complexity import principal_axis, standardised, umap_plane
from cytodisk.analysis.shape.features import SCALE_FREE
from cytodisk.errors import MissingPartError, ParameterError


@pytest.fixture(scope="module")
def features() -> pd.DataFrame:
    """From round over long to stars with ever longer arms; one mask that is empty."""
    round_ones = [ellipse(20 + n, 20) for n in range(0, 40, 5)]
    stars = [star(arms, 40, 0.9 - 0.1 * n) for arms in (4, 5, 6) for n in range(7)]
    return cd.shape_features([*round_ones, np.zeros((9, 9), dtype=bool), *stars])


@pytest.fixture(autouse=True)
def two_features(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two features instead of UMAP, which takes many seconds to be compiled: for all tests but one."""
    monkeypatch.setattr(
        complexity, "umap_plane", lambda values, *_: values[:, :2] - values[:, :2].mean(axis=0)
    )


@pytest.mark.slow
def test_umap_orders_cells_from_plain_to_spiky_ones(
    features: pd.DataFrame, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(complexity, "umap_plane", umap_plane)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        score, again, *others = (cd.complexity_score(features, seed=seed) for seed in (0, 0, 1, 2))
    assert not caught
    pd.testing.assert_frame_equal(score, again, check_exact=True)
    assert not score.equals(others[0])
    scores = np.array([table["complexity"].dropna() for table in (score, *others)])
    assert np.min(spearmanr(scores.T).statistic) > 0.9  # the seed hardly matters
    ok = features["status"] == "ok"
    assert spearmanr(scores[0], features.loc[ok, "circularity"]).statistic < -0.6
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


def test_a_refused_cell_has_no_score(features: pd.DataFrame) -> None:
    score = cd.complexity_score(features)
    assert score["status"].tolist() == features["status"].tolist()
    assert score.loc[8, ["complexity", "umap_1", "umap_2"]].isna().all()
    assert score["complexity"].isna().sum() == 1


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
    "wrong",
    [
        {"seed": -1},
        {"seed": 0.5},
        {"n_neighbors": 1},
        {"min_dist": 2.0},
        {"min_dist": "a"},
        {"min_dist": np.float32("nan")},
        {"min_dist": True},
    ],
)
def test_a_parameter_out_of_its_range_is_an_error(features: pd.DataFrame, wrong: dict[str, object]) -> None:
    with pytest.raises(ParameterError, match=next(iter(wrong))):
        cd.complexity_score(features, **wrong)  # type: ignore[arg-type]


def test_numpy_numbers_are_parameters(features: pd.DataFrame) -> None:
    given = {"seed": np.int64(0), "n_neighbors": np.float32(15), "min_dist": np.float32(0.1)}
    pd.testing.assert_frame_equal(cd.complexity_score(features, **given), cd.complexity_score(features))


def test_a_table_of_nullable_numbers_is_scored(features: pd.DataFrame) -> None:
    nullable = features.astype(dict.fromkeys(SCALE_FREE, "Float64"))
    expected = cd.complexity_score(features)["complexity"]
    np.testing.assert_array_equal(cd.complexity_score(nullable)["complexity"], expected)


def test_cells_that_are_all_alike_are_an_error(features: pd.DataFrame) -> None:
    same = features.iloc[[3] * 12]
    with pytest.raises(ParameterError, match=r"12 cells.*all alike"):
        cd.complexity_score(same)
    with pytest.raises(ParameterError, match="1 of their features vary"):
        cd.complexity_score(same.assign(circularity=np.linspace(0.1, 0.9, 12)))


def test_constant_circularity_gives_no_direction_and_is_an_error(features: pd.DataFrame) -> None:
    with pytest.raises(ParameterError, match="same circularity in every cell"):
        cd.complexity_score(features.assign(circularity=0.5))


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (lambda table: table.assign(extent="0.5"), "in column 'extent', not numbers"),
        (lambda table: table.assign(extent=True), "bool in column 'extent'"),
        (lambda table: table.to_numpy(), "features must be a DataFrame, got ndarray"),
        (lambda table: pd.concat([table, table["extent"]], axis=1), "2 columns 'extent'"),
    ],
)
def test_what_is_no_table_of_numbers_is_an_error(
    features: pd.DataFrame, wrong: Callable[[pd.DataFrame], Any], words: str
) -> None:
    with pytest.raises(ParameterError, match=words):
        cd.complexity_score(wrong(features))


def test_a_missing_feature_is_an_error(features: pd.DataFrame) -> None:
    with pytest.raises(ParameterError, match="'solidity'"):
        cd.complexity_score(features.drop(columns="solidity"))


def test_without_umap_the_error_says_what_to_install(
    features: pd.DataFrame, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(complexity, "umap_plane", umap_plane)
    monkeypatch.setitem(sys.modules, "umap", None)
    with pytest.raises(MissingPartError, match=r"type pip install 'cytodisk\[umap\]'"):
        cd.complexity_score(features)


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
