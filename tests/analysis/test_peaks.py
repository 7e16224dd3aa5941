import warnings
from typing import Any, get_args

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.stats import false_discovery_control
from statsmodels.stats.multitest import multipletests

from cytodisk.analysis.correlation.correlation_parameters import Rule
from cytodisk.analysis.correlation.cross_correlation import cross_correlate
from cytodisk.analysis.correlation.peaks import false_discovery, find_peak, p_value, peak_correlation
from cytodisk.errors import ParameterError

NAN = np.nan
LAGS = np.arange(-3, 4)

CURVES = {  # -3, -2, -1, 0, 1, 2, 3: the lag by the paper's rule, and that of the largest magnitude
    "both, the negative nearer": ([0.0, 0.0, -0.4, 0.0, 0.0, 0.0, 0.9], -1, 3),
    "both, the positive nearer": ([-0.9, 0.0, 0.0, 0.0, 0.3, 0.0, 0.0], 1, -3),
    "as near, the positive larger": ([0.0, 0.5, 0.0, 0.0, 0.0, -0.4, 0.0], -2, -2),
    "as near, the negative larger": ([0.0, 0.4, 0.0, 0.0, 0.0, -0.5, 0.0], 2, 2),
    "as near and as large": ([0.0, 0.5, 0.0, 0.0, 0.0, -0.5, 0.0], -2, -2),
    "all positive, its minimum at 0": ([0.2, 0.6, 0.2, 0.1, 0.2, 0.2, 0.3], -2, -2),
    "all negative, its maximum at 0": ([-0.2, -0.6, -0.2, -0.1, -0.2, -0.2, -0.3], -2, -2),
    "the same height twice": ([0.5, 0.0, 0.1, 0.0, 0.5, 0.0, 0.0], 1, 1),
    "the same depth twice": ([-0.5, 0.0, 0.0, 0.0, 0.0, -0.5, 0.0], 2, 2),
    "with gaps": ([NAN, 0.7, NAN, NAN, -0.3, NAN, NAN], 1, -2),
    "one value": ([NAN, NAN, -0.1, NAN, NAN, NAN, NAN], -1, -1),
    "flat": ([0.0] * 7, 0, 0),
    "0 and negative": ([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.2], 3, 3),
    "0 and positive": ([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.2], 3, 3),
}


@pytest.mark.parametrize("name", CURVES)
def test_curves_made_by_hand(name: str) -> None:
    curve, nearest, largest = CURVES[name]
    for rule, lag in (("nearest", nearest), ("largest", largest)):
        place, value = find_peak(np.array(curve), LAGS, rule)  # type: ignore[arg-type]
        assert LAGS[place] == lag
        assert value == curve[int(place)]


