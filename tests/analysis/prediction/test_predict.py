"""What one signal predicts of another: against statsmodels, on known answers, and on what users pass."""

from typing import Any

import numpy as np
import pytest
import xarray as xr

import cytodisk as cd
from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError, StationarityWarning

QUICK: dict[str, Any] = {"max_order": 3, "surrogates": 99}


def driven(
    seed: int = 0, frames: int = 120, sectors: int = 6, strength: float = 0.5
) -> tuple[FloatArray, FloatArray]:
    """A source, and a target that it drives two frames later."""
    random = np.random.default_rng(seed)
    source = random.normal(size=(frames, sectors))
    target = random.normal(size=(frames, sectors))
    target[2:] += strength * source[:-2]
    return source, target


def autoregressive(seed: int, frames: int, series: int) -> FloatArray:
    values = np.random.default_rng(seed).normal(size=(frames, series))
    for frame in range(1, frames):
        values[frame] += 0.5 * values[frame - 1] + 0.2 * np.roll(values[frame - 1], 1)
    return values


def test_one_sector_is_the_equation_of_statsmodels_var() -> None:
    vector = pytest.importorskip("statsmodels.tsa.vector_ar.var_model", reason="statsmodels is not installed")
    values = autoregressive(1, 100, 2)
    full = vector.VAR(values).fit(3, trend="c")
    found = cd.predict(values[:, 0], values[:, 1], order=3, source_order=3, surrogates=0)
    np.testing.assert_allclose(found["coefficient"], full.params[[1, 3, 5], 1], rtol=1e-8)
    rows = 100 - 3
    f = np.expm1(found["gain"].item()) * (rows - 7) / 3
    np.testing.assert_allclose(f, full.test_causality(1, 0, kind="f").test_statistic, rtol=1e-8)
    own = np.column_stack([np.ones(rows), *(values[3 - lag : -lag, 1] for lag in (1, 2, 3))])
    without = np.linalg.lstsq(own, values[3:, 1], rcond=None)[1].item()
    errors = np.asarray(full.resid)[:, 1]
    ratio = rows * np.log(without / (errors @ errors))  # of Gaussian likelihoods
    np.testing.assert_allclose(found["likelihood_ratio"], ratio, rtol=1e-8)


def test_pooled_sectors_with_neighbours_and_given_are_one_regression_clustered_by_frame() -> None:
    regression = pytest.importorskip(
        "statsmodels.regression.linear_model", reason="statsmodels is not installed"
    )
    random = np.random.default_rng(2)
    source, target, other = random.normal(size=(3, 40, 5))
    target += 7.0 * np.arange(5)
    orders = {"order": 2, "given_order": 1, "source_order": 2}
    found = cd.predict(source, target, [other], surrogates=0, **orders)
    rows = [(frame, sector) for frame in range(2, 40) for sector in range(5)]
    past = [
        [source[t - 1, s], source[t - 2, s], other[t - 1, s]]
        + [target[t - k, (s + side) % 5] for k in (1, 2) for side in (-1, 0, 1)]
        + [float(s == sector) for sector in range(5)]
        for t, s in rows
    ]
    wanted = [target[t, s] for t, s in rows]
    groups = {"groups": [t for t, _ in rows]}
    full = regression.OLS(wanted, past).fit(cov_type="cluster", cov_kwds=groups, use_t=True)
    without = regression.OLS(wanted, [row[2:] for row in past]).fit()
    np.testing.assert_allclose(found["coefficient"], full.params[:2], rtol=1e-8)
    np.testing.assert_allclose(found["coefficient_low"], full.conf_int()[:2, 0], rtol=1e-8)
    np.testing.assert_allclose(found["coefficient_high"], full.conf_int()[:2, 1], rtol=1e-8)
    np.testing.assert_allclose(found["likelihood_ratio"], 2.0 * (full.llf - without.llf), rtol=1e-8)
    assert found["n"] == len(rows)


def test_orders_are_those_of_the_smallest_criterion_of_the_full_model() -> None:
    values = autoregressive(3, 80, 2)

    def criterion(own: int, source: int) -> float:
        past = [values[4 - k : -k, 1] for k in range(1, own + 1)]
        past += [values[4 - k : -k, 0] for k in range(1, source + 1)]
        columns = np.column_stack([*past, np.ones(76)])
        left = np.linalg.lstsq(columns, values[4:, 1], rcond=None)[1].item()
        return 76 * np.log(left) + 2.0 * (own + source)

    best = min((criterion(p, q), p, q) for p in range(1, 5) for q in range(1, 5))
    found = cd.predict(values[:, 0], values[:, 1], max_order=4, criterion="aic", surrogates=0)
    assert (found["order"], found["source_order"]) == best[1:]


