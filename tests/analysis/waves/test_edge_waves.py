"""Waves around a cell: known speed, direction and period are found, and what cannot be seen is said."""

from typing import Any

import numpy as np
import pytest
import xarray as xr

import cytodisk as cd
from cytodisk.errors import ParameterError

FEW = {"surrogates": 19, "max_mode": 3}
SCALARS = ("mode", "period_s", "speed", "direction", "persistence_s", "order", "p")


def wave(kind: Any = "running", seed: int = 3, **more: Any) -> Any:
    how = {"mode": 2, "period_s": 60.0, "noise": 1.0} | more
    return cd.simulate.wave_series(kind, seed, how.pop("frames", 36), how.pop("sectors", 12), **how)


@pytest.mark.parametrize("direction", [1, -1])
def test_speed_direction_and_kind_of_a_running_wave(direction: int) -> None:
    values = wave(direction=direction)
    found = cd.edge_waves(values, edge_length_um=100.0, **FEW)
    assert found["kind"] == "rotating"
    assert found["mode"] == 2
    assert found["direction"] * direction > 0.9
    assert found["speed"].item() == pytest.approx(values.attrs["speed"], rel=0.1)
    assert found["speed_um_s"].item() == pytest.approx(values.attrs["speed_um_s"], rel=0.1)


@pytest.mark.parametrize(("mode", "kind"), [(0, "oscillating"), (2, "standing")])
def test_a_steady_oscillation_does_not_rotate(mode: int, kind: str) -> None:
    found = cd.edge_waves(wave("standing", mode=mode, frames=72, noise=0.5), **FEW)
    assert found["kind"] == kind
    assert abs(found["direction"]) < 0.15
    assert found["period_s"].item() == pytest.approx(60.0, rel=0.1)
    assert np.isnan(found["speed"]) == (mode == 0)


def test_sectors_that_oscillate_each_by_itself_are_no_wave() -> None:
    orders = [cd.edge_waves(wave("none", seed), **FEW)["order"].item() for seed in range(3)]
    assert np.mean(orders) < 1.0


def test_where_sector_0_is_does_not_matter() -> None:
    values = wave(noise=0.5)
    found = cd.edge_waves(values, **FEW)
    turned = cd.edge_waves(values.roll(sector=7, roll_coords=False), **FEW)
    for name in SCALARS:
        assert turned[name].item() == pytest.approx(found[name].item(), rel=1e-6)
    back = np.exp(1j * turned["phase"].roll(sector=-7, roll_coords=False))
    assert np.abs(back - np.exp(1j * found["phase"])).max() < 1e-6


@pytest.mark.slow
def test_mirrored_cells_have_mirrored_waves() -> None:
    found, mirrored = (cd.edge_waves(wave()[:, ::step].to_numpy(), 5.0, **FEW) for step in (1, -1))
    assert mirrored["direction"].item() == pytest.approx(-found["direction"].item(), abs=1e-9)
    assert mirrored["speed"].item() == pytest.approx(-found["speed"].item(), rel=1e-9)


def test_lengths_of_sectors_are_taken_into_account() -> None:
    lengths = np.random.default_rng(1).lognormal(0.0, 0.5, 24)
    lengths *= 80.0 / lengths.sum()
    place = (np.cumsum(lengths) - 0.5 * lengths) / 80.0
    values = np.cos(2 * np.pi * (2 * place - np.arange(36)[:, None] / 12))
    found = cd.edge_waves(values, 1.0, np.tile(lengths, (36, 1)), **FEW)
    assert found["direction"] > 0.98
    assert found["speed_um_s"].item() == pytest.approx(80.0 / 24, rel=0.02)
    assert cd.edge_waves(values, 1.0, 80.0, **FEW)["direction"] < found["direction"]


def test_edge_length_by_time_may_have_gaps() -> None:
    length = np.linspace(90.0, 110.0, 36)
    length[3] = np.nan
    found = cd.edge_waves(wave(), edge_length_um=length, **FEW)
    assert found["speed_um_s"].item() == pytest.approx(found["speed"].item() * np.nanmean(length))


def test_missing_values_frames_and_a_sector_change_little() -> None:
    values = wave(frames=48, noise=0.5)
    holed = values.where(np.random.default_rng(0).random(values.shape) > 0.1)
    holed[:, 5] = np.nan
    holed[10:14] = np.nan
    found = cd.edge_waves(holed, **FEW)
    assert found["kind"] == "rotating"
    assert found["speed"].item() == pytest.approx(values.attrs["speed"], rel=0.1)
    assert found.attrs["sectors_without_values"] == [5]
    assert found.attrs["frames_used"] == 44


