from typing import Any

import numpy as np
import pytest
import xarray as xr

from cytodisk.analysis.correlation.prepared_series import prepare_series
from cytodisk.analysis.correlation.surrogates import surrogates
from cytodisk.analysis.pairs.pair_correlation import correlate_pairs
from cytodisk.analysis.pairs.window_distances import disk_distances
from cytodisk.errors import ParameterError, StationarityWarning

NAN = np.nan
LAYERS, SECTORS, FRAMES = 2, 3, 30
WINDOWS = LAYERS * SECTORS
DIMS = ("layer", "sector", "other_layer", "other_sector")


def noise(seed: int, *shape: int, missing: float = 0.0) -> Any:
    random = np.random.default_rng(seed)
    values = random.normal(size=shape)
    values[random.random(shape) < missing] = NAN
    return values


def some_distances(seed: int = 0) -> Any:
    """Between random places, (W, W)."""
    places = np.random.default_rng(seed).uniform(0.0, 50.0, (WINDOWS, 2))
    return np.linalg.norm(places[:, None] - places, axis=2)


def by_hand(a: Any, b: Any, lag: int, least: int = 10) -> Any:
    """Correlation of each window of a with each of b, (W, W)."""
    table = np.full((WINDOWS, WINDOWS), NAN)
    x, y = a.reshape(len(a), -1), b.reshape(len(b), -1)
    x, y = x[max(0, -lag) : len(x) - max(0, lag)], y[max(0, lag) : len(y) + min(0, lag)]
    for i, k in np.ndindex(WINDOWS, WINDOWS):
        both = np.isfinite(x[:, i] * y[:, k])
        if both.sum() >= least:
            table[i, k] = np.corrcoef(x[both, i], y[both, k])[0, 1]
    return table


def in_bin(distances: Any, number: int, bins: int) -> Any:
    """Which pairs lie in a bin, 0 for windows with themselves."""
    if number == 0:
        return distances == 0.0
    edges = np.linspace(0.0, distances.max(), bins + 1)
    return (distances > edges[number - 1]) & (distances <= edges[number])


@pytest.mark.parametrize(("in_a", "in_b"), [(0.0, 0.0), (0.2, 0.0), (0.2, 0.2)])
@pytest.mark.parametrize("options", [{}, {"detrend": "linear"}, {"difference": True}, {"detrend": "median"}])
def test_by_brute_force(in_a: float, in_b: float, options: Any) -> None:
    a = noise(0, 40, LAYERS, SECTORS, missing=in_a) + 1e3
    b = noise(1, 40, LAYERS, SECTORS, missing=in_b)
    distances = some_distances()
    found = correlate_pairs(a, b, 3, distances=distances, bins=4, **options)
    assert found["correlation"].dims == ("distance", "lag")
    edges = np.linspace(0.0, distances.max(), 5)
    np.testing.assert_allclose(found["distance"], [0.0, *(0.5 * (edges[:-1] + edges[1:]))])
    frames = {"detrend_frames": 13} if options.get("detrend") == "median" else {}
    ready = [prepare_series(series, **options, **frames) for series in (a, b)]
    for lag in range(-3, 4):
        table = by_hand(*ready, lag)
        for number in range(5):
            values = table[in_bin(distances, number, 4)]
            values = values[np.isfinite(values)]
            at = found.isel(distance=number).sel(lag=lag)
            assert float(at["n"]) == len(values)
            assert float(at["correlation"]) == pytest.approx(values.mean(), abs=1e-12)
            assert float(at["sd"]) == pytest.approx(values.std(), abs=1e-9)
            for name, share in (("lower_quartile", 0.25), ("upper_quartile", 0.75)):
                expected = np.quantile(values, share, method="inverted_cdf")
                assert float(at[name]) == pytest.approx(expected, abs=0.005)


