import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from cytodisk import (
    centroid_displacement,
    consecutive_correlation,
    map_movie,
    polar_windows,
    sample_movie,
    simulate,
)
from cytodisk.analysis.consistency import displacement_between

GRID = polar_windows(4, 16)


def table(values: object, dims: tuple[str, ...] = ("time", "layer", "sector")) -> xr.DataArray:
    return xr.DataArray(np.asarray(values, dtype=float), dims=dims)


def test_equal_frames_are_fully_correlated() -> None:
    frame = np.random.default_rng(0).normal(size=(3, 9))
    found = consecutive_correlation(table([frame, frame, frame]))
    assert found.dims == ("time", "layer")
    np.testing.assert_allclose(found[:-1], 1.0, atol=1e-12)
    assert np.isnan(found[-1]).all()
    assert found.attrs["units"] == "1"


def test_known_correlations() -> None:
    found = consecutive_correlation(
        table(
            [[1, 2, 3, 4], [2, 4, 6, 8], [-1, -2, -3, -4], [1, -1, -1, 1], [5, 5, 5, 5]], ("time", "sector")
        )
    )
    np.testing.assert_allclose(found, [1.0, -1.0, 0.0, np.nan, np.nan], atol=1e-12)


@given(st.integers(2, 6), st.integers(3, 12), st.integers(0, 10**6))
def test_it_is_the_correlation_of_a_library(times: int, sectors: int, seed: int) -> None:
    values = np.random.default_rng(seed).normal(3.0, 2.0, size=(times, 2, 3, sectors))
    activity = table(values, ("time", "channel", "layer", "sector"))
    found = consecutive_correlation(activity).to_numpy()
    for time, channel, layer in np.ndindex(times - 1, 2, 3):
        expected = np.corrcoef(values[time, channel, layer], values[time + 1, channel, layer])[0, 1]
        assert found[time, channel, layer] == pytest.approx(expected, abs=1e-9)
    np.testing.assert_allclose(consecutive_correlation(7.0 * activity - 3.0), found, atol=1e-9)
    np.testing.assert_array_equal(
        consecutive_correlation(activity.transpose("sector", ..., "time")).transpose(
            "time", "channel", "layer"
        ),
        found,
    )


def test_a_frame_without_signal_is_nan_on_both_sides() -> None:
    values = np.random.default_rng(1).normal(size=(5, 2, 8))
    values[2] = np.nan
    values[4, 1, 2:] = np.nan
    lost = np.isnan(consecutive_correlation(table(values)))
    np.testing.assert_array_equal(lost[:, 0], [False, True, True, False, True])
    np.testing.assert_array_equal(lost[:, 1], [False, True, True, True, True])


def test_sectors_that_are_empty_in_either_frame_are_left_out() -> None:
    values = np.random.default_rng(2).normal(size=(2, 1, 8))
    values[0, 0, 1] = values[1, 0, 5] = np.nan
    held = [0, 2, 3, 4, 6, 7]
    expected = np.corrcoef(values[0, 0, held], values[1, 0, held])[0, 1]
    assert float(consecutive_correlation(table(values))[0, 0]) == pytest.approx(expected, abs=1e-12)


def test_coordinates_go_on_without_the_sector() -> None:
    activity = table(np.ones((2, 3, 4))).assign_coords(
        frame=("time", [5, 6]),
        layer=[0, 1, 2],
        sector=np.arange(4),
        time_s=("time", [0.5, 0.6]),
        angle=("sector", np.ones(4)),
    )
    assert set(consecutive_correlation(activity).coords) == {"frame", "layer", "time_s"}


@pytest.mark.parametrize(
    "value",
    [
        0.5,
        0.1,
    ],
)
def test_a_signal_that_does_not_vary_has_no_correlation(value: float) -> None:
    frames = np.stack([np.full((1, 7), value), np.full((1, 7), 3.0 * value)])
    assert np.isnan(consecutive_correlation(table(frames))).all()


@pytest.mark.parametrize(("pixel", "unit"), [(None, "px"), (0.5, "µm")])
def test_a_cell_that_is_shifted_does_not_move(pixel: float | None, unit: str) -> None:
    shown = simulate.movie("translating", 2, frames=6, speed_px=1.5, signals=False)
    movie = map_movie(shown.masks, pixel_size_um=pixel)
    activity = sample_movie(movie, GRID, np.ones(shown.masks.shape))
    found = centroid_displacement(movie, activity)
    assert found.dims == ("time", "layer", "sector")
    assert found.shape == (6, 4, 16)
    assert found.attrs["units"] == unit
    assert np.isnan(found[-1]).all()
    assert float(found[:-1].mean()) < 0.15 * (pixel or 1.0)
    moved = displacement_between(np.stack([activity.centroid_y, activity.centroid_x], axis=-1))
    assert np.nanmean(moved) == pytest.approx(1.5, abs=0.1)


def test_displacements_are_distances_to_the_next_frame() -> None:
    positions = np.array([[[0.0, 0.0], [1.0, 1.0]], [[3.0, 4.0], [1.0, 1.0]], [[3.0, 4.0], [np.nan, 1.0]]])
    expected = [[5.0, 0.0], [0.0, np.nan], [np.nan, np.nan]]
    np.testing.assert_array_equal(displacement_between(positions), expected)


def test_a_gap_has_no_displacement() -> None:
    shown = simulate.movie("translating", 2, frames=4, radius_px=15.0, signals=False)
    masks = np.concatenate([shown.masks, shown.masks[-1:]])
    masks[2] = False
    movie = map_movie(masks)
    activity = sample_movie(movie, GRID, np.ones(masks.shape))
    found = np.isfinite(centroid_displacement(movie, activity)).all(("layer", "sector"))
    np.testing.assert_array_equal(found, [True, False, False, True, False])
