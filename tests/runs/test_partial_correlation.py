"""Correlations without geometry and other channels, on movies in which the truth is known."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile
import xarray as xr
from movie_files import write_masks

import cytodisk as cd
from cytodisk.errors import ParameterError
from cytodisk.runs.correlate.partial_correlation import does_not_survive
from cytodisk.store.study import Study

_FRAMES = 60
_HOW: dict[str, Any] = {"max_lag": 5, "surrogates": 199}


def _signals(masks: np.ndarray, random: np.random.Generator) -> dict[str, np.ndarray]:
    """A pattern that stands still, a volume marker, a signal that follows it, and one of its own."""
    row, column = np.indices(masks.shape[1:]) - np.array(masks.shape[1:]).reshape(2, 1, 1) / 2.0
    still = 200.0 * np.exp(-np.hypot(row, column) / 9.0)
    level = np.cumsum(random.normal(size=(_FRAMES, 1, 1)), axis=0) * 0.5 + random.normal(size=(_FRAMES, 1, 1))
    noise = random.normal(size=(4, *masks.shape))
    volume = 100.0 + 10.0 * level + noise[1]
    return {
        "still": still + 3.0 * noise[0],
        "volume": volume,
        "follower": 50.0 + 0.5 * volume + noise[2],
        "free": 100.0 + 3.0 * random.normal(size=(_FRAMES, 1, 1)) + noise[3],
    }


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Study:
    folder = tmp_path_factory.mktemp("partial")
    truth = cd.simulate.movie("fluctuating", 3, frames=_FRAMES, radius_px=16)
    signals = _signals(truth.masks, np.random.default_rng(2))
    masks = write_masks(folder / "masks.tif", truth.masks.astype(np.uint8))
    stack = np.stack([np.clip(one, 0, None) for one in signals.values()], axis=1).astype(np.uint16)
    names = {"axes": "TCYX", "Channel": {"Name": list(signals)}}
    tifffile.imwrite(folder / "signal.ome.tif", stack, metadata=names, photometric="minisblack")
    signal = folder / "signal.ome.tif"
    return cd.run_movie(masks, folder / "out", signal=signal, layers=3, sectors=8)


@pytest.mark.slow
def test_a_still_pattern_does_not_survive(study: Study) -> None:
    found = cd.run_correlate(study, "still", **_HOW)
    layers = found.layers.set_index("layer")
    assert (layers["q"] < 0.05).any()
    assert layers["geometry"].tolist() == (layers["q"] < 0.05).tolist()
    assert (layers["q_partial"] >= 0.05).all()
    assert found.clusters is not None
    assert len(found.clusters) > 0
    assert (found.clusters["p_partial"] >= 0.05).all()
    assert found.cells["partial_frames"].iloc[0] > 50
    flags = {flag.name: flag for flag in cd.qc_flags(study)}
    assert "geometry" in flags
    assert flags["geometry"].places[0].note.startswith("still with velocity: layer")


def test_partial_is_what_the_functions_give(study: Study) -> None:
    found = cd.run_correlate(study, "still", sectors=(2, 6), name="some", **_HOW)
    activity = study.activity(0)
    signal = activity["mean"].sel(channel="still", drop=True).isel(sector=slice(2, 7))
    images = cd.read_image(study.provenance["inputs"]["signal"]["path"], unnamed="T").sel(channel="still")
    controls = cd.geometry_controls(study.movie(0), cd.polar_windows(3, 8), images, 5)
    left = cd.without_controls(signal, controls.isel(sector=slice(2, 7)))
    expected = cd.cross_correlate(left, activity["velocity"].isel(sector=slice(2, 7)), 5, surrogates=199)
    peak = cd.peak_correlation(expected)
    windows = found.windows.set_index(["layer", "sector"])
    for name in ("correlation", "lag", "p", "q"):
        table = windows[f"{name}_partial"].unstack("sector").to_numpy()
        np.testing.assert_array_equal(table, peak[name].transpose("layer", "sector"), name)
    curves = found.curves.set_index(["layer", "sector", "lag"])["correlation_partial"].to_xarray()
    np.testing.assert_array_equal(curves, expected["correlation"].transpose(*curves.dims))
    assert found.windows.attrs["units"]["lag_partial"] == "frame"


def test_another_channel_as_control(study: Study) -> None:
    alone = cd.run_correlate(study, "follower", "volume", geometry=False, name="raw", **_HOW)
    assert (alone.windows["correlation"] > 0.9).all()
    assert "correlation_partial" not in alone.windows
    for control, words in {
        ("volume",): "'volume' is one of the two that are correlated",
        ("nothing",): "'nothing' is no other channel",
        ("volume", "volume"): "names 'volume' twice",
    }.items():
        with pytest.raises(ParameterError, match=words):
            cd.run_correlate(
                study, "follower", "volume" if len(control) == 1 else "velocity", control=control, **_HOW
            )
    raw = cd.run_correlate(study, "follower", geometry=False, name="raw", **_HOW)
    found = cd.run_correlate(study, "follower", geometry=False, control=("volume",), **_HOW)
    np.testing.assert_array_equal(found.windows["correlation"], raw.windows["correlation"])
    activity = study.activity(0)["mean"]
    follower, volume = (activity.sel(channel=name, drop=True) for name in ("follower", "volume"))
    left = cd.without_controls(follower, volume)
    assert float(left.std("time").mean()) < 0.2 * float(follower.std("time").mean())
    expected = cd.cross_correlate(left, study.activity(0)["velocity"], 5)["correlation"]
    curves = found.curves.set_index(["layer", "sector", "lag"])["correlation_partial"].to_xarray()
    np.testing.assert_array_equal(curves, expected.transpose(*curves.dims))


def test_two_signals_have_controls_of_their_own(study: Study) -> None:
    found = cd.run_correlate(study, "still", "free", **_HOW)
    images = cd.read_image(study.provenance["inputs"]["signal"]["path"], unnamed="T")
    left = []
    for name in ("still", "free"):
        controls = cd.geometry_controls(
            study.movie(0), cd.polar_windows(3, 8), images.sel(channel=name, drop=True), 5
        )
        left.append(cd.without_controls(study.activity(0)["mean"].sel(channel=name, drop=True), controls))
    expected = cd.cross_correlate(*left, 5)["correlation"]
    curves = found.curves.set_index(["layer", "sector", "lag"])["correlation_partial"].to_xarray()
    np.testing.assert_allclose(curves, expected.transpose(*curves.dims), atol=1e-9)


def test_detrended_controls_and_frames_left_out(study: Study) -> None:
    how = {"detrend": "linear", "without_frames": (7, 8), "against": "edge", **_HOW}
    found = cd.run_correlate(study, "still", "free", **how)
    assert found.cells["geometry_not_tested"].tolist() == [""]
    assert found.cells["partial_frames"].iloc[0] <= _FRAMES - 2


def test_a_signal_that_is_gone_or_changed(study: Study, tmp_path: Path) -> None:
    signal = Path(study.provenance["inputs"]["signal"]["path"])
    there = tmp_path / "signal.ome.tif"
    signal.rename(there)
    try:
        gone = cd.run_correlate(study, "still", **_HOW)
        assert gone.cells["geometry_not_tested"].tolist() == ["signal.ome.tif is not there any more"]
        assert gone.windows["q"].notna().all()
        assert gone.windows["q_partial"].isna().all()
        assert not gone.windows["geometry"].any()
        signal.write_bytes(there.read_bytes() + b"x")
        changed = cd.run_correlate(study, "still", **_HOW)
        assert "sha256" in changed.cells["geometry_not_tested"].iloc[0]
        flags = {flag.name: flag for flag in cd.qc_flags(study)}
        assert "sha256" in flags["geometry not tested"].places[0].note
    finally:
        there.rename(signal)
    cd.run_correlate(study, "still", **_HOW)
    assert "geometry not tested" not in {flag.name for flag in cd.qc_flags(study)}


def test_too_few_frames(study: Study) -> None:
    short = cd.run_correlate(study, "still", frames=(0, 18), max_lag=3, surrogates=19, name="short")
    assert short.cells["geometry_not_tested"].tolist() == ["19 frames are too few, 20 are needed"]
    narrow = cd.run_correlate(study, "still", frames=(0, 34), max_lag=24, surrogates=19, name="narrow")
    assert "20 are needed" in narrow.cells["geometry_not_tested"].iloc[0]
    assert narrow.cells["partial_frames"].iloc[0] < 20


def test_progress_is_told_to_the_end(study: Study) -> None:
    steps: list[tuple[int, int]] = []
    cd.run_correlate(study, "still", progress=lambda *done: steps.append(done), **_HOW)
    shares = [done / total for done, total in steps]
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    assert shares[0] < 0.2


def test_what_does_not_survive() -> None:
    correlation = np.array([0.5, 0.5, 0.5, -0.5, -0.5, 0.5, 0.5])
    q = np.array([0.01, 0.01, 0.01, 0.01, 0.01, 0.20, 0.01])
    left = np.array([0.4, 0.4, 0.2, -0.3, 0.4, 0.0, np.nan])
    q_partial = np.array([0.01, 0.06, 0.01, 0.04, 0.01, 0.9, np.nan])
    expected = [False, True, True, False, True, False, False]
    assert does_not_survive(correlation, q, left, q_partial).tolist() == expected


@pytest.mark.slow
def test_independent_series_stay_nominal() -> None:
    """Taking controls out of a signal makes no correlation with what is independent of both."""
    shares = []
    for seed in range(100, 112):
        signal, velocity = cd.simulate.independent_series("smooth", seed, 100, 2, 12)
        control, _ = cd.simulate.independent_series("smooth", seed + 1000, 100, 2, 12)
        left = cd.without_controls(signal + 2.0 * control, xr.Dataset({"lab": control}))
        found = cd.peak_correlation(cd.cross_correlate(left, velocity, 10, surrogates=199, seed=seed))
        shares.append(float((found["p"] <= 0.05).mean()))
    assert 0.02 <= np.mean(shares) <= 0.08
