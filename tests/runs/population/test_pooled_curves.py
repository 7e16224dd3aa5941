from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from cytodisk.errors import PopulationError
from cytodisk.runs.population.correlations.curve_population import curve_population
from cytodisk.runs.population.correlations.pooled_curves import pool_curves
from cytodisk.runs.population.opening.found_studies import FoundStudy
from cytodisk.runs.population.pooling.batch_movies import check_intervals
from cytodisk.runs.population.pooling.pool_parameters import PoolParameters
from cytodisk.runs.population.pooling.pooled_population import Pooled, conditions_compared

NAMES = ("Rac1", "velocity")
LAG = 2


def curves_of(
    peaks: dict[str, float], experiments: int = 6, cells: int = 3, seed: int = 0
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Curves of cells that correlate in layer 0 at lag 2, half of which geometry takes away."""
    rng = np.random.default_rng(seed)
    curves, table = [], []
    lags = np.arange(-4, 5)
    for condition, peak in peaks.items():
        for experiment in range(experiments):
            dish = rng.normal(0.0, 0.05)
            for cell in range(cells):
                place = {"input": f"{condition}{experiment}", "cell": cell}
                table.append(place | {"condition": condition, "experiment": f"{condition} day {experiment}"})
                for layer in range(2):
                    size = peak * (layer == 0) * np.exp(-((lags - LAG) ** 2))
                    raw, partial = (
                        np.tanh(share * size + dish + rng.normal(0.0, 0.1, len(lags))) for share in (1.0, 0.5)
                    )
                    one = pd.DataFrame({"lag": lags, "lag_s": 5.0 * lags, "correlation": raw})
                    curves.append(one.assign(**place, layer=layer, correlation_partial=partial))
    return pd.concat(curves, ignore_index=True), pd.DataFrame(table)


def pooled(peaks: dict[str, float], **more: int) -> Pooled:
    return pool_curves(*curves_of(peaks, **more), NAMES, PoolParameters(permutations=999))


def test_a_known_lag_is_found_in_the_layer_where_it_is_with_its_interval() -> None:
    found = pooled({"control": 0.5})
    peak = found.tables["peaks"].iloc[0]
    assert (peak["layer"], peak["lag"], peak["lag_s"]) == (0, LAG, 10.0)
    assert peak["low"] < np.tanh(0.5) < peak["high"]
    assert peak["p_fwer"] == peak["smallest_p"] == 2 / 2**6
    assert (peak["n_cells"], peak["n_experiments"]) == (18, 6)
    other_layer = found.tables["pooled"].query("layer == 1 and curve == 'raw'")
    assert (other_layer["p_fwer"] > 0.05).all()


def test_the_partial_curve_is_pooled_beside_the_raw_one() -> None:
    found = pooled({"control": 0.5})
    at = found.tables["pooled"].query("layer == 0 and lag == @LAG").set_index("curve")["correlation"]
    assert at["partial"] == pytest.approx(np.tanh(0.25), abs=0.06)
    assert at["raw"] == pytest.approx(np.tanh(0.5), abs=0.06)
    assert "it survives" in " ".join(found.sentences)


def test_conditions_that_differ_are_told_apart_and_the_control_comes_first() -> None:
    found = pooled({"drug": 0.0, "control": 0.5})
    assert found.tables["pooled"]["condition"].iloc[0] == "control"
    compared = found.tables["comparisons"].query("curve == 'raw'")
    most = compared.loc[compared["p_fwer"].idxmin()]
    assert (most["condition"], most["control"]) == ("drug", "control")
    assert (most["layer"], most["lag"]) == (0, LAG)
    assert most["p_fwer"] <= 0.05
    assert most["difference"] == pytest.approx(-0.5, abs=0.15)


def test_several_conditions_are_corrected_by_holm() -> None:
    curves, cells = curves_of({"control": 0.0, "a": 0.6, "b": 0.6}, experiments=4)
    found = pool_curves(curves, cells, NAMES, PoolParameters(permutations=99))
    table = found.tables["comparisons"].query("curve == 'raw'")
    strongest = table.groupby("condition")[["p_fwer", "p_holm"]].min()
    np.testing.assert_allclose(strongest["p_fwer"], 2 / 70)
    np.testing.assert_allclose(strongest["p_holm"], 4 / 70)
    words = "a differs from control cannot be told: p is 0.057 at best, corrected for 2 comparisons (Holm)."
    assert f"Whether {words}" in found.sentences
    alone = pool_curves(curves, cells, NAMES, PoolParameters(permutations=99, compare=("control", "a")))
    assert any(sentence.startswith("a differs from control at") for sentence in alone.sentences)


def test_the_mean_is_that_of_experiments_not_of_cells() -> None:
    curves, cells = curves_of({"control": 0.0}, experiments=2, cells=1)
    curves["correlation"] = np.where(curves["input"] == "control0", 0.0, np.tanh(0.4))
    many = [curves[curves["input"] == "control1"].assign(cell=k) for k in range(1, 9)]
    more = [cells[cells["input"] == "control1"].assign(cell=k) for k in range(1, 9)]
    curves, cells = pd.concat([curves, *many]), pd.concat([cells, *more], ignore_index=True)
    found = pool_curves(curves, cells, NAMES, PoolParameters()).tables["pooled"]
    np.testing.assert_allclose(found.query("curve == 'raw'")["correlation"], np.tanh(0.2))


def test_too_few_experiments_are_told_before_anything_else() -> None:
    found = pooled({"control": 0.5}, experiments=3)
    assert found.sentences[0] == "control against 0: 3 experiments can give p = 0.25 at best."
    assert "cannot be told: p is 0.25 at best" in found.sentences[1]


def test_without_experiments_curves_are_drawn_and_nothing_is_tested() -> None:
    curves, cells = curves_of({"control": 0.5, "drug": 0.0})
    found = pool_curves(curves, cells.assign(experiment=""), NAMES, PoolParameters())
    table = found.tables["pooled"]
    assert table["p"].isna().all()
    assert table["low"].isna().all()
    assert table.query("layer == 0 and lag == @LAG and curve == 'raw'")["correlation"].max() > 0.4
    assert found.sentences[0].startswith("control is not tested against 0: experiments are unknown")
    assert found.tables["comparisons"].empty


def test_a_short_movie_counts_at_the_lags_that_it_has() -> None:
    curves, cells = curves_of({"control": 0.0}, experiments=3, cells=1)
    short = (curves["input"] == "control2") & (curves["lag"].abs() > 2)
    curves.loc[short, "correlation"] = np.nan
    population = curve_population(curves, cells, "raw", "Rac1")
    assert population is not None
    assert np.isnan(population.values[2, 0, 0]).sum() == 4
    found = pool_curves(curves, cells, NAMES, PoolParameters()).tables["pooled"].query("curve == 'raw'")
    assert found.set_index("lag")["n_experiments"].loc[[-4, 0]].to_list() == [2, 2, 3, 3]


def test_conditions_by_name_and_order() -> None:
    assert conditions_compared(["b", "Control", "c"], ()) == ["Control", "b", "c"]
    assert conditions_compared(["b", "a"], ()) == ["b", "a"]
    assert conditions_compared(["b", "a"], ["a", "b"]) == ["a", "b"]
    with pytest.raises(PopulationError, match="'drug' is not in the batch: it has 'b', 'a'"):
        conditions_compared(["b", "a"], ["a", "drug"])


def test_movies_with_other_intervals_are_refused_by_name() -> None:
    alike = [FoundStudy(name, Path(name), {"frame_interval_s": 5.0}) for name in ("a", "b")]
    check_intervals(alike)
    with pytest.raises(PopulationError, match=r"frame interval: 5 s in a, b; unknown in c"):
        check_intervals([*alike, FoundStudy("c", Path("c"), {"frame_interval_s": None})])


@pytest.mark.slow
def test_null_curves_are_seldom_found() -> None:
    found = 0
    for seed in range(40):
        curves, cells = curves_of({"control": 0.0}, cells=2, seed=seed)
        tables = pool_curves(curves.assign(correlation_partial=np.nan), cells, NAMES, PoolParameters()).tables
        found += bool((tables["peaks"]["p_fwer"] <= 0.05).any())
    level = 2 / 2**6  # what six experiments can attain
    assert found <= 40 * level + 3 * np.sqrt(40 * level * (1 - level))
