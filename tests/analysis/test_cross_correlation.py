import re
import warnings
from typing import Any

import numpy as np
import pytest
import xarray as xr
from scipy.signal import lfilter
from scipy.stats import binom, pearsonr, spearmanr

import cytodisk as cd
from cytodisk.analysis.correlation.confidence import effective_share, fisher_interval
from cytodisk.analysis.correlation.cross_correlation import correlation_by_layer, cross_correlate
from cytodisk.analysis.correlation.peaks import peak_correlation
from cytodisk.analysis.correlation.prepared_series import prepare_series
from cytodisk.analysis.correlation.ranks import scored
from cytodisk.analysis.correlation.surrogates import surrogates
from cytodisk.errors import ParameterError, StationarityWarning
from cytodisk.simulate import coupled_series, independent_series

NAN = np.nan
FRAMES, LAYERS, SECTORS = 30, 2, 3


def noise(seed: int, *shape: int, missing: float = 0.0) -> Any:
    random = np.random.default_rng(seed)
    values = random.normal(size=shape)
    values[random.random(shape) < missing] = NAN
    return values


def named(values: Any, *dims: str, interval_s: float | None = None) -> xr.DataArray:
    array = xr.DataArray(values, dims=("time", *dims))
    labels = {"layer": np.arange(9), "sector": np.arange(99), "channel": np.array(["VASP", "actin", "Rac"])}
    array = array.assign_coords({dim: labels[dim][: array.sizes[dim]] for dim in dims if dim in labels})
    array = array.assign_coords(time=np.arange(len(values)))
    if interval_s is not None:
        array = array.assign_coords(time_s=("time", interval_s * np.arange(len(values))))
    return array


def plain(x: Any, y: Any) -> float:
    """Pearson correlation written out."""
    x, y = x - x.mean(), y - y.mean()
    return float(x @ y / np.sqrt((x @ x) * (y @ y)))


def one(a: Any, b: Any, lag: int, least: int = 10) -> tuple[float, int]:
    """Correlation of a[t] with b[t + lag], and the number of pairs."""
    frames = len(a)
    x, y = a[max(0, -lag) : frames - max(0, lag)], b[max(0, lag) : frames + min(0, lag)]
    both = np.isfinite(x) & np.isfinite(y)
    return (plain(x[both], y[both]) if both.sum() >= least else NAN), int(both.sum())


@pytest.mark.parametrize(("in_a", "in_b"), [(0.0, 0.0), (0.2, 0.0), (0.0, 0.2), (0.2, 0.2)])
@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_every_lag_of_every_window(in_a: float, in_b: float, offset: float) -> None:
    a = noise(0, FRAMES, LAYERS, SECTORS, missing=in_a) + offset
    b = noise(1, FRAMES, SECTORS, missing=in_b) - offset
    found = cross_correlate(a, b, 6)
    assert found["correlation"].dims == ("layer", "sector", "lag")
    assert found["n"].dtype == np.int64
    for layer, sector in np.ndindex(LAYERS, SECTORS):
        for lag in range(-6, 7):
            at = found.isel(layer=layer, sector=sector).sel(lag=lag)
            r, n = one(a[:, layer, sector], b[:, sector], lag)
            assert float(at["correlation"]) == pytest.approx(r, abs=1e-12, nan_ok=True)
            assert int(at["n"]) == n
    share = effective_share(a, b[:, None, :])
    np.testing.assert_allclose(found["n_effective"], found["n"] * share[..., None])
    x, y = a[:-4, 1, 2], b[4:, 2]
    both = np.isfinite(x * y)
    r = float(found["correlation"].isel(layer=1, sector=2).sel(lag=4))
    assert r == pytest.approx(pearsonr(x[both], y[both])[0], abs=1e-12)
    low, high = fisher_interval(found["correlation"].to_numpy(), found["n_effective"].to_numpy(), 0.95)
    np.testing.assert_allclose(found["low"], low)
    np.testing.assert_allclose(found["high"], high)


