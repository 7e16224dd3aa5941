"""Marks of what makes independent series correlate, against series made with one of them."""

import numpy as np
import pytest
import xarray as xr
from scipy.ndimage import gaussian_filter

import cytodisk as cd
from cytodisk.analysis.stress.energy_scans import common_pulse, restless_episode, variance_ramp
from cytodisk.analysis.stress.series_energy import capped_energy, kurtosis
from cytodisk.analysis.stress.spectral_line import shared_line

FRAMES = 80


def quiet(seed: int, kind: str = "ar1", frames: int = FRAMES) -> tuple[xr.DataArray, xr.DataArray]:
    return cd.simulate.independent_series(kind, seed, frames, 2, 12)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("kind", "mark"),
    [
        ("pulse", "common pulse"),
        ("restless", "restless episode"),
        ("rising", "variance change"),
        ("steady", "steady oscillation"),
        ("heavy tails", "heavy tails"),
    ],
)
def test_each_stress_has_its_mark(kind: str, mark: str) -> None:
    found = [cd.stress_marks(*quiet(seed, kind), 20, seed=seed) for seed in range(1000, 1006)]
    assert sum(marks is not None and mark in marks.found for marks in found) >= 5


@pytest.mark.parametrize("kind", ["white", "ar1", "slow", "trend", "bleaching"])
def test_steady_series_have_none(kind: str) -> None:
    marked = 0
    for seed in range(1010, 1020):
        a, b = quiet(seed, kind if kind in ("white", "slow") else "ar1")
        time = a["frame"] / FRAMES
        if kind == "trend":
            a, b = a + 5.0 * time, b - 4.0 * time
        if kind == "bleaching":
            a = a + 6.0 * np.exp(-3.0 * time)
        marks = cd.stress_marks(a, b, 20, seed=seed)
        assert marks is not None
        marked += bool(marks.found)
    assert marked <= 1


def test_frames_of_a_pulse_are_named_in_both() -> None:
    a, b = quiet(1001)
    a = a.assign_coords(frame=("time", np.arange(100, 100 + FRAMES)))
    b = b.assign_coords(frame=("time", np.arange(100, 100 + FRAMES)))
    leap = np.zeros(FRAMES)
    leap[30:33] = 7.0
    up = xr.DataArray(leap, dims="time")
    marks = cd.stress_marks(a + up, b - up.roll(time=5), 10)
    assert marks is not None
    assert marks.found == ("common pulse",)
    assert marks.pulse_frames == (130, 131, 132, 135, 136, 137)
    away = cd.stress_marks(a + up, b - up.roll(time=25), 10)  # too far apart to correlate at any lag
    assert away is not None
    assert "common pulse" not in away.found


def test_an_episode_is_where_it_was_put() -> None:
    a, b = quiet(1002, "white")
    gain = xr.DataArray(np.where((np.arange(FRAMES) >= 20) & (np.arange(FRAMES) < 40), 4.0, 1.0), dims="time")
    marks = cd.stress_marks(a * gain, b * gain, 10)
    assert marks is not None
    assert marks.found == ("restless episode",)
    np.testing.assert_allclose(marks.episode_frames, (20, 39), atol=3)
    assert marks.episode_ratio > 4.0
    alone = cd.stress_marks(a * gain, b, 10)  # one restless series alone makes no correlation
    assert alone is not None
    assert alone.found == ()


def test_a_variance_that_falls_is_a_change_too_and_opposite_ones_are_none() -> None:
    a, b = quiet(1003, "white", 120)
    fall = xr.DataArray(np.linspace(3.0, 0.5, 120), dims="time")
    marks = cd.stress_marks(a * fall, b * fall, 10)
    assert marks is not None
    assert marks.found == ("variance change",)
    assert marks.variance_ratio < 0.5
    crossed = cd.stress_marks(a * fall, b * fall.copy(data=fall[::-1]), 10)
    assert crossed is not None
    assert crossed.variance_ratio == 1.0
    assert "variance change" not in crossed.found