def test_the_driven_signal_is_predicted_at_its_lag_and_not_the_other_way() -> None:
    source, target = driven()
    there, back = cd.predict(source, target, **QUICK), cd.predict(target, source, **QUICK)
    assert there["p"] == 0.01
    assert there["gain"] > 10.0 * back["gain"]
    assert there["gain_excess"] > 0.05 > abs(back["gain_excess"])
    assert there["coefficient_low"].sel(lag=2) < 0.5 < there["coefficient_high"].sel(lag=2)
    assert there["effect"] > 0.3
    assert cd.predict(-source, target, **QUICK)["effect"] < -0.3


def test_noise_of_measurement_makes_the_other_direction_seem_true_and_reversed_time_tells() -> None:
    pair = cd.simulate.predicting_series("ar1", 1, 150, 1, 30, strength=0.7, source_noise=1.0)
    source, target = pair["source"].isel(layer=0), pair["target"]
    there, back = cd.predict(source, target, **QUICK), cd.predict(target, source, **QUICK)
    assert there["p"] == back["p"] == 0.01
    gains = (there["gain"], back["gain"], there["gain_reversed"], back["gain_reversed"])
    assert not cd.weaker_direction(*gains)
    assert cd.weaker_direction(back["gain"], there["gain"], back["gain_reversed"], there["gain_reversed"])


def test_two_true_directions_are_both_kept() -> None:
    pair = cd.simulate.predicting_series("ar1", 1, 150, 1, 30, strength=0.3, coupling="both ways")
    source, target = pair["source"].isel(layer=0), pair["target"]
    there, back = cd.predict(source, target, **QUICK), cd.predict(target, source, **QUICK)
    gains = (there["gain"], back["gain"], there["gain_reversed"], back["gain_reversed"])
    assert not cd.weaker_direction(*gains)
    assert not cd.weaker_direction(back["gain"], there["gain"], back["gain_reversed"], there["gain_reversed"])


def test_gains_that_are_not_known_mark_no_direction() -> None:
    unknown = [0.1, np.nan]
    assert not cd.weaker_direction(unknown, unknown, unknown, unknown).any()


def test_a_common_driver_predicts_unless_it_is_given() -> None:
    random = np.random.default_rng(5)
    driver, source, target = random.normal(size=(3, 150, 6))
    source[1:] += driver[:-1]
    target[3:] += driver[:-3]
    assert cd.predict(source, target, **QUICK)["p"] == 0.01
    found = cd.predict(source, target, {"driver": driver}, **QUICK)
    assert found["p"] > 0.05
    assert found["given_order"] == 3
    assert found.attrs["given"] == ["driver"]


def test_layers_have_their_own_models_and_a_common_target() -> None:
    source, target = driven(sectors=5)
    silent = np.random.default_rng(11).normal(size=source.shape)
    layers = xr.DataArray(
        np.stack([silent, source], axis=1), {"layer": [3, 4]}, ("time", "layer", "sector"), name="Rac1"
    )
    found = cd.predict(layers, target, **QUICK)
    assert found["p"].sel(layer=4) == 0.01
    np.testing.assert_allclose(found["q"].sel(layer=4), 0.02)
    assert found["p"].sel(layer=3) > 0.05
    assert found.sizes == {"layer": 2, "lag": 3, "surrogate": 99}
    alone = cd.predict(layers.sel(layer=4), target, **QUICK)
    assert alone["gain"] == pytest.approx(found["gain"].sel(layer=4).item())
    assert list(found["reason"].values) == ["", ""]


def test_neighbours_of_a_part_of_the_edge_are_not_joined_at_its_ends() -> None:
    source, target = (xr.DataArray(one, {"sector": range(6)}, ("time", "sector")) for one in driven())
    assert cd.predict(source, target, **QUICK)["sectors"] == 6
    assert cd.predict(source, target, edge_sectors=9, **QUICK)["sectors"] == 4
    assert cd.predict(source, target, edge_sectors=9, neighbours=False, **QUICK)["sectors"] == 6
    whole = {"source": source, "target": target}
    apart = {name: one.isel(sector=[0, 3]) for name, one in whole.items()}
    with pytest.raises(ParameterError, match=r"both its neighbours.*pass neighbours=False"):
        cd.predict(**apart, **QUICK)
    pairs = {name: one.assign_coords(sector=[0, 1, 3, 4, 6, 7]) for name, one in whole.items()}
    with pytest.raises(ParameterError, match="both its neighbours"):  # each has one
        cd.predict(**pairs, edge_sectors=9, **QUICK)


def test_others_than_the_source_must_fit_each_other_too() -> None:
    source, target = driven(sectors=4)
    layers = xr.DataArray(np.stack([target, target], axis=1), {"layer": [0, 1]}, ("time", "layer", "sector"))
    for given, words in (
        (layers.assign_coords(layer=[1, 2]), "target and given 0 do not have the same"),
        (layers.isel(layer=[0]), "target and given 0 do not have the same"),
    ):
        with pytest.raises(ParameterError, match=words):
            cd.predict(source, layers, [given], **QUICK)