@pytest.mark.parametrize("step", [1, 2, -3])
def test_a_travelling_wave_comes_later_the_further_it_goes(step: int) -> None:
    long = np.random.default_rng(2).normal(size=400)
    sectors = np.arange(8)
    wave = np.stack([long[60 - step * k : 360 - step * k] for k in sectors], axis=1)  # k later by step frames
    away = np.abs(sectors[:, None] - sectors).astype(float)
    found = correlate_pairs(wave[:, None], wave[:, None], 21, distances=away, bins=7)
    np.testing.assert_allclose(found["distance"], [0.0, *(np.arange(7) + 0.5)])
    for distance in range(8):
        at = found.isel(distance=distance)
        lag = abs(step) * distance
        for sign in (-1, 1):  # half of the pairs go with the wave, half against it
            here = at.sel(lag=sign * lag)
            assert float(here["upper_quartile"]) == 1.0
            assert float(here["correlation"]) == pytest.approx(1.0 if lag == 0 else 0.5, abs=0.06)
        others = at.drop_sel(lag=[-lag, lag] if lag else [0])
        assert float(np.abs(others["correlation"]).max()) < 0.25
    first = np.repeat(wave[:, None, :1], 8, axis=2)
    against = correlate_pairs(wave[:, None], first, 21, distances=away, bins=7).isel(distance=7)
    assert float(against["upper_quartile"].sel(lag=-7 * step)) == 1.0  # sector 7 has it after sector 0
    assert float(against["upper_quartile"].sel(lag=7 * step)) < 0.3


def test_a_before_b_is_a_positive_lag() -> None:
    a = noise(3, 60, 1, 4)
    found = correlate_pairs(a[5:55], a[2:52], 5, distances=np.zeros((4, 4)))  # b[t + 3] = a[t]
    same = np.mean([np.corrcoef(a[5:52, 0, i], a[5:52, 0, k])[0, 1] for i in range(4) for k in range(4)])
    assert int(found["lag"][found["correlation"][0].to_numpy().argmax()]) == 3
    assert float(found["correlation"][0].sel(lag=3)) == pytest.approx(same, abs=1e-12)
    assert np.isnan(found["correlation"][1:]).all()


def test_more_windows_than_a_block() -> None:
    a, b = noise(4, 20, 10, 30), noise(5, 20, 10, 30)
    distances = np.random.default_rng(0).uniform(1.0, 9.0, (300, 300))
    found = correlate_pairs(a, b, 1, distances=distances, bins=3)
    table = np.corrcoef(a.reshape(20, -1)[:-1].T, b.reshape(20, -1)[1:].T)[:300, 300:]
    for number in (1, 2, 3):
        values = table[in_bin(distances, number, 3)]
        at = found.isel(distance=number).sel(lag=1)
        assert float(at["correlation"]) == pytest.approx(values.mean(), abs=1e-12)
        assert int(at["n"]) == values.size
    assert int(found["n"].sel(lag=0).sum()) == 300**2


def test_distances_in_any_form() -> None:
    a = noise(6, FRAMES, LAYERS, SECTORS)
    table = some_distances()
    shape = (LAYERS, SECTORS, LAYERS, SECTORS)
    array = xr.DataArray(table.reshape(shape), dims=DIMS, attrs={"units": "µm"}, name="straight")
    plain = correlate_pairs(a, a, 2, distances=table)
    assert plain.attrs["distance"] == "given"
    for form in (table.tolist(), array, array.transpose("other_sector", "sector", "layer", "other_layer")):
        found = correlate_pairs(a, a, 2, distances=form)
        np.testing.assert_array_equal(found["correlation"], plain["correlation"])
        np.testing.assert_array_equal(found["distance"], plain["distance"])
    named = correlate_pairs(a, a, 2, distances=array)
    assert named.attrs["distance"] == "straight"
    assert named.attrs["units"] == named["distance"].attrs["units"] == "µm"
    uneven = some_distances(1) * np.tri(WINDOWS)  # rows are windows of a, columns those of b
    turned = xr.DataArray(uneven.reshape(shape), dims=DIMS).transpose(*reversed(DIMS))
    np.testing.assert_array_equal(
        correlate_pairs(a, a, 2, distances=turned)["n"], correlate_pairs(a, a, 2, distances=uneven)["n"]
    )
    np.testing.assert_allclose(
        correlate_pairs(a, a, 2, distances=turned)["correlation"],
        correlate_pairs(a, a, 2, distances=uneven)["correlation"],
    )