def test_many_curves_at_once() -> None:
    stacked = np.stack([curve for curve, _, _ in CURVES.values()], axis=1).reshape(7, 2, -1)
    place, value = find_peak(stacked, LAGS, "nearest")
    assert place.shape == value.shape == (2, len(CURVES) // 2)
    assert LAGS[place].ravel().tolist() == [nearest for _, nearest, _ in CURVES.values()]


def test_no_value_at_all() -> None:
    for rule in get_args(Rule):
        for threshold in (None, np.array(NAN), np.array(0.3)):
            _, value = find_peak(np.full(7, NAN), LAGS, rule, threshold)
            assert np.isnan(value)


@pytest.mark.parametrize(
    ("threshold", "lag"),
    [(0.0, 0), (0.05, 0), (0.1, 0), (0.2, 1), (0.5, 3), (0.9, 3), (0.95, 0), (NAN, 0)],
)
def test_peaks_that_reach_the_threshold_go_first(threshold: float, lag: int) -> None:
    curve = np.array([0.0, 0.0, 0.0, -0.1, 0.2, -0.05, 0.9])
    # of 0.9 and the most negative; with 0.2 there is no negative one left that counts
    expected = {0.2: 3}.get(threshold, lag)
    place, value = find_peak(curve, LAGS, "nearest", np.array(threshold))
    assert LAGS[place] == expected
    assert value == curve[int(place)]


def test_of_two_that_reach_the_threshold_the_nearer() -> None:
    curve = np.array([0.9, 0.0, -0.1, 0.3, 0.0, -0.6, 0.0])
    assert LAGS[find_peak(curve, LAGS, "nearest", np.array(0.5))[0]] == 2
    assert LAGS[find_peak(curve, LAGS, "nearest", np.array(0.7))[0]] == -3
    assert LAGS[find_peak(-curve, LAGS, "nearest", np.array(0.7))[0]] == -3
    assert LAGS[find_peak(curve, LAGS, "largest", np.array(0.95))[0]] == -3


@given(arrays(np.float64, (7,), elements=st.sampled_from([-0.5, -0.2, 0.0, 0.2, 0.5, NAN])))
def test_the_rule_written_out(curve: Any) -> None:
    if np.isnan(curve).all():
        return
    away = {i: abs(int(LAGS[i])) for i in range(7) if np.isfinite(curve[i])}
    top = min(away, key=lambda i: (-curve[i], away[i]))
    bottom = min(away, key=lambda i: (curve[i], away[i]))
    candidates = [i for i, good in ((top, curve[top] > 0), (bottom, curve[bottom] < 0)) if good]
    _, value = find_peak(curve, LAGS, "nearest")
    expected = min(candidates, key=lambda i: (away[i], -abs(curve[i]))) if candidates else top
    assert value == curve[expected]
    place, value = find_peak(curve, LAGS, "largest")
    assert abs(value) == np.nanmax(np.abs(curve))
    assert away[int(place)] == min(away[i] for i in away if abs(curve[i]) == abs(value))


@given(arrays(np.float64, st.tuples(st.integers(1, 8), st.integers(1, 6)), elements=st.floats(0.001, 1.0)))
def test_false_discovery_is_that_of_scipy_and_statsmodels(p: Any) -> None:
    q = false_discovery(p)
    np.testing.assert_allclose(q.ravel(), false_discovery_control(p.ravel()), rtol=1e-12)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FutureWarning)  # what it will return one day
        adjusted = multipletests(p.ravel(), method="fdr_bh")[1]
    np.testing.assert_allclose(q.ravel(), adjusted, rtol=1e-12)
    assert ((q >= p) & (q <= 1.0)).all()


def test_false_discovery_leaves_nan_out() -> None:
    p = np.array([[0.01, NAN], [0.02, 0.04]])
    np.testing.assert_allclose(false_discovery(p), [[0.03, NAN], [0.03, 0.04]])
    assert np.isnan(false_discovery(np.full(3, NAN))).all()
    assert false_discovery(np.zeros(0)).shape == (0,)


def test_p_counts_what_was_found_in() -> None:
    null = np.array([[0.1, NAN], [0.2, NAN], [0.3, NAN]])
    for found, p in ((0.05, 1.0), (-0.2, 0.75), (0.25, 0.5), (-0.9, 0.25)):
        assert p_value(np.array([found, found]), null).tolist() == [p, 1.0]
    assert np.isnan(p_value(np.array([NAN, NAN]), null)).all()


@given(
    arrays(np.float64, (20, 3), elements=st.floats(0.0, 1.0)),
    arrays(np.float64, 3, elements=st.floats(-1.0, 1.0)),
)
def test_p_is_never_0(null: Any, found: Any) -> None:
    p = p_value(found, null)
    assert ((p >= 1.0 / 21.0) & (p <= 1.0)).all()


def correlations(curves: Any, **more: Any) -> xr.Dataset:
    """Curves of two sectors as `cross_correlate` returns them."""
    coords = {"lag": LAGS, "lag_s": ("lag", 2.5 * LAGS), "sector": [4, 7]}
    data = {"correlation": (("sector", "lag"), np.asarray(curves)), **more}
    return xr.Dataset(data, coords, attrs={"seed": 3})


