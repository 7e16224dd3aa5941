from typing import Any

import numpy as np
import pytest
import xarray as xr

import cytodisk as cd
from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.simulate import COUPLINGS, PREDICTING_KINDS, predicting_series
from cytodisk.simulate.predicting.mixed_innovations import mixing

ORDER = 12


def past(values: FloatArray) -> FloatArray:
    """The last frames of each sector as columns, rows over frames and sectors."""
    frames = len(values)
    return np.stack([values[ORDER - lag : frames - lag].ravel() for lag in range(1, ORDER + 1)], axis=1)


def gain(source: xr.DataArray, target: xr.DataArray, *given: xr.DataArray) -> float:
    """ln of the residual variance without the source's past over that with it, by least squares."""
    known = np.hstack([past(one.to_numpy()) for one in (target, *given)])
    after = target.to_numpy()[ORDER:].ravel()
    errors = []
    for columns in (known, np.hstack([known, past(source.to_numpy())])):
        answer = np.linalg.lstsq(columns, after, rcond=None)[0]
        errors.append(np.sum((after - columns @ answer) ** 2))
    return float(np.log(errors[0] / errors[1]))


def pair(kind: Any, seed: int = 0, **settings: Any) -> tuple[xr.DataArray, xr.DataArray, xr.Dataset]:
    made = predicting_series(kind, seed, 800, 1, 40, correlation_length=0.0, **settings)
    return made.source[:, 0], made.target, made


@pytest.mark.parametrize("kind", ["white", "ar1", "oscillating"])
@pytest.mark.parametrize("strength", [0.3, -0.6])
def test_the_source_predicts_the_target_as_well_as_stated_and_not_the_other_way(
    kind: Any, strength: float
) -> None:
    source, target, made = pair(kind, strength=strength)
    assert made.attrs["gain"] == pytest.approx(-np.log(1.0 - strength**2))
    assert gain(source, target) == pytest.approx(made.attrs["gain"], rel=0.12)
    assert gain(target, source) < 0.001 == made.attrs["gain_back"] + 0.001


def test_the_partial_correlation_of_the_innovations_is_the_stated_one() -> None:
    source, target, _ = pair("white", strength=0.4, lags=(2,))
    earlier, later = source.to_numpy()[:-2].ravel(), target.to_numpy()[2:].ravel()
    assert np.corrcoef(earlier, later)[0, 1] == pytest.approx(0.4, abs=0.02)
    source, target, _ = pair("white", strength=-0.4, lags=(1, 2, 3))
    found = [
        np.corrcoef(source.to_numpy()[:-lag].ravel(), target.to_numpy()[lag:].ravel())[0, 1]
        for lag in (1, 2, 3, 4)
    ]
    np.testing.assert_allclose(found, [-0.4 / np.sqrt(3.0)] * 3 + [0.0], atol=0.03)


def test_both_predict_each_other_as_well_as_stated() -> None:
    source, target, made = pair("ar1", coupling="both ways", strength=0.3)
    assert gain(source, target) == pytest.approx(made.attrs["gain"], rel=0.12)
    assert gain(target, source) == pytest.approx(made.attrs["gain_back"], rel=0.12)
    with pytest.raises(ParameterError, match="too large for series that predict each other both ways"):
        pair("ar1", coupling="both ways", strength=0.8)


def test_neither_predicts_the_other() -> None:
    source, target, made = pair("slow", coupling="none", at_once=0.5)
    assert np.corrcoef(np.diff(source, axis=0).ravel(), np.diff(target, axis=0).ravel())[
        0, 1
    ] == pytest.approx(0.5, abs=0.03)
    assert max(gain(source, target), gain(target, source)) < 0.001
    assert made.attrs["gain"] == made.attrs["gain_back"] == 0.0


def test_a_common_driver_makes_the_source_predict_until_it_is_given() -> None:
    source, target, made = pair("ar1", coupling="common driver", strength=0.7)
    assert gain(source, target) > 0.05
    assert gain(source, target, made.driver) < 0.001 == made.attrs["gain"] + 0.001
    assert gain(made.driver, target) == pytest.approx(-np.log(1.0 - 0.49), rel=0.12)


def test_coupling_at_once_adds_to_no_gain() -> None:
    source, target, made = pair("ar1", strength=0.4, at_once=0.5)
    assert gain(source, target) == pytest.approx(made.attrs["gain"], rel=0.12)
    assert gain(target, source) < 0.001


def test_noise_on_the_source_hides_it_and_shows_the_target_as_a_predictor() -> None:
    clean = pair("ar1", strength=0.8)
    noisy = pair("ar1", strength=0.8, source_noise=2.0)
    assert gain(*noisy[:2]) < 0.5 * gain(*clean[:2])
    assert gain(noisy[1], noisy[0]) > 0.01
    assert np.isnan(noisy[2].attrs["gain"])
    added = noisy[0].to_numpy() - clean[0].to_numpy()
    assert added.std() == pytest.approx(2.0, rel=0.02)