def test_several_kinds_of_distance_share_their_bins() -> None:
    a, b = noise(7, FRAMES, LAYERS, SECTORS), noise(8, FRAMES, LAYERS, SECTORS)
    shape = (LAYERS, SECTORS, LAYERS, SECTORS)
    tables = {"straight": some_distances(), "edge": 2.0 * some_distances(3)}
    both = xr.Dataset(
        {name: (DIMS, table.reshape(shape)) for name, table in tables.items()}, attrs={"units": "px"}
    )
    found = correlate_pairs(a, b, 2, distances=both, bins=5, surrogates=3)
    assert found["correlation"].dims == ("along", "distance", "lag")
    assert found["along"].to_numpy().tolist() == ["straight", "edge"]
    assert found["threshold"].dims == ("along",)
    longest = max(table.max() for table in tables.values())
    assert float(found["distance"][-1]) == pytest.approx(0.9 * longest)
    correlation = by_hand(a, b, 1)
    edges = np.linspace(0.0, longest, 6)
    for name, table in tables.items():
        values = correlation[(table > edges[1]) & (table <= edges[2])]
        at = found.sel(along=name, lag=1).isel(distance=2)
        assert int(at["n"]) == values.size
        assert float(at["correlation"]) == pytest.approx(values.mean() if values.size else NAN, nan_ok=True)


def with_centroids(values: Any, scale: float | None) -> xr.DataArray:
    """A signal whose windows move, with their centroids as `sample_movie` gives them."""
    random = np.random.default_rng(9)
    dims = ("time", "layer", "sector")
    attrs = {} if scale is None else {"pixel_size_um": scale}
    places = random.uniform(0.0, 40.0, (2, 1, *values.shape[1:])) + random.normal(size=(2, *values.shape))
    places[:, 4] = NAN  # a frame without a map
    coords = {
        name: (dims, place, attrs) for name, place in zip(("centroid_y", "centroid_x"), places, strict=True)
    }
    return xr.DataArray(values, dims=dims, coords=coords | {"time_s": ("time", 2.0 * np.arange(len(values)))})


@pytest.mark.parametrize("scale", [None, 0.25])
@pytest.mark.parametrize("first", [True, False])
def test_distances_of_centroids(scale: float | None, first: bool) -> None:
    a = with_centroids(noise(10, 15, LAYERS, SECTORS), scale)
    plain = a.to_numpy()
    found = correlate_pairs(*((a, plain) if first else (plain, a)), 2, bins=3)
    yx = np.stack([a["centroid_y"], a["centroid_x"]], axis=-1).reshape(15, WINDOWS, 2)
    yx = np.delete(yx, 4, axis=0)
    expected = (scale or 1.0) * np.linalg.norm(yx[:, :, None] - yx[:, None], axis=3).mean(axis=0)
    assert found.attrs["distance"] == "straight"
    assert found["distance"].attrs["units"] == ("px" if scale is None else "µm")
    assert float(found["distance"][-1]) == pytest.approx(expected.max() * 2.5 / 3.0)
    given = correlate_pairs(plain, plain, 2, distances=expected, bins=3)
    np.testing.assert_allclose(found["correlation"], given["correlation"])
    np.testing.assert_array_equal(found["lag_s"], 2.0 * found["lag"])


