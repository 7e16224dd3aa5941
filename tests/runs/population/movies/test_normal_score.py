import numpy as np
import pytest

from cytodisk.runs.population.movies.normal_score import normal_score


def test_scores_of_all_p_that_chance_gives_have_a_mean_of_0_and_nearly_a_variance_of_1() -> None:
    for surrogates in (19, 199):
        p = np.arange(1, surrogates + 2) / (surrogates + 1)
        scores = normal_score(p, surrogates)
        assert scores.mean() == pytest.approx(0.0, abs=1e-12)
        assert 0.9 < scores.std() < 1.0
        assert (np.diff(scores) < 0).all()


def test_a_p_that_is_unknown_has_no_score_and_none_is_infinite() -> None:
    assert np.isnan(normal_score(np.nan, 99))
    assert np.isfinite(normal_score([0.0005, 1.0], [99, 1999])).all()