def test_a_frame_that_is_missing_takes_the_rows_that_look_back_on_it() -> None:
    source, target = driven(frames=100, sectors=4)
    target[50] = np.nan
    found = cd.predict(source, target, order=2, source_order=2, surrogates=99)
    assert found["n"] == (100 - 2 - 3) * 4
    assert found["p"] <= 0.05


def test_a_layer_that_cannot_be_tested_says_why() -> None:
    source, target = driven(sectors=4)
    layers = np.stack([source, np.full(source.shape, np.nan), 0.0 * source], axis=1)
    found = cd.predict(layers, target, **QUICK)
    assert found["reason"].values[0] == ""
    assert found["reason"].values[1] == "source is NaN in every frame and sector"
    assert "source is constant in every sector" in found["reason"].values[2]
    assert np.isnan(found["p"].values[1:]).all()
    assert found["n"].values[1] == 0
    with pytest.raises(ParameterError, match=r"no layer can be tested.*NaN in every frame"):
        cd.predict(layers[:, 1:], target, **QUICK)


def test_a_level_that_drifts_in_both_is_warned_of() -> None:
    source, target = driven(strength=0.0)
    line = np.linspace(0.0, 6.0, len(source))[:, None]
    with pytest.warns(
        StationarityWarning, match=r"100% of the series of source drifts, and of 100% of target"
    ):
        found = cd.predict(source + line, target + line, **QUICK)
    assert found.attrs["drifting_source"] == 1.0
    assert cd.predict(source + line, target, **QUICK).attrs["drifting_target"] < 0.25


SOURCE, TARGET = driven(frames=40, sectors=3)


@pytest.mark.parametrize(
    ("source", "target", "given", "settings", "words"),
    [
        (SOURCE[:5], TARGET[:5], (), {}, "there are 5 frames, of which 8 are past alone"),
        (SOURCE[:12, 0], TARGET[:12, 0], (), {}, "4 rows .* are too few for 16 coefficients"),
        (SOURCE[:39], TARGET, (), {}, "source has 39 frames, target 40"),
        (SOURCE, TARGET[:, 0], (), {}, "target has no sectors, but source has"),
        (SOURCE, TARGET * 0.0 + 3.0, (), {}, "target is constant in every sector"),
        (TARGET, TARGET, (), {}, "linear function"),
        (SOURCE, TARGET, [SOURCE], {}, "linear function"),
        (SOURCE, TARGET, [0.0 * SOURCE], {}, "linearly dependent: leave out a given signal"),
        (SOURCE, TARGET, [TARGET**2, TARGET**2], {"max_order": 2}, "linearly dependent"),
        (SOURCE, np.repeat(TARGET[:, :1], 3, axis=1), (), {"max_order": 2}, "neighbours=False where sectors"),
        (SOURCE, TARGET, SOURCE, {}, r"given must be a sequence"),
        (SOURCE, TARGET, [SOURCE[:, :2]], {}, "source and given 0 do not have the same"),
        (SOURCE, TARGET, (), {"max_order": 0}, "max_order"),
        (SOURCE, TARGET, (), {"edge_sectors": 2}, "edge_sectors is 2, but there is a sector 2"),
        (SOURCE[:24, 0], TARGET[:24, 0], (), {"max_order": 4, "surrogates": 99}, "shifted in 17 ways only"),
    ],
)
def test_what_cannot_be_tested_is_refused(
    source: Any, target: Any, given: Any, settings: dict[str, Any], words: str
) -> None:
    with pytest.raises(ParameterError, match=words):
        cd.predict(source, target, given, **settings)


def test_frames_that_are_not_evenly_spaced_are_refused() -> None:
    uneven = {"time_s": ("time", np.arange(40.0) ** 1.1)}
    source = xr.DataArray(SOURCE, uneven, ("time", "sector"))
    with pytest.raises(ParameterError, match=r"source has frames .* apart in time_s.*put NaN"):
        cd.predict(source, TARGET)
    even = xr.DataArray(SOURCE, {"time_s": ("time", 5.0 * np.arange(40))}, ("time", "sector"))
    found = cd.predict(even, TARGET, max_order=2, surrogates=19)
    assert list(found["lag_s"].values) == [5.0, 10.0]


def test_the_same_seed_gives_the_same_and_progress_is_told() -> None:
    told: list[tuple[int, int]] = []
    first, again, other = (
        cd.predict(SOURCE, TARGET, seed=seed, progress=lambda *step: told.append(step), **QUICK)
        for seed in (1, 1, 2)
    )
    assert first.identical(again)
    assert not np.array_equal(first["gain_null"], other["gain_null"])
    assert told == [(1, 1)] * 3