def test_distances_on_the_disk() -> None:
    a = noise(11, FRAMES, 1, 4)
    found = correlate_pairs(a, a, 2, bins=2)
    radius = np.sqrt(0.5)  # half of the one layer's area lies within
    np.testing.assert_allclose(found["distance"], [0.0, 0.5 * radius, 1.5 * radius])
    np.testing.assert_array_equal(found["n"].sel(lag=0), [4, 0, 12])  # neighbours at 1, opposite ones at √2
    assert found.attrs["distance"] == "straight on the unit disk"
    assert found["distance"].attrs["units"] == "disk radius"
    table = disk_distances(2, 4)
    assert table[0, 4] == pytest.approx(np.sqrt(0.75) - np.sqrt(0.25))  # outer and inner window of sector 0
    assert table[0, 2] == pytest.approx(2.0 * np.sqrt(0.75))
    assert table[5, 6] == pytest.approx(np.sqrt(2.0) * 0.5)


@pytest.mark.parametrize("null", ["phase", "shift"])
@pytest.mark.parametrize("missing", [0.0, 0.1])
def test_chance_by_brute_force(null: Any, missing: float) -> None:
    a, b = noise(12, FRAMES, LAYERS, SECTORS, missing=missing), noise(13, FRAMES, LAYERS, SECTORS)
    distances = some_distances()
    found = correlate_pairs(a, b, 1, distances=distances, bins=2, surrogates=19, null=null, seed=4)
    change = surrogates(null, FRAMES, 19, 4, 1)
    changed = np.stack([change.together(x) for x in b.reshape(FRAMES, -1).T], axis=1)
    means = np.empty((change.count, 3, 3))
    for k, number, lag in np.ndindex(*means.shape):
        means[k, number, lag] = by_hand(a, changed[..., k], lag - 1)[in_bin(distances, number, 2)].mean()
    assert found.attrs["surrogates"] == change.count
    np.testing.assert_allclose(found["null_low"], np.quantile(means, 0.025, axis=0), atol=1e-12)
    np.testing.assert_allclose(found["null_high"], np.quantile(means, 0.975, axis=0), atol=1e-12)
    assert float(found["threshold"]) == pytest.approx(np.abs(means).max(axis=(1, 2)).max(), abs=1e-12)


def test_progress_seed_and_attributes() -> None:
    a = noise(14, FRAMES, LAYERS, SECTORS)
    seen: list[tuple[int, int]] = []
    found = correlate_pairs(
        a, a, 2, surrogates=3, seed=5, detrend="median", progress=lambda *step: seen.append(step)
    )
    assert seen == [(k + 1, 20) for k in range(20)]
    xr.testing.assert_identical(found, correlate_pairs(a, a, 2, surrogates=3, seed=5, detrend="median"))
    assert found.attrs["seed"] == 5
    assert found.attrs["detrend_frames"] == 9
    assert "threshold" not in correlate_pairs(a, a, 2)
    np.testing.assert_allclose(found["correlation"].isel(distance=0).sel(lag=0), 1.0)


def test_windows_without_values() -> None:
    a = noise(15, FRAMES, LAYERS, SECTORS)
    a[:, 0, 1], a[:, 1, 2] = NAN, 0.1
    found = correlate_pairs(a, a, 2, distances=some_distances(), surrogates=3)
    assert int(found["n"].sel(lag=0).sum()) == (WINDOWS - 2) ** 2
    nothing = correlate_pairs(np.full_like(a, NAN), a, 2, surrogates=3)
    assert np.isnan(nothing["correlation"]).all()
    np.testing.assert_array_equal(nothing["n"], 0)