@pytest.mark.parametrize("missing", [0.0, 0.2])
def test_ranks_in_place_of_values(missing: float) -> None:
    a = noise(2, FRAMES, LAYERS, SECTORS, missing=missing)
    b = noise(3, FRAMES, SECTORS)
    found = cross_correlate(a, b, 4, statistic="spearman")
    assert found.attrs["statistic"] == "spearman"
    both = np.isfinite(a[:, 1, 2])
    at = found["correlation"].isel(layer=1, sector=2)
    expected = spearmanr(a[both, 1, 2], b[both, 2]).statistic
    assert float(at.sel(lag=0)) == pytest.approx(expected, abs=1e-12 if not missing else 0.02)
    again = spearmanr(a[:-4, 1, 2], b[4:, 2], nan_policy="omit").statistic
    assert float(at.sel(lag=4)) == pytest.approx(again, abs=0.08)  # ranked once, not over these pairs
    bent = cross_correlate(np.exp(3.0 * a), b**3, 4, statistic="spearman")
    np.testing.assert_allclose(found["correlation"], bent["correlation"])


def test_equal_values_share_a_rank_and_constants_have_no_correlation() -> None:
    a = np.array([3.0, 1.0, 1.0, NAN, 7.0] * 6)
    ranks = scored(a[:5], "spearman")
    np.testing.assert_array_equal(ranks, [3.0, 1.5, 1.5, NAN, 4.0])
    rounding = np.full(30, 0.1) + 1e-17 * np.arange(30)
    found = cross_correlate(np.stack([a, rounding], axis=1), noise(0, 30, 2), 2, statistic="spearman")
    assert np.isfinite(found["correlation"].isel(sector=0)).all()
    assert np.isnan(found["correlation"].isel(sector=1)).all()


def test_a_common_pulse_outweighs_values_and_not_ranks() -> None:
    shares = {"pearson": 0.0, "spearman": 0.0}
    for seed in range(1000, 1006):
        a, b = independent_series("white", seed, 80, 2, 12)
        pulse = 8.0 * (np.abs(a["frame"] - 40) < 2)
        for statistic in ("pearson", "spearman"):
            found = cross_correlate(a + pulse, b + pulse, 8, statistic=statistic, surrogates=99)
            shares[statistic] += float((peak_correlation(found)["p"] <= 0.05).mean()) / 6
    assert shares["pearson"] > 0.9
    assert shares["spearman"] < 0.2


@pytest.mark.parametrize("lag", [-3, 0, 4])
def test_positive_lag_when_b_follows(lag: int) -> None:
    long = noise(2, 60, 2)
    a, b = long[10:50], -long[10 - lag : 50 - lag]
    peak = peak_correlation(cross_correlate(a, b, 8))
    assert peak["lag"].to_numpy().tolist() == [lag, lag]
    np.testing.assert_allclose(peak["correlation"], -1.0, atol=1e-12)


@pytest.mark.parametrize(
    "options",
    [
        {"detrend": "linear"},
        {"detrend": "median", "detrend_frames": 7},
        {"detrend": "median"},
        {"difference": True},
        {"detrend": "linear", "difference": True, "zscore": True},
    ],
)
def test_both_are_prepared(options: Any) -> None:
    a, b = noise(3, 2, 40, SECTORS).cumsum(axis=1)
    prepared = {"detrend_frames": 4 * 5 + 1} | options if options.get("detrend") == "median" else options
    expected = cross_correlate(prepare_series(a, **prepared), prepare_series(b, **prepared), 5)
    found = cross_correlate(a, b, 5, **options)
    np.testing.assert_array_equal(found["correlation"], expected["correlation"])
    assert {name: found.attrs[name] for name in prepared} == prepared


def test_zscore_changes_no_correlation() -> None:
    a, b = noise(4, 2, 40, SECTORS)
    plain, scaled = cross_correlate(a, b, 5), cross_correlate(a, b, 5, zscore=True)
    np.testing.assert_allclose(plain["correlation"], scaled["correlation"], atol=1e-12)


