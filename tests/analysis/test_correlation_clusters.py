from contextlib import nullcontext
from typing import Any

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose, assert_array_equal

import cytodisk as cd
from cytodisk.analysis.correlation.cluster_fields import CLUSTER_THRESHOLD, WindowRing
from cytodisk.analysis.correlation.clusters import p_of_regions

STRENGTH, LAG = 0.3, 4


def ring(count: int) -> WindowRing:
    return WindowRing(np.arange(count), count)


def coupled(seed: int, sectors: Any, layers: int = 2, frames: int = 120) -> tuple[xr.DataArray, xr.DataArray]:
    """White series of 4 layers × 40 sectors, of which some are coupled weakly."""
    windows = np.zeros((4, 40), dtype=bool)
    windows[:layers, sectors] = True
    return cd.simulate.coupled_series(
        "white", seed, frames, 4, 40, lag_frames=LAG, windows=windows, strength=STRENGTH
    )


def clusters_of(a: Any, b: Any, **settings: Any) -> xr.Dataset:
    found = cd.cross_correlate(a, b, 8, clusters=True, **{"surrogates": 59} | settings)
    return cd.correlation_clusters(found)


def flood(chosen: Any) -> set[frozenset[tuple[int, int]]]:
    """Clusters of one field, window by window: the plain way."""
    left = {(int(k), int(s)) for k, s in np.argwhere(chosen)}
    found = set()
    while left:
        cluster, edge = set(), {left.pop()}
        while edge:
            k, s = edge.pop()
            cluster.add((k, s))
            beside = {(k - 1, s), (k + 1, s), (k, (s - 1) % chosen.shape[1]), (k, (s + 1) % chosen.shape[1])}
            edge |= beside & left
            left -= beside
        found.add(frozenset(cluster))
    return found


@pytest.mark.parametrize("sectors", [1, 2, 3, 9])
def test_clusters_are_those_of_a_plain_flood_around_the_edge(sectors: int) -> None:
    fields = np.random.default_rng(sectors).random((20, 4, sectors)) < 0.5
    labels, found = ring(sectors).labelled(fields)
    assert_array_equal(labels > 0, fields)
    assert_array_equal(np.unique(labels[labels > 0]), np.arange(1, found + 1))
    for field, of_field in zip(fields, labels, strict=True):
        numbers = np.unique(of_field[of_field > 0])
        mine = {frozenset((int(k), int(s)) for k, s in np.argwhere(of_field == n)) for n in numbers}
        assert mine == flood(field)


def test_a_part_of_the_edge_does_not_close_but_goes_on_over_the_last_sector() -> None:
    whole = np.ones((1, 1, 6), dtype=bool)
    whole[0, 0, 2] = False
    assert ring(6).labelled(whole)[1] == 1
    assert WindowRing.of(np.arange(10, 16), None).labelled(whole)[1] == 2
    over = WindowRing.of(np.array([0, 1, 2, 57, 58, 59]), 60)
    chosen = np.array([[[True, True, False, False, True, True]]])
    assert over.labelled(chosen)[1] == 1
    assert WindowRing.of(np.array([0, 1, 2, 57, 58, 59]), None).labelled(chosen)[1] == 2


def test_mass_is_what_lies_above_the_threshold_by_sign() -> None:
    scores = np.zeros((2, 3, 2, 8))
    scores[0, 1, 0, [7, 0, 1]] = CLUSTER_THRESHOLD + np.array([1.0, 2.0, 0.5])
    scores[0, 1, 1, 4] = CLUSTER_THRESHOLD + 3.0
    scores[1, 2, :, 3] = -CLUSTER_THRESHOLD - 4.0
    assert_allclose(ring(8).largest(scores), [3.5, 8.0])
    labels, masses = ring(8).masses(scores[0], 1)
    assert_allclose(sorted(masses), [0.0, 3.0, 3.5])
    assert labels[1, 0, 7] == labels[1, 0, 1] != labels[1, 1, 4]


def test_windows_are_averaged_around_the_edge_only() -> None:
    field = np.zeros((1, 3, 60))
    field[0, 1, 0] = 25.0
    averaged = ring(60).averaged(field)
    assert_allclose(averaged[0, 1, [0, 1, 4, 5, 59, 56, 55]], [5.0, 4.0, 1.0, 0.0, 4.0, 1.0, 0.0])
    assert not averaged[0, [0, 2]].any()
    assert_allclose(ring(7).averaged(np.ones((1, 2, 7))), 1.0)


def test_a_weak_coupling_is_found_over_the_last_sector_at_its_lag() -> None:
    sectors = np.arange(32, 48) % 40
    a, b = coupled(1000, sectors)
    correlations = cd.cross_correlate(a, b, 8, surrogates=99, clusters=True)
    alone = cd.peak_correlation(correlations)["q"].to_numpy()[:2, sectors] < 0.05
    clusters = cd.correlation_clusters(correlations)
    first = clusters.isel(cluster=0)
    assert (int(first["lag"]), int(first["sign"]), float(first["p"])) == (-LAG, 1, 0.01)
    member = first["member"].to_numpy()
    assert member[:2, sectors].mean() > 0.8
    assert alone.mean() < 0.4
    assert member[:2, sectors].sum() > 0.6 * member.sum()
    at_lag = correlations["correlation"].sel(lag=-LAG).to_numpy()[member]
    assert float(first["correlation"]) == pytest.approx(at_lag.mean())
    assert int(first["size"]) == member.sum()


