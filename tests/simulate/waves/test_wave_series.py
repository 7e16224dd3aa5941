from typing import Any

import numpy as np
import pytest

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.simulate import WAVE_KINDS, wave_series


def turned_by(values: FloatArray, mode: int) -> FloatArray:
    """Turns of one mode's phase through time, from the first frame on, along the last axis."""
    share = np.fft.fft(values, axis=-1)[..., mode]
    return np.asarray(-np.unwrap(np.angle(share), axis=0) / (2.0 * np.pi))


@pytest.mark.parametrize(("mode", "direction"), [(1, 1), (3, -1)])
def test_a_running_wave_has_the_stated_speed_period_and_direction(mode: int, direction: int) -> None:
    wave = wave_series("running", 0, 81, 48, mode=mode, direction=direction, period_s=80.0, noise=0.0)
    turns = turned_by(wave.to_numpy(), mode)
    assert wave.time_s[-1] == 400.0
    np.testing.assert_allclose(turns - turns[0], direction * wave.time_s / 80.0, atol=1e-9)
    assert wave.attrs["speed"] == pytest.approx(direction / (mode * 80.0))
    assert wave.attrs["speed_um_s"] == pytest.approx(direction * 100.0 / (mode * 80.0))
    # A crest that is seen in a sector is seen one turn of the cell later there again.
    np.testing.assert_allclose(wave[16], wave[0], atol=1e-9)
    assert wave.max() == pytest.approx(1.0, abs=0.02)
    np.testing.assert_array_equal(wave.direction, direction)


def test_a_standing_wave_goes_nowhere() -> None:
    wave = wave_series("standing", 1, 61, 40, mode=2, period_s=50.0, noise=0.0)
    modes = np.fft.fft(wave.to_numpy(), axis=1)
    forth, back = (np.abs(np.fft.fft(modes[:60, mode])) for mode in (2, -2))
    np.testing.assert_allclose(forth.max(), back.max(), rtol=1e-6)
    assert np.linalg.matrix_rank(wave.to_numpy(), tol=1e-9) == 1  # one pattern times one series
    assert wave.attrs["speed"] == wave.attrs["direction"] == 0
    together = wave_series("standing", 1, 61, 40, mode=0, noise=0.0).to_numpy()
    assert np.ptp(together, axis=1).max() == 0.0


@pytest.mark.parametrize(("kind", "inwards"), [("spiral", 0.1), ("inward", 0.1), ("outward", -0.1)])
def test_waves_run_inwards_by_the_depth_of_layers(kind: Any, inwards: float) -> None:
    wave = wave_series(
        kind, 0, 40, 24, 10, mode=2, noise=0.0, wavelength_um=10.0, layer_depth_um=2.0, amplitude=3.0
    )
    assert wave.dims == ("time", "layer", "sector")
    np.testing.assert_allclose(wave.depth_um, np.arange(1.0, 20.0, 2.0))
    # Four frames of 5 s take a crest 2 µm on its way: one layer.
    later, earlier = wave.to_numpy()[4:], wave.to_numpy()[:-4]
    if inwards > 0:
        np.testing.assert_allclose(later[:, 1:], earlier[:, :-1], atol=1e-9)
    else:
        np.testing.assert_allclose(later[:, :-1], earlier[:, 1:], atol=1e-9)
    assert wave.attrs["inward_speed_um_s"] == pytest.approx(inwards)
    assert wave.attrs["speed"] == (1.0 / 200.0 if kind == "spiral" else 0.0)
    assert wave.max() == pytest.approx(3.0, rel=0.02)


@pytest.mark.parametrize("kind", WAVE_KINDS)
def test_noise_is_the_stated_share_of_the_wave(kind: Any) -> None:
    settings: dict[str, Any] = {"persistence_s": 100.0, "amplitude": 2.0}
    quiet, noisy = (wave_series(kind, 3, 2000, 20, 2, noise=noise, **settings) for noise in (0.0, 0.5))
    added = (noisy - quiet).to_numpy()
    assert added.std() == pytest.approx(0.5 * quiet.to_numpy().std(), rel=0.06)
    assert np.mean(added[1:] * added[:-1]) / np.mean(added**2) == pytest.approx(0.0, abs=0.02)
    assert np.mean(added * np.roll(added, 1, axis=2)) / np.mean(added**2) == pytest.approx(
        np.exp(-0.5), abs=0.03
    )


