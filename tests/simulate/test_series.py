import numpy as np
import pytest

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.simulate import SERIES_KINDS, coupled_series, independent_series
from cytodisk.simulate.null_series import SeriesKind

FRAMES, LAYERS, SECTORS = 1500, 3, 48
OSCILLATION = 2.0 * 0.9 * np.cos(2.0 * np.pi / 10.0)


def at_lag(leading: FloatArray, following: FloatArray, lag: int) -> FloatArray:
    """Mean over time of the product, the second one so many frames later."""
    count = len(leading)
    return np.asarray(
        (leading[max(0, -lag) : count - max(0, lag)] * following[max(0, lag) : count - max(0, -lag)]).mean(
            axis=0
        )
    )


@pytest.mark.parametrize(
    ("kind", "one", "two"),
    [
        ("white", 0.0, 0.0),
        ("ar1", 0.8, 0.64),
        ("slow", 0.95, 0.9025),
        ("smooth", np.exp(-1.0 / 16.0), np.exp(-4.0 / 16.0)),
        ("oscillating", OSCILLATION / 1.81, OSCILLATION**2 / 1.81 - 0.81),  # Yule and Walker's equations
    ],
)
def test_series_have_the_autocorrelation_of_their_kind(kind: SeriesKind, one: float, two: float) -> None:
    for series in independent_series(kind, 1, FRAMES, LAYERS, SECTORS, correlation_length=0.5):
        values = series.to_numpy()
        found = [at_lag(values, values, lag).mean() / np.mean(values**2) for lag in (1, 2)]
        np.testing.assert_allclose(found, [one, two], atol=0.03)


@pytest.mark.parametrize("kind", SERIES_KINDS)
def test_series_have_variance_1_from_the_first_frame_to_the_last(kind: SeriesKind) -> None:
    both = [independent_series(kind, seed, 30, 2, 20, correlation_length=0.3) for seed in range(150)]
    for values in (np.stack([pair[k].to_numpy() for pair in both]) for k in (0, 1)):
        for frame in (0, 1, 15, 29):
            assert values[:, frame].std() == pytest.approx(1.0, abs=0.06)
            assert values[:, frame].mean() == pytest.approx(0.0, abs=0.06)


def test_an_oscillating_series_has_its_peak_at_a_period_of_ten_frames() -> None:
    _, velocity = independent_series("oscillating", 2, 1000, 1, 60)
    power = (np.abs(np.fft.rfft(velocity.to_numpy(), axis=0)) ** 2).mean(axis=1)
    smooth = np.convolve(power, np.ones(15) / 15.0, mode="same")
    assert 1000.0 / smooth.argmax() == pytest.approx(10.0, abs=1.0)


@pytest.mark.parametrize("length", [1.0, 3.0])
def test_neighbours_are_correlated_over_the_length_all_around_and_inwards(length: float) -> None:
    activity, velocity = (
        series.to_numpy() for series in independent_series("white", 3, 4000, 5, 24, correlation_length=length)
    )
    np.testing.assert_allclose(activity.var(axis=0), 1.0, atol=0.12)
    for apart in (1, 2, 5):
        expected = np.exp(-0.5 * (apart / length) ** 2)
        for values in (velocity, activity):
            assert np.mean(values * np.roll(values, apart, axis=-1)) == pytest.approx(expected, abs=0.05)
        if apart < 5:
            inwards = np.mean(activity[:, apart:] * activity[:, :-apart])
            assert inwards == pytest.approx(expected, abs=0.05)


def test_without_a_length_windows_are_independent() -> None:
    activity, velocity = independent_series("white", 4, 4000, 3, 10, correlation_length=0.0)
    for values in (velocity.to_numpy(), activity.to_numpy().reshape(4000, -1)):
        together = np.corrcoef(values.T) - np.eye(values.shape[1])
        assert np.abs(together).max() < 0.08


