"""The mark of jitter: a step between lags -1 and 0, and nothing else."""

import numpy as np
import pytest
import xarray as xr

import cytodisk as cd
from cytodisk.errors import ParameterError

LAGS = np.arange(-10, 11)


def curves(*values: np.ndarray) -> xr.Dataset:
    table = xr.DataArray(np.array(values), {"lag": LAGS, "layer": np.arange(len(values))}, ("layer", "lag"))
    return xr.Dataset({"correlation": table})


def wide(noise: float = 0.0) -> np.ndarray:
    return 0.3 * np.exp(-((LAGS - 3.0) ** 2) / 30.0) + noise * np.random.default_rng(0).normal(size=LAGS.size)


def marked(curve: np.ndarray, size: float) -> np.ndarray:
    return curve + size * (LAGS == 0) - size * (LAGS == -1)


@pytest.mark.parametrize("size", [0.1, -0.2])
@pytest.mark.parametrize("noise", [0.0, 0.005])
def test_a_step_is_measured(size: float, noise: float) -> None:
    found = cd.jitter_step(curves(marked(wide(noise), size), wide(noise)))
    assert found.dims == ("layer",)
    np.testing.assert_allclose(found[0], size, atol=0.005 + 3.0 * noise)
    assert found[1] == 0.0


@pytest.mark.parametrize(
    "curve",
    [
        wide(),
        wide(0.02),
        1.0 * (LAGS == 0),  # a true correlation at lag 0 alone
        1.0 * (LAGS == -1),
        np.roll(marked(0.0 * LAGS, 0.2), 3),  # a step elsewhere
        np.full(LAGS.size, np.nan),
        np.zeros(LAGS.size),
    ],
)
def test_what_is_no_jitter_is_not_called_so(curve: np.ndarray) -> None:
    assert cd.jitter_step(curves(curve)).item() == 0.0


def test_a_weak_step_counts_where_velocity_jitters() -> None:
    """Correlations of layer 0 of a real Dictyostelium cell, whose outline jitters."""
    before = [0.062, 0.060, 0.082, 0.077, 0.107, 0.115, 0.125, 0.122, 0.083, 0.048]
    after = [
        0.166,
        0.076,
        0.029,
        -0.021,
        -0.022,
        -0.054,
        -0.069,
        -0.061,
        -0.075,
        -0.077,
        -0.054,
    ]
    curve = np.array(before + after)
    assert cd.jitter_step(curves(curve)).item() == 0.0
    assert cd.jitter_step(curves(curve), velocity_share=0.25).item() == pytest.approx(0.03, abs=0.002)
    assert cd.jitter_step(curves(curve), velocity_share=float("nan")).item() == 0.0
    one_sided = curve - 0.05 * (LAGS == 0)
    assert cd.jitter_step(curves(one_sided), velocity_share=0.25).item() == 0.0


def test_chance_makes_no_step_where_velocity_jitters() -> None:
    marked = 0
    for seed in range(1000, 1040):
        signal, velocity = cd.simulate.independent_series("white", seed, 60, 2, 12)
        found = cd.correlation_by_layer(cd.cross_correlate(signal, velocity, 10))
        marked += bool((cd.jitter_step(found, velocity_share=1.0) != 0.0).any())
    assert marked <= 3


@pytest.mark.parametrize("share", [0.0, 0.2, 0.5])
def test_the_share_of_jitter_in_velocity(share: float) -> None:
    smooth = cd.simulate.independent_series("smooth", 1000, 200, 1, 40)[1].to_numpy()
    errors = np.random.default_rng(1000).normal(size=(201, 40))
    velocity = np.sqrt(1.0 - share) * smooth + np.sqrt(0.5 * share) * np.diff(errors, axis=0)
    velocity[-1] = np.nan
    assert cd.velocity_jitter(velocity) == pytest.approx(share, abs=0.05)
    assert cd.velocity_jitter(1e-3 * velocity) == pytest.approx(cd.velocity_jitter(velocity))


def test_too_little_to_tell_jitter() -> None:
    assert np.isnan(cd.velocity_jitter(np.random.default_rng(0).normal(size=(19, 4))))
    assert np.isnan(cd.velocity_jitter(np.full((30, 4), np.nan)))
    assert np.isnan(cd.velocity_jitter(np.ones((30, 4))))


def test_few_lags_are_refused() -> None:
    with pytest.raises(ParameterError, match="six lags to both sides"):
        cd.jitter_step(curves(wide()).sel(lag=slice(-5, 5)))


@pytest.mark.slow
def test_masks_that_jitter_leave_it_and_still_ones_do_not() -> None:
    """Material that has nothing to do with the edge seems to, at lags -1 and 0, where masks jitter."""
    found = {}
    for jitter in (0.0, 0.7):
        shown = cd.simulate.movie("fluctuating", 2, frames=50, radius_px=24, jitter_px=jitter)
        movie = cd.map_movie(shown.masks)
        activity = cd.sample_movie(movie, cd.polar_windows(4, 24), shown.signal)
        velocity = cd.edge_velocity(movie, sectors=24)
        material = activity["mean"].sel(channel="material")
        correlations = cd.cross_correlate(material, velocity, 10, surrogates=0)
        assert (cd.velocity_jitter(velocity) > 0.1) == (jitter > 0.0)
        found[jitter] = cd.jitter_step(cd.correlation_by_layer(correlations)).to_numpy()
    skipped = cd.cross_correlate(material, velocity, 10, skip_lags=(-1, 0), surrogates=19)
    assert np.isnan(skipped["correlation"].sel(lag=[-1, 0])).all()
    assert not cd.peak_correlation(skipped)["lag"].isin([-1, 0]).any()
    assert (found[0.0] == 0.0).all()
    assert found[0.7][0] > 0.1


@pytest.mark.parametrize(
    ("skipped", "message"),
    [([12], "skip_lags has 12: lags run from -10 to 10"), (range(-10, 11), "skip_lags leaves no lag")],
)
def test_lags_that_cannot_be_skipped(skipped: list[int], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        cd.cross_correlate(np.arange(40.0) % 7, np.arange(40.0) % 5, 10, skip_lags=skipped)