def test_the_period_is_that_of_both() -> None:
    a, b = quiet(1004, "white")
    frames = xr.DataArray(np.arange(FRAMES), dims="time")
    waves = [2.0 * np.sin(2.0 * np.pi * frames / period) for period in (8.0, 13.0)]
    shared = cd.stress_marks(a + waves[0], b + waves[0].roll(time=3), 10)
    assert shared is not None
    assert shared.found == ("steady oscillation",)
    assert shared.line_period == pytest.approx(8.0, rel=0.05)
    other = cd.stress_marks(a + waves[0], b + waves[1], 10)
    assert other is not None
    assert "steady oscillation" not in other.found


def test_gaps_are_left_out_and_too_little_is_not_judged() -> None:
    a, b = quiet(1005, "pulse")
    holes = np.random.default_rng(0).random(a.shape) < 0.1
    b = b.where(b["frame"] < FRAMES - 1)
    marks = cd.stress_marks(a.where(~holes), b, 10)
    assert marks is not None
    assert "common pulse" in marks.found
    assert cd.stress_marks(a[:19], b[:19], 4) is None
    assert cd.stress_marks(0.0 * a, b, 10) is None


def test_scans_of_energies_known_on_paper() -> None:
    steady = np.ones(60)
    step = np.where((np.arange(60) >= 12) & (np.arange(60) < 24), 9.0, 1.0)
    episode = restless_episode(step, step)
    assert abs(int(episode.first) - 12) <= 1
    assert float(episode.ratio) == pytest.approx(9.0, rel=0.2)
    assert float(restless_episode(step, steady).ratio) == pytest.approx(1.0)
    assert float(restless_episode(steady, steady).gain) == pytest.approx(0.0, abs=1e-9)
    late = np.repeat([1.0, 4.0], 30)
    assert float(variance_ramp(late, late**2).ratio) == pytest.approx(4.0)
    spike = steady.copy()
    spike[20:23] = 10.0
    pulse = common_pulse(spike, np.roll(spike, -4), 6)
    assert (int(pulse.first), int(pulse.lag)) == (20, -4)
    assert float(pulse.share) == pytest.approx(300.0 / 353.0 * 56.0 / 60.0)  # 3 of 100, 53 of 1, 56 pairs


def test_one_outlier_is_no_energy_and_makes_heavy_tails() -> None:
    values = np.random.default_rng(0).normal(size=(200, 40))
    values[50, 0] = 1e3
    energy = capped_energy(values)
    assert energy[50] < 2.0
    assert energy.mean() == pytest.approx(1.0)
    assert kurtosis(values[:, 1:]) == pytest.approx(3.0, abs=0.15)
    assert kurtosis(values[:, :1]) > 100.0


@pytest.mark.parametrize("width", [2.0, 12.0])
@pytest.mark.parametrize("lag", [None, 3])
def test_ordinary_motion_that_hangs_together_has_no_line(width: float, lag: int | None) -> None:
    """Velocity of an edge whose position is smooth in time and around the cell; alone, and followed."""
    marked = 0
    for seed in range(1000, 1020):
        noise = np.random.default_rng(seed).normal(size=(2, FRAMES + 61, 24))
        place = gaussian_filter(noise, (0.0, 2.0, width), mode=("nearest", "nearest", "wrap"))
        first, other = np.diff(place, axis=1)[:, 30:]
        second = other if lag is None else np.roll(first, lag, axis=0) + 0.5 * other
        marked += shared_line(first[lag or 0 : FRAMES], second[lag or 0 : FRAMES]).p <= 0.01
    assert marked <= 2


def test_a_line_stands_out_of_red_noise_and_red_noise_does_not() -> None:
    a, b = quiet(1006, "slow", 200)
    tables = [series.to_numpy().reshape(200, -1) for series in (a, b)]
    assert shared_line(*tables).prominence < 5.0
    wave = np.sqrt(3.0) * np.cos(2.0 * np.pi * np.arange(200)[:, None] / 10.0)
    found = shared_line(*(table + wave for table in tables))
    assert found.period == pytest.approx(10.0)
    assert found.prominence > 20.0
    assert found.p < 1e-6
    assert 0.5 < found.share < 0.8