def test_noise_has_the_stated_memory_from_the_first_frame_on() -> None:
    made = np.stack(
        [
            (
                wave_series("running", seed, 40, 30, noise=1.0, noise_memory=0.9, correlation_length=0.0)
                - wave_series("running", seed, 40, 30, noise=0.0)
            ).to_numpy()
            for seed in range(20)
        ]
    )
    np.testing.assert_allclose(np.mean(made**2, axis=(0, 2)), 0.5, atol=0.1)
    assert np.mean(made[:, 1:] * made[:, :-1]) / np.mean(made**2) == pytest.approx(0.9, abs=0.02)


@pytest.mark.parametrize("kind", ["running", "none"])
def test_the_phase_is_forgotten_as_stated_in_waves_and_in_noise_with_their_spectrum(kind: Any) -> None:
    """Both have the autocorrelation exp(-lag / persistence) cos(2π lag / period) in each sector."""
    settings: dict[str, Any] = {"period_s": 50.0, "persistence_s": 100.0, "noise": 0.0}
    made = np.stack([wave_series(kind, seed, 600, 8, **settings).to_numpy() for seed in range(25)])
    assert np.mean(made**2) == pytest.approx(0.5, rel=0.1)
    for lag in (5, 10, 20):
        expected = 0.5 * np.exp(-lag / 20.0) * np.cos(2.0 * np.pi * lag / 10.0)
        assert np.mean(made[:, lag:] * made[:, :-lag]) == pytest.approx(expected, abs=0.05)


def test_without_a_wave_no_direction_is_kept() -> None:
    made = wave_series("none", 5, 4000, 24, persistence_s=100.0, noise=0.0).to_numpy()
    power = np.abs(np.fft.fft2(made)) ** 2
    forth, back = power[1:2000, 1:4].sum(), power[1:2000, -3:].sum()
    assert forth / (forth + back) == pytest.approx(0.5, abs=0.12)
    assert np.mean(made * np.roll(made, 1, axis=1)) / np.mean(made**2) == pytest.approx(
        np.exp(-0.5), abs=0.06
    )


def test_a_wave_turns_round_at_known_frames() -> None:
    wave = wave_series("running", 2, 200, 30, reversals=3, noise=0.0)
    changes = np.flatnonzero(np.diff(wave.direction))
    assert len(changes) == 3
    steps = np.diff(turned_by(wave.to_numpy(), 1))
    np.testing.assert_allclose(steps, wave.direction[1:] / 20.0, atol=1e-9)
    np.testing.assert_allclose(np.diff(wave.phase), 2.0 * np.pi * wave.direction[1:] / 20.0, atol=1e-9)


def test_a_cell_that_turns_takes_its_wave_along() -> None:
    still, turning = (
        wave_series("running", 4, 60, 32, mode=2, drift=drift, noise=0.0) for drift in (0.0, 0.001)
    )
    turns = turned_by(turning.to_numpy(), 2) / 2.0
    seen = np.polyfit(turning.time_s, turns, 1)[0]
    assert seen == pytest.approx(still.attrs["speed"] + 0.001)
    assert turning.attrs["speed"] == still.attrs["speed"]
    assert turning.attrs["drift"] == 0.001


@pytest.mark.parametrize(
    ("kind", "settings", "words"),
    [
        ("running", {"mode": 0}, "needs a mode of at least 1"),
        ("standing", {"mode": 6}, "mode must be below half of the 12 sectors, got 6"),
        ("spiral", {}, "kind 'spiral' runs through layers: pass layers"),
        ("running", {"period_s": 9.0}, "period_s must be at least two frames of 5 s, got 9"),
        ("running", {"direction": 0}, "direction must be 1 or -1, got 0"),
        ("running", {"reversals": 20}, "reversals must be below the 20 frames, got 20"),
        ("running", {"noise_memory": 1.0}, "noise_memory must be"),
        ("sideways", {}, "kind must be one of running, standing"),
    ],
)
def test_a_wave_that_cannot_be_is_refused(kind: Any, settings: dict[str, Any], words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        wave_series(kind, 0, 20, 12, **settings)


def test_noise_that_never_forgets_its_phase_has_values_at_every_period() -> None:
    for period in np.linspace(60.0, 150.0, 40):
        values = wave_series("none", 0, 20, 6, period_s=float(period))
        assert np.isfinite(values).all()