GOOD = noise(16, FRAMES, LAYERS, SECTORS)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"distances": np.zeros((5, 5))}, r"distances have shape \(5, 5\): 2 layers × 3 sectors need 6 × 6"),
        ({"distances": np.full((6, 6), NAN)}, "distances must be finite and not below 0"),
        ({"distances": -np.ones((6, 6))}, "distances must be finite and not below 0"),
        ({"distances": "straight"}, "distances must be numbers, got dtype <U8"),
        ({"bins": 0}, "bins must be a whole number from 1 to 10000, got 0"),
        ({"bins": 2.5}, "bins .* got 2.5"),
        ({"bins": None}, "bins .* got None"),
        ({"max_lag": 21}, "max_lag 21 leaves 9 pairs of 30 frames, fewer than min_pairs 10: pass at most 20"),
        ({"max_lag": -1}, "max_lag must be a whole number of at least 0, got -1"),
        ({"min_pairs": 2}, "min_pairs must be a whole number from 3 to 1000000, got 2"),
        ({"surrogates": -1}, "surrogates must be a whole number from 0 to 100000, got -1"),
        ({"null": "noise"}, "null must be one of phase, shift, got 'noise'"),
        ({"surrogates": 2, "seed": -3}, "seed must be a whole number from 0 to [0-9]+, got -3"),
        ({"detrend": "cubic"}, "detrend must be one of none, linear, median, got 'cubic'"),
    ],
)
def test_options_that_make_no_sense(options: Any, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        correlate_pairs(GOOD, GOOD, **({"max_lag": 2} | options))


@pytest.mark.parametrize(
    ("a", "b", "message"),
    [
        (GOOD[:, 0], GOOD, r"a has the dims \['time', 'sector'\]: pass \(time, layer, sector\)"),
        (GOOD, GOOD[:, None], r"b has the dims .*'channel'.*: pass \(time, layer, sector\)"),
        (GOOD, GOOD[1:], "a has 30 frames, b 29: pass the same frames of both"),
        (GOOD, GOOD[:, :, 1:], "a and b do not have the same frames and windows"),
        (xr.Dataset(), GOOD, "a is a Dataset: pass one of its variables"),
        (GOOD, np.full(GOOD.shape, "x"), "b must hold numbers, got dtype <U1"),
    ],
)
def test_series_that_cannot_be_paired(a: Any, b: Any, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        correlate_pairs(a, b, 2)


def test_no_frame_with_all_centroids() -> None:
    a = with_centroids(noise(17, 15, LAYERS, SECTORS), None)
    a = a.assign_coords(centroid_y=a["centroid_y"] * NAN)
    with pytest.raises(ParameterError, match=r"centroid.*pass distances"):
        correlate_pairs(a, a, 2)


def test_surrogates_of_all_at_once_and_one_by_one_agree(monkeypatch: pytest.MonkeyPatch) -> None:
    """The shortcut for series without gaps of their own gives what correlating each surrogate gives."""
    random = np.random.default_rng(4)
    a, b = random.normal(size=(2, 30, 3, 5))
    a[7], b[11] = np.nan, np.nan  # frames that all windows miss
    a[:, 1, 2] = 3.0  # a window that does not vary
    distances = np.abs(np.subtract.outer(np.arange(15.0), np.arange(15.0)))
    fast = correlate_pairs(a, b, 4, distances=distances, bins=6, surrogates=40)
    monkeypatch.setattr("cytodisk.analysis.pairs.pair_chance.same_gaps", lambda series: False)
    slow = correlate_pairs(a, b, 4, distances=distances, bins=6, surrogates=40)
    for name in ("null_low", "null_high", "threshold"):
        np.testing.assert_allclose(fast[name], slow[name], atol=1e-12)


def test_far_bins_with_few_pairs_do_not_set_the_threshold() -> None:
    random = np.random.default_rng(5)
    a, b = random.normal(size=(2, 40, 2, 10))
    distances = np.ones((20, 20))
    distances[0, 1] = distances[1, 0] = 50.0  # two pairs alone in their bin, whose mean is noise
    with_it = correlate_pairs(a, b, 5, distances=distances, bins=10, surrogates=99)
    without = correlate_pairs(a, b, 5, distances=np.ones((20, 20)), bins=1, surrogates=99)
    assert with_it["n"].isel(lag=0).max() == 398
    np.testing.assert_allclose(with_it["threshold"], without["threshold"], rtol=0.1)


def test_series_that_drift_are_told() -> None:
    walk = np.cumsum(np.random.default_rng(0).normal(size=(100, 2, 3)), axis=0)
    with pytest.warns(StationarityWarning):
        found = correlate_pairs(walk, walk, 5)
    assert found.attrs["drifting_a"] > 0.25