B_DIMS = {
    "its own sectors": ("sector",),
    "one for all": (),
    "one a layer": ("layer",),
    "all of its windows": ("layer", "sector"),
    "in another order": ("sector", "layer"),
    "channels that a lacks": ("channel", "sector"),
    "all and more": ("channel", "sector", "layer"),
}


@pytest.mark.parametrize(
    "a_dims", [("layer", "sector"), ("sector", "layer"), ("sector",), ("channel", "layer", "sector")]
)
@pytest.mark.parametrize("kind", B_DIMS)
@pytest.mark.parametrize("count", [0, 3])
def test_broadcasting_by_name(a_dims: Any, kind: str, count: int) -> None:
    sizes = {"layer": LAYERS, "sector": SECTORS, "channel": 3}
    b_dims = B_DIMS[kind]
    a = named(noise(5, FRAMES, *(sizes[dim] for dim in a_dims)), *a_dims, interval_s=2.0)
    b = named(noise(6, FRAMES, *(sizes[dim] for dim in b_dims)), *b_dims)
    found = cross_correlate(a, b, 2, surrogates=count, seed=1)
    dims = tuple(dict.fromkeys((*a_dims, *b_dims)))
    assert found["correlation"].dims == (*dims, "lag")
    for dim in dims:
        xr.testing.assert_equal(found[dim], (a if dim in a_dims else b)[dim])
    np.testing.assert_array_equal(found["lag_s"], 2.0 * found["lag"])
    assert found["lag_s"].attrs["units"] == "s"
    assert found["lag"].attrs["units"] == "frame"
    wide_a, wide_b = xr.broadcast(a, b)
    make = surrogates("phase", FRAMES, count, 1).alone if count else None
    for place in np.ndindex(tuple(sizes[dim] for dim in dims)):
        at = dict(zip(dims, place, strict=True))
        x, y = (series.isel(at).to_numpy() for series in (wide_a, wide_b))
        expected = [one(x, y, lag)[0] for lag in range(-2, 3)]
        np.testing.assert_allclose(found["correlation"].isel(at), expected, atol=1e-12)
        if make is not None:
            chance = [max(abs(one(x, z, lag)[0]) for lag in range(-2, 3)) for z in make(y).T]
            np.testing.assert_allclose(found["null"].isel(at), chance, atol=1e-12)
    if count:
        assert found["null"].dims == ("surrogate", *dims)
        assert found["threshold"].dims == dims


def test_layer_0_as_the_other_signal() -> None:
    a = named(noise(7, FRAMES, LAYERS, SECTORS), "layer", "sector")
    found = cross_correlate(a, a.sel(layer=0), 1)  # keeps its layer as a scalar coordinate
    np.testing.assert_allclose(found["correlation"].sel(layer=0, lag=0), 1.0, atol=1e-12)
    np.testing.assert_allclose(
        found["correlation"].isel(layer=1, sector=2).sel(lag=1),
        one(a.to_numpy()[:, 1, 2], a.to_numpy()[:, 0, 2], 1)[0],
        atol=1e-12,
    )


@pytest.mark.parametrize("dims", [(), ("sector",), ("layer", "sector"), ("channel", "layer", "sector")])
def test_arrays_without_names(dims: Any) -> None:
    shape = tuple({"channel": 3, "layer": LAYERS, "sector": SECTORS}[dim] for dim in dims)
    a, b = noise(8, FRAMES, *shape), noise(9, FRAMES)
    found = cross_correlate(a.tolist(), b, 2)
    assert found["correlation"].dims == (*dims, "lag")
    assert set(found.coords) == {"lag"}
    named_too = cross_correlate(xr.DataArray(a, dims=("time", *dims)), named(b), 2)
    np.testing.assert_array_equal(found["correlation"], named_too["correlation"])


def test_time_may_be_anywhere() -> None:
    a, b = named(noise(10, FRAMES, SECTORS), "sector"), named(noise(11, FRAMES, SECTORS), "sector")
    xr.testing.assert_identical(cross_correlate(a.T, b, 2), cross_correlate(a, b.T, 2))


