from collections.abc import Callable
from functools import cached_property

import numpy as np
import pytest
import xarray as xr

from cytodisk import DiskMovie, consecutive_correlation, map_movie, polar_windows, sample_movie, simulate
from cytodisk.analysis.activity import STATISTICS
from cytodisk.analysis.signal_frames import parse_signals
from cytodisk.errors import ParameterError, SignalError
from cytodisk.simulate import SimulatedMovie

GRID = polar_windows(3, 12)


class Case:
    """A small cell that loses frames, with two channels."""

    @cached_property
    def shown(self) -> SimulatedMovie:
        return simulate.movie("dropping", 1, frames=9, radius_px=20.0, dropped=0.25, protrusion_px=6.0)

    @cached_property
    def signal(self) -> xr.DataArray:
        assert self.shown.signal is not None
        return self.shown.signal

    @cached_property
    def movie(self) -> DiskMovie:
        masks = xr.DataArray(self.shown.masks, dims=("time", "y", "x"), attrs=self.signal.attrs)
        return map_movie(masks)

    @cached_property
    def activity(self) -> xr.Dataset:
        return sample_movie(self.movie, GRID, self.signal)


@pytest.fixture(scope="module")
def case() -> Case:
    return Case()


def test_tables_have_their_dims_coordinates_and_units(case: Case) -> None:
    activity = case.activity
    assert dict(activity.sizes) == {"time": 9, "channel": 2, "layer": 3, "sector": 12}
    for name in STATISTICS:
        assert activity[name].dims == ("time", "channel", "layer", "sector")
    for name in ("area", "centroid_y", "centroid_x"):
        assert activity[name].dims == ("time", "layer", "sector")
    units = {
        name: table.attrs.get("units")
        for name, table in activity.reset_coords(["centroid_y", "centroid_x"]).data_vars.items()
    }
    assert units == dict.fromkeys(("mean", "sd", "min", "max"), "a.u.") | {
        "n_pixels": "px²",
        "n_nan": "px²",
        "area": "µm²",
        "depth": "µm",
        "depth_p5": "µm",
        "depth_p95": "µm",
        "centroid_y": "px",
        "centroid_x": "px",
        "status": None,
        "reason": None,
    }
    np.testing.assert_array_equal(activity["frame"], np.arange(9))
    np.testing.assert_allclose(activity.time_s, 5.0 * np.arange(9))
    assert activity.time_s.attrs["units"] == "s"
    assert activity.attrs == {"pixel_size_um": 0.16, "frame_interval_s": 5.0}


def test_channels_keep_their_names(case: Case) -> None:
    assert list(case.activity.channel.to_numpy()) == list(case.signal.channel.to_numpy())
    swapped = sample_movie(case.movie, GRID, case.signal.transpose("x", "channel", "time", "y"))
    assert swapped.identical(case.activity)
    one = sample_movie(case.movie, GRID, case.signal.sel(channel=["edge"]))
    np.testing.assert_array_equal(one["mean"], case.activity["mean"].sel(channel=["edge"]))
    alone = sample_movie(case.movie, GRID, case.signal.sel(channel="edge"))
    assert list(alone.channel.to_numpy()) == ["edge"]
    assert alone.identical(one)


def test_windows_hold_the_whole_cell(case: Case) -> None:
    activity = case.activity.isel(time=case.shown.present)
    masks = case.shown.masks[case.shown.present]
    signal = case.signal.to_numpy()[case.shown.present].astype(float)
    whole = (signal * masks[:, None]).sum(axis=(2, 3))
    held = (activity.n_pixels * activity["mean"]).sum(("layer", "sector"))
    np.testing.assert_allclose(held, whole, rtol=1e-9)
    area = activity.area.sum(("layer", "sector")) / 0.16**2
    np.testing.assert_allclose(area, masks.sum(axis=(1, 2)), rtol=1e-9)
    for name, axis in (("centroid_y", 1), ("centroid_x", 2)):
        first = (activity[name] * activity.area).sum(("layer", "sector")) / activity.area.sum(
            ("layer", "sector")
        )
        expected = [np.argwhere(mask)[:, axis - 1].mean() for mask in masks]
        np.testing.assert_allclose(first, expected, rtol=1e-9)


def test_a_frame_without_a_map_is_nan_with_its_reason(case: Case) -> None:
    activity, present = case.activity, case.shown.present
    assert not present.all()
    for name in (*STATISTICS, "area", "centroid_y", "centroid_x"):
        lost = np.isnan(activity[name].to_numpy().reshape(9, -1))
        np.testing.assert_array_equal(lost.all(axis=1), ~present)
        np.testing.assert_array_equal(lost.any(axis=1), ~present)
    status, reason = activity.status.to_numpy(), activity.reason.to_numpy()
    np.testing.assert_array_equal(status, np.where(present, "ok", "refused"))
    assert all("is empty" in text for text in reason[~present])
    assert set(reason[present]) == {""}


def test_a_material_signal_stays_correlated() -> None:
    shown = simulate.movie("bulging", 3, frames=8)
    assert shown.signal is not None
    activity = sample_movie(map_movie(shown.masks), polar_windows(6, 40), shown.signal)
    correlation = consecutive_correlation(activity["mean"].sel(channel="material"))[:-1]
    assert float(correlation.mean()) > 0.9
    assert float(correlation.min()) > 0.7


