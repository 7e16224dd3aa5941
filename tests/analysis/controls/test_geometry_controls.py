"""Controls made from a movie itself, against patterns whose answer is known."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import cytodisk as cd
from cytodisk.analysis.controls.slow_level import slow_level
from cytodisk.errors import ParameterError, SignalError
from cytodisk.geometry.depth import depth_of

_LAG, _FRAMES = 4, 40


@pytest.fixture(scope="module")
def cell() -> tuple[np.ndarray, cd.DiskMovie, cd.PolarGrid]:
    masks = cd.simulate.movie("fluctuating", frames=_FRAMES, radius_px=14).masks
    return masks, cd.map_movie(masks), cd.polar_windows(3, 8)


def _mean(cell, image):
    return cd.sample_movie(cell[1], cell[2], image)["mean"].isel(channel=0, drop=True)


def _depths(masks):
    return np.stack([depth_of(np.pad(mask, 1))[1:-1, 1:-1] for mask in masks])


def test_a_still_pattern_is_its_own_mean_in_the_lab(cell):
    pattern = np.random.default_rng(0).normal(100.0, 20.0, cell[0].shape[1:])
    image = np.repeat(pattern[None], _FRAMES, axis=0)
    lab = cd.geometry_controls(cell[1], cell[2], image, _LAG)["lab"]
    held = np.isfinite(lab)
    assert held.mean() > 0.9
    whole = _mean(cell, image).where(held)
    assert float(abs(lab - whole).max()) < 20.0  # at most a fifth of a window is unknown
    assert float(abs(lab - whole).median()) < 1e-9


def test_a_cortex_is_its_own_profile_by_depth(cell):
    image = 100.0 * np.exp(-_depths(cell[0]) / 3.0)
    profile = cd.geometry_controls(cell[1], cell[2], image, _LAG)["depth_profile"]
    whole = _mean(cell, image)
    assert float(abs(profile - whole).max()) < 0.02 * float(whole.max())


def test_frames_within_the_lag_do_not_count(cell):
    """A flash in one frame is in the mean of all others but those around it."""
    image = np.full((_FRAMES, *cell[0].shape[1:]), 10.0)
    image[20] = 40.0
    lab = cd.geometry_controls(cell[1], cell[2], image, _LAG)["lab"].isel(layer=2).min("sector")
    near = range(20 - _LAG, 20 + _LAG + 1)
    for frame, value in enumerate(lab.to_numpy()):
        assert (value < 10.3) == (frame in near)


def test_oracle_of_the_lab_mean(cell):
    image = np.random.default_rng(1).poisson(50.0, (_FRAMES, *cell[0].shape[1:])).astype(np.float64)
    lab = cd.geometry_controls(cell[1], cell[2], image, _LAG)["lab"]
    held = cell[0]
    for frame in (0, 17, _FRAMES - 1):
        others = [t for t in range(_FRAMES) if abs(t - frame) > _LAG]
        count = held[others].sum(axis=0)
        mean = (image[others] * held[others]).sum(axis=0) / np.maximum(count, 1)
        mean[count < 3] = np.nan
        oracle = cd.sample(cell[2].on(cell[1][frame]), mean, nan="omit")
        there = np.isfinite(lab[frame].to_numpy())
        share = (oracle["n_pixels"] / oracle["area"]).to_numpy()
        assert (there == (share >= 0.8)).all()
        np.testing.assert_allclose(lab[frame].to_numpy()[there], oracle["mean"].to_numpy()[there], rtol=0.02)


def test_a_still_pattern_that_bleaches_is_explained(cell):
    """Its mean in the lab fades with it, so that nothing but noise is left."""
    row, column = np.indices(cell[0].shape[1:])
    pattern = 100.0 * np.exp(-np.hypot(row - row.mean(), column - column.mean()) / 8.0)
    image = pattern * np.linspace(1.0, 0.4, _FRAMES)[:, None, None]
    left = {}
    for name, movie in (("still", np.repeat(pattern[None], _FRAMES, axis=0)), ("bleaching", image)):
        whole = _mean(cell, movie)
        kept = cd.without_controls(whole, cd.geometry_controls(cell[1], cell[2], movie, _LAG))
        left[name] = float((kept.std("time") / whole.std("time")).median())
    assert left["still"] < 0.02
    assert left["bleaching"] < 0.05


def test_the_level_is_slow_and_knows_no_flash():
    frames = np.arange(60)
    fading = 1.2 - 0.4 * frames / 59.0
    ratio = fading.copy()
    ratio[20] = 9.0
    level = slow_level(frames, np.stack([ratio, np.full(60, np.nan), -ratio], axis=1), 5)
    np.testing.assert_allclose(level[:, 0], fading / fading.mean(), atol=0.02)
    assert (level[:, 1:] == 1.0).all()
    assert (slow_level(frames[:19], ratio[:19, None], 5) == 1.0).all()


def test_places_that_are_new_have_no_value_in_the_lab():
    """A cell that runs on holds each place for a few frames only."""
    masks = np.zeros((30, 24, 130), dtype=bool)
    for frame, mask in enumerate(masks):
        mask[4:20, 4 + 3 * frame : 20 + 3 * frame] = True
    movie, grid = cd.map_movie(masks), cd.polar_windows(2, 4)
    lab = cd.geometry_controls(movie, grid, np.ones(masks.shape), max_lag=5)["lab"]
    assert not np.isfinite(lab).any()
    values = cd.sample_movie(movie, grid, np.ones(masks.shape))["mean"].isel(channel=0, drop=True)
    assert not np.isfinite(cd.without_controls(values, lab)).any()


def test_frames_that_are_left_out_count_nowhere(cell):
    image = np.full((_FRAMES, *cell[0].shape[1:]), 10.0)
    image[5] = np.inf
    image[6] = 1e6
    others = [frame for frame in range(_FRAMES) if frame not in (5, 6)]
    found = cd.geometry_controls(cell[1], cell[2], image, _LAG, frames=others)
    assert not np.isfinite(found["lab"][[5, 6]]).any()
    for name in ("lab", "depth_profile"):
        assert float(found[name].max()) == pytest.approx(10.0) == float(found[name].min())


def test_channels_frames_and_progress_are_told():
    movie = cd.map_movie(cd.simulate.movie("growing", frames=4, radius_px=10).masks, frame_interval_s=5.0)
    image = xr.DataArray(
        np.ones((4, 2, *movie.image_shape)), {"channel": ["a", "b"]}, ("time", "channel", "y", "x")
    )
    steps: list[tuple[int, int]] = []
    found = cd.geometry_controls(
        movie, cd.polar_windows(2, 4), image, 0, progress=lambda *done: steps.append(done)
    )
    assert dict(found["lab"].sizes) == {"time": 4, "channel": 2, "layer": 2, "sector": 4}
    assert found["channel"].to_numpy().tolist() == ["a", "b"]
    assert found["time_s"].to_numpy().tolist() == [0.0, 5.0, 10.0, 15.0]
    assert steps[-1] == (20, 20)
    assert [done for done, _ in steps] == list(range(1, 21))


def test_wrong_arguments(cell):
    _, movie, grid = cell
    image = np.ones((_FRAMES, *movie.image_shape))
    with pytest.raises(ParameterError, match="movie must be a DiskMovie"):
        cd.geometry_controls(grid, movie, image, 3)
    with pytest.raises(SignalError, match="frames"):
        cd.geometry_controls(movie, grid, image[:5], 3)
    with pytest.raises(ParameterError, match="max_lag"):
        cd.geometry_controls(movie, grid, image, -1)
    with pytest.raises(ParameterError, match="frames"):
        cd.geometry_controls(movie, grid, image, 3, frames=[_FRAMES])