def test_what_the_peak_says() -> None:
    table = np.arange(14.0).reshape(2, 7)
    found = correlations(
        [CURVES["both, the negative nearer"][0], [NAN] * 7],
        n=(("sector", "lag"), table.astype(np.int64)),
        low=(("sector", "lag"), -table),
    )
    peak = peak_correlation(found)
    assert peak["sector"].to_numpy().tolist() == [4, 7]
    np.testing.assert_array_equal(peak["correlation"], [-0.4, NAN])
    np.testing.assert_array_equal(peak["lag"], [-1, NAN])
    np.testing.assert_array_equal(peak["lag_s"], [-2.5, NAN])
    np.testing.assert_array_equal(peak["n"], [2, NAN])
    np.testing.assert_array_equal(peak["low"], [-2, NAN])
    assert {name: peak[name].attrs.get("units") for name in ("lag", "lag_s")} == {
        "lag": "frame",
        "lag_s": "s",
    }
    assert peak.attrs == {"seed": 3, "rule": "nearest"}
    assert not {"p", "q", "high"} & set(peak)
    assert peak_correlation(found, rule="largest")["lag"][0] == 3


def test_dims_in_another_order() -> None:
    random = np.random.default_rng(0)
    a, b = random.normal(size=(2, 40, 3, 4))
    found = cross_correlate(a, b[:, 0], 4, surrogates=19)
    for rule in get_args(Rule):
        expected = peak_correlation(found, rule=rule)
        turned = peak_correlation(found.transpose("lag", "sector", "surrogate", "layer"), rule=rule)
        xr.testing.assert_allclose(turned.transpose("layer", "sector"), expected)


def test_p_of_a_small_case_by_brute_force() -> None:
    random = np.random.default_rng(1)
    a, b = random.normal(size=(2, 30, 2))
    b[2:, 0] += 0.9 * a[:-2, 0]
    found = cross_correlate(a, b, 3, surrogates=39, seed=5)
    turns = np.exp(1j * np.random.default_rng(5).uniform(0.0, 2.0 * np.pi, (31, 39)))
    peak = peak_correlation(found)
    for sector in range(2):
        ring = np.concatenate([b[:, sector], b[::-1, sector]]) - b[:, sector].mean()
        largest = []
        for turn in turns.T:
            changed = np.fft.irfft(np.fft.rfft(ring) * turn, 60)[:30]
            rs = [
                np.corrcoef(
                    a[max(0, -lag) : 30 - max(0, lag), sector], changed[max(0, lag) : 30 + min(0, lag)]
                )[0, 1]
                for lag in LAGS
            ]
            largest.append(np.abs(rs).max())
        r = abs(float(peak["correlation"][sector]))
        assert float(peak["p"][sector]) == (1 + sum(one >= r for one in largest)) / 40
        assert float(found["threshold"][sector]) == pytest.approx(sorted(largest)[-2], abs=1e-12)  # 5 % of 39
    assert float(peak["lag"][0]) == 2.0
    assert float(peak["p"][0]) <= 0.05 < float(peak["p"][1])
    np.testing.assert_allclose(peak["q"], false_discovery_control(peak["p"]))


@pytest.mark.parametrize(
    "what", [None, 3, xr.Dataset({"correlation": ("time", np.zeros(3))}), np.zeros((3, 4))]
)
def test_what_is_no_correlation(what: Any) -> None:
    with pytest.raises(ParameterError, match=r"correlations.*cross_correlate"):
        peak_correlation(what)


def test_an_unknown_rule() -> None:
    with pytest.raises(ParameterError, match=r"rule.*'first'"):
        peak_correlation(correlations(np.zeros((2, 7))), rule="first")  # type: ignore[arg-type]