def test_frames_come_as_arrays_or_lists(case: Case) -> None:
    array = case.signal.to_numpy()
    stack = sample_movie(case.movie, GRID, array)
    assert list(stack.channel.to_numpy()) == ["0", "1"]
    np.testing.assert_array_equal(stack["mean"], case.activity["mean"])
    assert sample_movie(case.movie, GRID, list(array)).identical(stack)
    flat = sample_movie(case.movie, GRID, [frame[1] for frame in array])
    assert dict(flat.sizes) == {"time": 9, "channel": 1, "layer": 3, "sector": 12}
    np.testing.assert_array_equal(flat["mean"].isel(channel=0), stack["mean"].isel(channel=1))
    assert sample_movie(case.movie, GRID, array[:, 1]).identical(flat)


def test_nan_is_passed_on_or_left_out(case: Case) -> None:
    signal = case.signal.to_numpy().astype(float)
    signal[0, 0][case.shown.masks[0]] = np.nan
    later = int(np.flatnonzero(case.shown.present)[1])
    y, x = np.argwhere(case.shown.masks[later])[100]
    signal[later, 0, y, x] = np.inf
    passed, omitted = (sample_movie(case.movie, GRID, signal, nan=nan) for nan in ("propagate", "omit"))
    assert np.isnan(passed["mean"][0, 0]).all()
    assert np.isnan(omitted["mean"][0, 0]).all()
    assert float(passed.n_nan[0, 0].sum()) == pytest.approx(float(case.shown.masks[0].sum()))
    assert float(passed.n_nan[later, 0].sum()) == pytest.approx(1.0)
    assert 1 <= int(np.isnan(passed["mean"][later, 0]).sum()) < 36
    assert np.isfinite(omitted["mean"][later, 0]).all()
    np.testing.assert_array_equal(omitted["mean"][:, 1], case.activity["mean"][:, 1])


def test_without_a_scale_there_is_none_in_the_table(case: Case) -> None:
    movie = map_movie(case.shown.masks[:2])
    activity = sample_movie(movie, GRID, case.signal[:2])
    assert activity.attrs == {}
    assert activity.area.attrs["units"] == "px²"
    assert "time_s" not in activity.coords


def test_progress_is_told(case: Case) -> None:
    done: list[tuple[int, int]] = []
    sample_movie(case.movie, GRID, case.signal, progress=lambda n, total: done.append((n, total)))
    assert done == [(n, 9) for n in range(1, 10)]


@pytest.mark.parametrize(
    ("signals", "message"),
    [
        (np.zeros((4, 8, 9)), r"4 frames, the movie 5: pass as many, time first"),
        (np.zeros((8, 9, 5)), r"8 frames, the movie 5 \(but 5 is the length of axis 2 of \(8, 9, 5\)\)"),
        ([np.zeros((8, 9))] * 6, "6 frames, the movie 5: pass as many"),
        (np.zeros((5, 9, 8)), r"shape \(9, 8\), the masks \(8, 9\)"),
        (np.zeros((5, 8)), r"shape \(8,\)"),
        (np.zeros((5, 2, 2, 8, 9)), r"shape \(2, 2, 8, 9\)"),
        (np.zeros((5, 8, 9), dtype=complex), "numbers, got dtype complex128"),
        (np.full((5, 8, 9), "a"), "numbers, got dtype <U1"),
        (7.0, "got float"),
        (None, "got NoneType"),
        (iter([]), "got list_iterator"),
        (xr.DataArray(np.zeros((5, 8, 9)), dims=("z", "y", "x")), r"dims \['z', 'y', 'x'\]"),
        (
            xr.DataArray(np.zeros((5, 8, 9)), dims=("time", "channel", "x")),
            r"dims \['time', 'channel', 'x'\]",
        ),
        (xr.DataArray(np.zeros((5, 2, 8, 9)), dims=("time", "z", "y", "x")), "dims .*'z'"),
    ],
)
def test_signals_that_do_not_fit_are_refused(signals: object, message: str) -> None:
    with pytest.raises(SignalError, match=message):
        parse_signals(signals, 5, (8, 9))


def test_signals_are_refused_before_anything_is_sampled(case: Case) -> None:
    with pytest.raises(SignalError, match="8 frames, the movie 9"):
        sample_movie(case.movie, GRID, case.signal[:8])


@pytest.mark.parametrize(
    "spoil",
    [lambda frame: frame[:, :-1], lambda frame: frame.transpose(0, 2, 1), lambda frame: frame[:1]],
    ids=["cut", "transposed", "one channel"],
)
def test_a_later_frame_that_does_not_fit_is_refused(
    case: Case, spoil: Callable[[np.ndarray], np.ndarray]
) -> None:
    frames = list(case.signal.to_numpy())
    frames[-1] = spoil(frames[-1])
    assert frames[-1].shape != frames[0].shape
    with pytest.raises(SignalError):
        sample_movie(case.movie, GRID, frames)


def test_swapped_arguments_are_told_their_order(case: Case) -> None:
    order = r"the order is sample_movie\(movie, grid, signals\)"
    with pytest.raises(ParameterError, match=f"movie must be a DiskMovie, .*, got PolarGrid: {order}"):
        sample_movie(GRID, case.movie, case.signal)  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match=f"grid must be a PolarGrid, .*, got DataArray: {order}"):
        sample_movie(case.movie, case.signal, GRID)  # type: ignore[arg-type]


def test_two_channels_of_one_name_are_refused(case: Case) -> None:
    signal = case.signal.assign_coords(channel=["Rac1", "Rac1"])
    with pytest.raises(SignalError, match=r"signals: two channels have one name, got \('Rac1', 'Rac1'\)"):
        sample_movie(case.movie, GRID, signal)