@pytest.mark.parametrize("kind", SERIES_KINDS)
def test_activity_does_not_know_velocity(kind: SeriesKind) -> None:
    activity, velocity = (s.to_numpy() for s in independent_series(kind, 5, FRAMES, LAYERS, SECTORS))
    for lag in (-7, 0, 3):
        # "slow" remembers longest: 1500 frames are about 75 independent ones, times 20 sectors.
        assert abs(at_lag(velocity[:, None], activity, lag).mean()) < 0.1


@pytest.mark.parametrize("kind", ["white", "ar1", "smooth"])
@pytest.mark.parametrize("lag", [4, 0, -3])
def test_coupled_windows_follow_their_sector_by_the_lag(kind: SeriesKind, lag: int) -> None:
    windows = np.zeros((LAYERS, SECTORS), dtype=bool)
    windows[0, 5:25] = windows[2, 40:] = True
    activity, velocity = (
        series.to_numpy()
        for series in coupled_series(
            kind, 6, FRAMES, LAYERS, SECTORS, lag_frames=lag, windows=windows, strength=-0.6
        )
    )
    found = {shift: at_lag(velocity[:, None], activity, shift) for shift in range(-8, 9)}
    inside = {shift: values[windows].mean() for shift, values in found.items()}
    assert min(inside, key=inside.__getitem__) == lag
    assert inside[lag] == pytest.approx(-0.6, abs=0.05)
    assert max(abs(values[~windows].mean()) for values in found.values()) < 0.05
    assert activity[:, windows].var() == pytest.approx(1.0, abs=0.05)


def test_full_strength_is_the_velocity_itself_and_other_windows_are_as_without() -> None:
    windows = np.zeros((2, 12), dtype=bool)
    windows[1, 3:7] = True
    activity, velocity = coupled_series("ar1", 7, 50, 2, 12, lag_frames=5, windows=windows, strength=1.0)
    np.testing.assert_allclose(activity[5:, 1, 3:7], velocity[:-5, 3:7], atol=1e-12)
    alone, _ = independent_series("ar1", 7, 50, 2, 12)
    np.testing.assert_array_equal(activity.to_numpy()[:, ~windows], alone.to_numpy()[:, ~windows])


def test_series_repeat_and_are_labelled() -> None:
    first, again, other = (independent_series("smooth", seed, 20, 3, 8) for seed in (1, 1, 2))
    assert first[0].identical(again[0])
    assert first[1].identical(again[1])
    assert not np.array_equal(first[0], other[0])
    assert first[0].dims == ("time", "layer", "sector")
    assert first[1].dims == ("time", "sector")
    assert first[0].shape == (20, 3, 8)
    assert first[1].attrs["units"] == "px/frame"
    assert np.isfinite(first[1]).all()
    tiny, _ = independent_series("slow", 0, 1, 1, 1)
    assert tiny.shape == (1, 1, 1)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"kind": "pink"}, "kind must be one of white, .* got 'pink'"),
        ({"seed": -1}, "seed"),
        ({"frames": 0}, "frames"),
        ({"layers": 1.5}, "layers must be a whole number"),
        ({"sectors": "60"}, "sectors"),
        ({"correlation_length": -1.0}, "correlation_length"),
        ({"lag_frames": 0.5}, "lag_frames"),
        ({"lag_frames": -100}, "lag_frames"),
        ({"strength": 1.1}, "strength must be a number from -1 to 1, got 1.1"),
        ({"strength": np.nan}, "strength"),
        (
            {"windows": np.ones((3, 2), bool)},
            r"windows must be bool of shape \(2, 3\), got bool of shape \(3, 2\)",
        ),
        ({"windows": np.ones((2, 3))}, "windows must be bool .* got float64"),
    ],
)
def test_bad_arguments_of_series_are_named(wrong: dict[str, object], message: str) -> None:
    right: dict[str, object] = {"kind": "white", "seed": 0, "frames": 20, "layers": 2, "sectors": 3}
    right |= {"lag_frames": 1, "windows": np.ones((2, 3), bool)}
    with pytest.raises(ParameterError, match=message):
        coupled_series(**(right | wrong))  # type: ignore[arg-type]