def test_seconds_of_either() -> None:
    a, b = named(noise(12, FRAMES), interval_s=0.1), named(noise(13, FRAMES))
    for pair in ((a, b), (b, a), (a, a)):
        np.testing.assert_allclose(cross_correlate(*pair, 2)["lag_s"], [-0.2, -0.1, 0.0, 0.1, 0.2])
    assert "lag_s" not in cross_correlate(b, b, 2).coords
    late = named(noise(14, FRAMES), interval_s=1e-3).assign_coords(
        time_s=("time", 1e5 + 1e-3 * np.arange(FRAMES))
    )
    np.testing.assert_allclose(cross_correlate(late, late, 2)["lag_s"], 1e-3 * np.arange(-2, 3))


def test_what_has_no_correlation() -> None:
    a, b = noise(15, FRAMES, 4), noise(16, FRAMES, 4)
    a[:, 1], a[:, 2], b[:, 3] = 0.1, NAN, 7.0
    found = cross_correlate(a, b, 3, surrogates=19)
    assert np.isfinite(found["correlation"][0]).all()
    for name in ("correlation", "low", "high", "null", "threshold"):
        assert np.isnan(found[name].isel(sector=[1, 2, 3])).all()
    np.testing.assert_array_equal(found["n"][2], 0)
    peak = peak_correlation(found)
    for name in ("correlation", "lag", "p", "q"):
        assert np.isnan(peak[name][1:]).all()
        assert np.isfinite(peak[name][0])
    mean = correlation_by_layer(found)  # of the one sector that has a correlation
    np.testing.assert_allclose(mean["correlation"], found["correlation"][0])
    assert np.isfinite(mean["null"]).all()


@pytest.mark.parametrize("options", [{"detrend": "linear"}, {"difference": True}, {}])
def test_rounding_does_not_correlate(options: Any) -> None:
    line = np.full(FRAMES, 100.0) * (1.0 + 1e-15 * noise(17, FRAMES))
    if options:
        line = 5.0 + 0.1 * np.arange(FRAMES)
    assert np.isnan(cross_correlate(line, noise(18, FRAMES), 3, **options)["correlation"]).all()


def test_lags_without_enough_pairs_are_nan() -> None:
    a = noise(19, FRAMES, 1)
    a[12:] = NAN
    found = cross_correlate(a, noise(20, FRAMES, 1), 15)
    np.testing.assert_array_equal(np.isfinite(found["correlation"][0]), found["n"][0] >= 10)
    np.testing.assert_array_equal(found["n"][0].sel(lag=[-15, -12, -2, 0, 15]), [0, 0, 10, 12, 12])
    correlation_by_layer(found)  # no warning of lags without a correlation