def test_two_regions_are_two_clusters_with_their_signs_and_lags() -> None:
    first, second = np.arange(5, 15), np.arange(25, 35)
    a, b = coupled(1010, first, frames=300)
    other, _ = cd.simulate.independent_series("white", 7, 300, 4, 40)
    a = a.copy()
    moved = np.roll(b.to_numpy()[:, None, second], -2, axis=0)
    a[:, :2, second] = -0.4 * moved + 0.9 * other[:, :2, second].to_numpy()
    clusters = clusters_of(a, b)
    assert set(zip(clusters["lag"].to_numpy(), clusters["sign"].to_numpy(), strict=True)) == {
        (-LAG, 1),
        (2, -1),
    }
    assert not clusters["member"].all("cluster").any()
    assert_array_equal(clusters["cluster"], [1, 2])


@pytest.mark.parametrize("kind", ["white", "trend", "gaps"])
def test_without_a_coupling_there_is_rarely_a_cluster(kind: str) -> None:
    """Of 10 movies with 5 % false ones each, more than 3 come in 0.1 %."""
    false = 0
    for seed in range(2000, 2010):
        a, b = cd.simulate.independent_series("white" if kind == "trend" else "smooth", seed, 50, 2, 16)
        if kind == "trend":
            a, b = (
                values + 4.0 * np.linspace(-1, 1, 50).reshape(-1, *[1] * (values.ndim - 1))
                for values in (a, b)
            )
        if kind == "gaps":
            a, b = a.copy(), b.copy()
            a[20:23], b[40:44] = np.nan, np.nan
            a[:, 1, 4] = np.nan
        with pytest.warns(cd.errors.StationarityWarning) if kind == "trend" else nullcontext():
            false += clusters_of(a, b, seed=seed, surrogates=39).sizes["cluster"]
    assert false <= 3


def test_windows_without_values_are_in_no_cluster_and_part_of_the_edge_will_do() -> None:
    a, b = coupled(1020, np.arange(10, 30), frames=200)
    a = a.copy()
    a[:, :, 20] = np.nan
    whole = clusters_of(a, b)
    assert not whole["member"].isel(sector=20).any()
    part = {"sector": list(range(0, 5)) + list(range(12, 40))}
    found = clusters_of(a.isel(part), b.isel(part), edge_sectors=40)
    member = found["member"].any("cluster")
    assert float(member.sel(sector=slice(12, 29), layer=[0, 1]).mean()) > 0.6
    assert found.attrs["edge_sectors"] == 40


def test_clusters_of_series_by_sector_alone_and_of_channels_one_by_one() -> None:
    a, b = coupled(1030, np.arange(8, 28))
    line = clusters_of(a.sel(layer=0, drop=True), b)
    assert line["member"].dims == ("cluster", "sector")
    assert int(line["lag"][0]) == -LAG
    channels = xr.concat([a, a[::-1].assign_coords(a.coords)], "channel").transpose("time", "channel", ...)
    correlations = cd.cross_correlate(channels, b, 8, surrogates=59, clusters=True)
    with pytest.raises(cd.errors.ParameterError, match=r"channel.*isel"):
        cd.correlation_clusters(correlations)
    both = [cd.correlation_clusters(correlations.isel(channel=k)) for k in (0, 1)]
    assert both[0].equals(clusters_of(a, b))
    assert both[1].sizes["cluster"] == 0


def test_a_region_is_significant_in_other_correlations_where_they_agree() -> None:
    a, b = coupled(1050, np.arange(8, 28))
    with_coupling, without = (
        cd.cross_correlate(series, b, 8, surrogates=59, clusters=True)
        for series in (a, cd.simulate.independent_series("white", 1051, 120, 4, 40)[0])
    )
    clusters = cd.correlation_clusters(with_coupling)
    assert_allclose(p_of_regions(clusters, with_coupling), clusters["p"])
    assert p_of_regions(clusters, without)[0] > 0.05
    turned = cd.cross_correlate(-a, b, 8, surrogates=59, clusters=True)
    assert p_of_regions(clusters, turned)[0] > 0.05


def test_clusters_of_two_signals_by_window() -> None:
    a, b = coupled(1040, np.arange(8, 28))
    second = b.expand_dims(layer=a["layer"]).transpose("time", "layer", "sector")
    assert clusters_of(a, second)["lag"].to_numpy()[0] == -LAG


def test_what_does_not_make_clusters_is_refused() -> None:
    a, b = coupled(0, np.arange(5))
    with pytest.raises(cd.errors.ParameterError, match="clusters=True"):
        cd.correlation_clusters(cd.cross_correlate(a, b, 3, surrogates=19))
    with pytest.raises(cd.errors.ParameterError, match="sector 39"):
        cd.cross_correlate(a, b, 3, surrogates=19, clusters=True, edge_sectors=30)
    with pytest.raises(cd.errors.ParameterError, match="clusters need sectors"):
        cd.cross_correlate(a[:, 0, 0], b[:, 0], 3, surrogates=19, clusters=True)


def test_labels_link_no_diagonals_and_no_lags() -> None:
    fields = np.zeros((2, 2, 4), dtype=bool)
    fields[0, 0, 1] = fields[0, 1, 2] = fields[1, 0, 1] = True
    assert ring(4).labelled(fields)[1] == 3