def test_uneven_seconds_and_frames_left_out() -> None:
    kept = np.sort(np.random.default_rng(2).permutation(60)[:44])
    values = wave(frames=60, noise=0.5).isel(time=kept)
    found = cd.edge_waves(values, **FEW)
    assert found["speed"].item() == pytest.approx(values.attrs["speed"], rel=0.1)
    assert found["kind"] == "rotating"


def test_one_sector_shows_an_oscillation_alone() -> None:
    time = np.arange(96)
    values = np.cos(2 * np.pi * time / 12) + 0.5 * np.random.default_rng(0).normal(size=96)
    found = cd.edge_waves(values[:, None], 1.0, **FEW)
    assert found["kind"] == "oscillating"
    assert found["period_s"].item() == pytest.approx(12.0, rel=0.05)
    assert found.sizes["around"] == 1


@pytest.mark.slow
def test_a_wave_that_turns_round_persists_for_less_long() -> None:
    first, second = wave(frames=96, noise=0.3), wave(direction=-1, frames=96, noise=0.3)
    turning = np.where(np.arange(96)[:, None] % 48 < 24, first, second)
    steady = cd.edge_waves(first, **FEW)["persistence_s"]
    assert steady == 480.0
    assert cd.edge_waves(turning, 5.0, **FEW)["persistence_s"] < 200.0


def test_phase_is_that_of_the_wave() -> None:
    values = wave(noise=0.1, frames=48)
    found = cd.edge_waves(values, **FEW)
    truth = np.exp(1j * (values["phase"] - 2 * 2 * np.pi * values["sector"] / 12))
    for name in ("phase", "wave_phase"):
        away = np.angle(np.exp(1j * found[name]) * truth.conj())[12:-12]
        assert np.abs(away).max() < 0.2
    assert found["wave_amplitude"][12:-12].mean().item() == pytest.approx(1.0, rel=0.1)


@pytest.mark.parametrize(
    ("values", "interval", "words"),
    [
        (np.ones((10, 8)) * np.arange(10)[:, None], 1.0, r"8 frames, 8 s, the longest .* 6.66667 s: pass at"),
        (np.ones((40, 8)) * np.arange(8), 1.0, "constant through time"),
        (np.full((40, 8), np.nan), 1.0, "0 frames with values"),
        (np.ones(40), 1.0, r"dims \(time, sector\), got an array of shape \(40,\)"),
        (np.eye(40), None, "pass the seconds between frames"),
        (np.full((40, 8), np.inf), 1.0, "finite"),
        (np.where(np.arange(8) < 3, np.arange(320.0).reshape(40, 8), np.nan), 1.0, "in 3 of 8 sectors"),
        (np.where(np.eye(40) > 0, 1.0, np.nan), 1.0, "no frame in which half of the 40 sectors have one"),
    ],
)
def test_what_cannot_be_used_is_said(values: Any, interval: float | None, words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        cd.edge_waves(values, interval)


@pytest.mark.parametrize(
    ("length", "words"),
    [(np.ones(7), "got shape"), (-1.0, "of at least"), (np.full(36, np.nan), "got NaN alone: leave")]
    + [(np.arange(36.0) - worst, f"above 0, .* got {-worst}") for worst in (0, 2)],
)
def test_lengths_that_do_not_fit_are_said(length: Any, words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        cd.edge_waves(wave(), edge_length_um=length, **FEW)


def test_an_interval_that_contradicts_the_seconds_is_refused() -> None:
    with pytest.raises(ParameterError, match="leave frame_interval_s out"):
        cd.edge_waves(wave(), frame_interval_s=4.0, **FEW)


@pytest.mark.parametrize(
    ("sectors", "words"),
    [([3, 2, 1, 0], "increase"), ([0, 1, 1, 2], "twice"), ([0, 1, 4, 5], "missing between")],
)
def test_sectors_out_of_their_order_around_the_cell_are_refused(sectors: list[int], words: str) -> None:
    values = xr.DataArray(np.ones((20, 4)), dims=("time", "sector"), coords={"sector": sectors})
    with pytest.raises(ParameterError, match=words):
        cd.edge_waves(values, 5.0)