GOOD = noise(21, FRAMES, SECTORS)
FAULTS: dict[str, tuple[Any, Any, str]] = {
    "a Dataset": (
        xr.Dataset({"mean": (("time", "sector"), GOOD)}),
        GOOD,
        r"a is a Dataset: pass one of its variables",
    ),
    "b a Dataset": (GOOD, xr.Dataset(), "b is a Dataset"),
    "strings": (np.full((FRAMES, 2), "x"), GOOD, "a must hold numbers, got dtype <U1"),
    "complex": (GOOD, GOOD * 1j, "b must hold numbers, got dtype complex128"),
    "a number": (3.0, GOOD, r"a must have time first and up to three more axes, got shape \(\)"),
    "a name": ("velocity", GOOD, "a must have time first"),
    "five axes": (np.zeros((FRAMES, 1, 1, 1, 1)), GOOD, "a must have time first and up to three more axes"),
    "nothing": (GOOD[:, :0], GOOD, r"a is empty, shape \(30, 0\)"),
    "infinite": (np.where(GOOD.max() == GOOD, np.inf, GOOD), GOOD, "a holds infinite numbers: put NaN where"),
    "no time": (
        xr.DataArray(GOOD, dims=("frame", "sector")),
        GOOD,
        r"a has the dims \['frame', 'sector'\]: one must be time",
    ),
    "a correlation": (xr.DataArray(GOOD, dims=("time", "lag")), GOOD, "pass series in time"),
    "fewer frames": (GOOD[1:], GOOD, "a has 29 frames, b 30: pass the same frames of both"),
    "other frames": (
        named(GOOD, "sector"),
        named(GOOD, "sector").assign_coords(time=np.arange(5, 5 + FRAMES)),
        "a and b do not have the same frames and windows",
    ),
    "other frames, by other names": (
        xr.DataArray(GOOD, {"frame": ("time", np.arange(FRAMES))}, ("time", "sector")),
        xr.DataArray(GOOD, {"time": np.arange(5, 5 + FRAMES)}, ("time", "sector")),
        "a and b do not have the same frames and windows: frame of a begins with 0, time of b with 5",
    ),
    "other sectors": (GOOD, noise(0, FRAMES, SECTORS + 1), "a and b do not have the same frames and windows"),
    "other intervals": (
        named(GOOD, "sector", interval_s=1.0),
        named(GOOD, "sector", interval_s=2.0),
        r"a and b have other seconds between frames: \[1.0, 2.0\]",
    ),
    "uneven time": (
        named(GOOD, "sector").isel(time=[0, 1, 2, 4, 5]),
        GOOD[:5],
        "a has frames 1 to 2 apart in time: lags need even steps, so put NaN where a frame is missing",
    ),
    "uneven seconds": (
        GOOD,
        named(GOOD, "sector").assign_coords(time_s=("time", np.arange(FRAMES) ** 1.5)),
        "b has frames .* apart in time_s",
    ),
    "backwards": (named(GOOD, "sector")[::-1], GOOD, "a goes back in time, or stands still: sort it by time"),
    "standing still": (
        GOOD,
        named(GOOD, "sector").assign_coords(time_s=("time", np.zeros(FRAMES))),
        "b goes back in time_s, or stands still",
    ),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_series_that_cannot_be_correlated(fault: str) -> None:
    a, b, message = FAULTS[fault]
    with pytest.raises(ParameterError, match=message):
        cross_correlate(a, b, 2)


@pytest.mark.parametrize(
    ("frames", "max_lag", "message"),
    [
        (1, 0, "max_lag 0 leaves 1 pairs of 1 frames, fewer than min_pairs 10: that is too short a movie"),
        (8, 20, "max_lag 20 leaves 0 pairs of 8 frames, fewer than min_pairs 10: that is too short"),
        (30, 21, "max_lag 21 leaves 9 pairs of 30 frames, fewer than min_pairs 10: pass at most 20"),
        (30, 99, "pass at most 20"),
    ],
)
def test_too_short_a_movie(frames: int, max_lag: int, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        cross_correlate(noise(0, frames), noise(1, frames), max_lag)


def test_the_longest_lag() -> None:
    found = cross_correlate(GOOD, GOOD, 20)
    assert np.isfinite(found["correlation"]).all()
    assert int(found["n"].min()) == 10


@pytest.mark.parametrize("value", [-1, 2.5, True, None, "3", NAN])
@pytest.mark.parametrize("name", ["max_lag", "min_pairs", "surrogates", "seed"])
def test_numbers_that_make_no_sense(name: str, value: Any) -> None:
    options = {"max_lag": 2, "surrogates": 3} | {name: value}
    message = rf"{name} must be a whole number (of at least \d|from \d to \d+), got {re.escape(repr(value))}"
    with pytest.raises(ParameterError, match=message):
        cross_correlate(GOOD, GOOD, **options)


def test_whole_numbers_may_be_floats() -> None:
    floats = cross_correlate(GOOD, GOOD, 2.0, min_pairs=4.0, surrogates=3.0, seed=1.0)  # type: ignore[arg-type]
    ints = cross_correlate(GOOD, GOOD, 2, min_pairs=4, surrogates=3, seed=1)
    xr.testing.assert_equal(floats, ints)


@pytest.mark.parametrize("count", [0, 3])
def test_an_unknown_null(count: int) -> None:
    with pytest.raises(ParameterError, match=r"null.*phase, shift.*'noise'"):
        cross_correlate(GOOD, GOOD, 2, surrogates=count, null="noise")  # type: ignore[arg-type]


def test_random_walks_are_warned_of() -> None:
    walks, still = noise(22, 100, 20).cumsum(axis=0), noise(23, 100, 20)
    with pytest.warns(StationarityWarning, match=r"\d+%.*drifts") as caught:
        found = cross_correlate(walks, still, 5)
    assert len(caught) == 1
    assert caught[0].filename == __file__
    assert found.attrs["drifting_a"] > 0.5 > found.attrs["drifting_b"]
    with pytest.warns(StationarityWarning, match="of the series of b drifts"):
        cross_correlate(still, walks, 5)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        cross_correlate(still, still, 5)
        cross_correlate(walks, walks, 5, difference=True)


def test_progress_and_seed() -> None:
    seen: list[tuple[int, int]] = []
    first = cross_correlate(GOOD, GOOD[:, ::-1], 2, surrogates=9, progress=lambda *step: seen.append(step))
    assert seen == [(1, 3), (2, 3), (3, 3)]
    xr.testing.assert_identical(first, cross_correlate(GOOD, GOOD[:, ::-1], 2, surrogates=9))
    other = cross_correlate(GOOD, GOOD[:, ::-1], 2, surrogates=9, seed=1)
    assert not np.array_equal(first["null"], other["null"])
    np.testing.assert_array_equal(first["correlation"], other["correlation"])


@pytest.mark.parametrize("null", ["phase", "shift"])
@pytest.mark.parametrize("missing", [0.0, 0.1])
@pytest.mark.parametrize("b_dims", [("sector",), ("layer", "sector"), ()])
def test_layers_by_brute_force(null: Any, missing: float, b_dims: Any) -> None:
    sizes = {"layer": LAYERS, "sector": SECTORS}
    a = named(noise(24, FRAMES, LAYERS, SECTORS, missing=missing), "layer", "sector")
    b = named(noise(25, FRAMES, *(sizes[dim] for dim in b_dims), missing=missing), *b_dims)
    found = cross_correlate(a, b, 3, surrogates=19, null=null, seed=2)
    mean = correlation_by_layer(found)
    assert mean["correlation"].dims == ("layer", "lag")
    table = found["correlation"].to_numpy()
    np.testing.assert_allclose(mean["correlation"], table.mean(axis=1), atol=1e-12)
    for name, share in (("lower_quartile", 0.25), ("upper_quartile", 0.75)):
        np.testing.assert_allclose(mean[name], np.quantile(table, share, axis=1), atol=1e-12)
    changed = surrogates(null, FRAMES, 19, 2, 3)
    make, count = changed.together, changed.count
    wide = b.broadcast_like(a).transpose("time", "layer", "sector").to_numpy()
    for layer in range(LAYERS):
        largest = []
        for k in range(count):
            curves = [
                [
                    one(a.to_numpy()[:, layer, s], make(wide[:, layer, s])[:, k], lag)[0]
                    for lag in range(-3, 4)
                ]
                for s in range(SECTORS)
            ]
            largest.append(np.abs(np.mean(curves, axis=0)).max())
        np.testing.assert_allclose(mean["null"][:, layer], largest, atol=1e-12)
        assert float(mean["threshold"][layer]) == pytest.approx(max(largest), abs=1e-12)
        peak = peak_correlation(mean, rule="largest").isel(layer=layer)
        r = np.abs(table.mean(axis=1)[layer]).max()
        assert float(peak["p"]) == (1 + sum(value >= r for value in largest)) / (count + 1)


@pytest.mark.parametrize("what", [None, 3, np.zeros((3, 4)), xr.Dataset()])
def test_what_has_no_layers(what: Any) -> None:
    with pytest.raises(ParameterError, match=r"cross_correlate.*sectors"):
        correlation_by_layer(what)
    with pytest.raises(ParameterError, match="with sectors"):
        correlation_by_layer(cross_correlate(GOOD[:, 0], GOOD[:, 1], 2))


def test_neighbours_that_move_together_are_not_taken_for_independent() -> None:
    common = noise(26, 60)
    together = cross_correlate(
        noise(27, 60)[:, None] * np.ones(8), common[:, None] * np.ones(8), 3, surrogates=199
    )
    apart = cross_correlate(noise(28, 60, 8), noise(29, 60, 8), 3, surrogates=199)
    one_alone = float(together["threshold"][0])
    assert float(correlation_by_layer(together)["threshold"]) == pytest.approx(one_alone, rel=0.15)
    assert float(correlation_by_layer(apart)["threshold"]) < 0.6 * one_alone


def waves(seed: int, frames: int, sectors: int) -> Any:
    """A pattern that runs from sector to sector, one a frame, with noise of each sector."""
    long = lfilter([1.0], [1.0, -0.8], noise(seed, frames + sectors + 50))[50:]
    running = np.stack([long[k : k + frames] for k in range(sectors)], axis=1)
    return running + 0.3 * noise(seed + 1, frames, sectors)


def staggered(seed: int, frames: int, sectors: int) -> Any:
    """A common signal, of which sectors miss the more first frames the farther they are along."""
    values = noise(seed, frames)[:, None] + 0.3 * noise(seed + 1, frames, sectors)
    values[np.arange(frames)[:, None] < np.arange(sectors)] = NAN
    return values


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::cytodisk.errors.StationarityWarning")  # waves are slow
@pytest.mark.parametrize("make", [waves, staggered])
def test_means_over_sectors_that_hang_together_are_rarely_called_correlated(make: Any) -> None:
    """Waves that run along the edge, and sectors that begin late: half were called so when only the
    correlation at lag 0, or of sectors with the same frames, was kept."""
    called = []
    for seed in range(0, 400, 4):
        found = cross_correlate(make(seed, 60, 12), make(seed + 2, 60, 12), 8, surrogates=59)
        called.append(float(peak_correlation(correlation_by_layer(found))["p"]) <= 0.05)
    assert sum(called) <= binom.ppf(
        0.999, 100, 0.1
    )  # waves are few patterns, so that the level is not held quite


@pytest.mark.parametrize("kind", ["white", "ar1", "smooth", "oscillating"])
def test_independent_series_are_rarely_called_correlated(kind: Any) -> None:
    a, b = independent_series(kind, 1, 80, 1, 300, correlation_length=0.0)
    found = cross_correlate(a, b, 10, surrogates=99)
    count = int((peak_correlation(found)["p"] <= 0.05).sum())
    assert binom.ppf(0.0005, 300, 0.05) <= count <= binom.ppf(0.9995, 300, 0.05)


def test_what_is_coupled_is_found_and_the_rest_is_not() -> None:
    windows = np.zeros((2, 24), dtype=bool)
    windows[0, :12] = True
    a, b = coupled_series(
        "ar1", 2, 200, 2, 24, lag_frames=4, windows=windows, strength=0.8, correlation_length=0.0
    )
    peak = peak_correlation(cd.cross_correlate(a, b, 12, surrogates=99))  # a follows b
    found = peak["q"].to_numpy() < 0.05
    assert found[windows].all()
    assert found[~windows].mean() < 0.05
    np.testing.assert_array_equal(peak["lag"].to_numpy()[windows], -4)


def test_a_frame_that_is_one_number_counts_for_nothing() -> None:
    without = cross_correlate(GOOD, GOOD, 2)
    found = cross_correlate(named(GOOD, "sector").assign_coords(frame=3, time_s=1.5), GOOD, 2)
    np.testing.assert_array_equal(found["correlation"], without["correlation"])


def test_a_seed_may_be_longer_than_64_bits() -> None:
    found = cross_correlate(GOOD, GOOD, 2, surrogates=3, seed=2**70)
    assert found.attrs["seed"] == 2**70
    xr.testing.assert_identical(found, cross_correlate(GOOD, GOOD, 2, surrogates=3, seed=2**70))