def test_jitter_adds_a_moving_average_of_minus_a_half_and_predicts_where_the_source_sees_it() -> None:
    _, clean, _ = pair("ar1", coupling="none")
    source, target, made = pair("ar1", coupling="none", jitter=0.6)
    added = (target - clean).to_numpy()
    assert added.std() == pytest.approx(0.6, rel=0.03)
    lagged = [np.corrcoef(added[:-lag].ravel(), added[lag:].ravel())[0, 1] for lag in (1, 2)]
    np.testing.assert_allclose(lagged, [-0.5, 0.0], atol=0.02)
    assert gain(source, target) < 0.001
    assert made.attrs["gain"] == 0.0
    source, target, made = pair("ar1", coupling="none", jitter=0.9, jitter_seen=0.9)
    assert gain(source, target) > 0.01
    assert np.isnan(made.attrs["gain"])


def test_coarse_frames_are_every_nth() -> None:
    fine = predicting_series("ar1", 3, 31, 2, 8)
    coarse = predicting_series("ar1", 3, 11, 2, 8, every=3)
    np.testing.assert_array_equal(coarse.source, fine.source[::3])
    np.testing.assert_array_equal(coarse.target, fine.target[::3])


@pytest.mark.parametrize("kind", PREDICTING_KINDS)
@pytest.mark.parametrize("coupling", COUPLINGS)
def test_all_have_variance_1_in_each_kind_and_coupling(kind: Any, coupling: Any) -> None:
    made = [
        predicting_series(kind, seed, 60, 1, 24, coupling=coupling, strength=0.4, correlation_length=0.0)
        for seed in range(8)
    ]
    for name in made[0].data_vars:
        values = np.stack([one[name].to_numpy() for one in made])
        assert np.mean(values**2) == pytest.approx(1.0, abs=0.2 if kind == "slow" else 0.1)


def test_waves_of_source_and_target_run_each_for_itself() -> None:
    made = predicting_series("waves", 2, 400, 1, 24, coupling="none")
    peaks = []
    for name in ("source", "target"):
        values = made[name].to_numpy().reshape(400, 24)
        power = np.abs(np.fft.fft2(values)) ** 2
        frequency, mode = np.unravel_index(power.argmax(), power.shape)
        peaks.append((frequency, mode))
        assert min(mode, 24 - mode) in (1, 2, 3)
        assert 400.0 / min(frequency, 400 - frequency) == pytest.approx(10.0, abs=2.0)
    assert peaks[0] != peaks[1]


def test_layers_are_coupled_each_with_its_own_or_one_with_the_edge() -> None:
    made = predicting_series("white", 0, 800, 3, 20, layered=True, strength=0.5, correlation_length=0.0)
    for layer in range(3):
        assert gain(made.source[:, layer], made.target[:, layer]) == pytest.approx(0.288, rel=0.12)
        assert gain(made.source[:, layer], made.target[:, layer - 1]) < 0.003
    made = predicting_series("white", 0, 800, 3, 20, layer=1, strength=0.5, correlation_length=0.0)
    found = [gain(made.source[:, layer], made.target) for layer in range(3)]
    np.testing.assert_allclose(found, [0.0, 0.288, 0.0], atol=0.03)


def test_neighbours_are_alike_in_all_series() -> None:
    made = predicting_series("ar1", 1, 2000, 1, 20, coupling="common driver", correlation_length=1.0)
    for name in ("source", "target", "driver"):
        values = made[name].to_numpy().reshape(2000, 20)
        found = np.mean(values * np.roll(values, 1, axis=1)) / np.mean(values**2)
        assert found == pytest.approx(np.exp(-0.5), abs=0.06)


def test_the_same_arguments_give_the_same_series_and_the_truth_can_be_saved(tmp_path: Any) -> None:
    first, again = (predicting_series("ar1", 4, 20, 2, 6, coupling="common driver") for _ in range(2))
    xr.testing.assert_identical(first, again)
    assert first.attrs["lags"] == (1, 2, 3)
    assert {"kind", "seed", "coupling", "strength", "jitter", "every", "gain"} <= first.attrs.keys()
    assert not np.array_equal(first.source, predicting_series("ar1", 5, 20, 2, 6).source)


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"strength": 1.0}, "strength must be"),
        ({"lags": ()}, "lags must be different whole numbers from 1 to 100"),
        ({"lags": (0, 1)}, "lags must be different whole numbers from 1 to 100"),
        ({"coupling": "three ways"}, "coupling must be one of one way, both ways, none, common driver"),
        ({"layer": 2}, "layer must be below the 2 layers, got 2"),
        ({"layer": 1, "layered": True}, "layer is for a target without layers"),
        ({"every": 0}, "every must be a whole number"),
    ],
)
def test_what_cannot_be_made_is_refused(settings: dict[str, Any], words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        cd.simulate.predicting_series("ar1", 0, 20, 2, 6, **settings)


def test_the_weights_of_one_lag_are_a_correlation() -> None:
    mix = mixing(0.6, [2], 0.0, np.eye(1, 5)[0])
    assert (mix.own, mix.leading) == pytest.approx((0.8, 0.6))
