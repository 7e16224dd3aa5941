import numpy as np
import pandas as pd
import pytest

from cytodisk.runs.qc_flags.signal_drift import FEWEST_FRAMES, mean_by_frame, relative_trend

TIME = np.arange(21.0)


def test_trend_of_a_line() -> None:
    assert relative_trend(TIME, 100 - TIME) == pytest.approx(-20 / 90)
    assert relative_trend(TIME, 80 + TIME) == pytest.approx(20 / 90)


def test_trend_of_a_long_movie() -> None:
    time = np.arange(5000.0)
    assert relative_trend(time, 200 - 0.02 * time) == pytest.approx(-100 / 150, rel=0.01)


def test_one_wrong_frame_changes_nothing() -> None:
    mean = 100 - TIME
    mean[5] = 1e6
    assert relative_trend(TIME, mean) == pytest.approx(-20 / 90, rel=0.1)


@pytest.mark.parametrize(
    "mean",
    [np.full(21, 5.0), np.zeros(21), 100 + 30 * np.cos(2 * np.pi * TIME / 20), np.zeros(0)],
    ids=["constant", "dark", "wave", "none"],
)
def test_no_trend(mean: np.ndarray) -> None:
    assert relative_trend(TIME[: mean.size], mean) == 0.0


def test_too_few_frames() -> None:
    few = TIME[: FEWEST_FRAMES - 1]
    assert relative_trend(few, 100 - 10 * few) == 0.0


def test_mean_counts_windows_by_their_pixels_and_leaves_unknown_ones_out() -> None:
    windows = pd.DataFrame(
        {
            "cell": 0,
            "channel": "VASP",
            "frame": [0, 0, 1, 1],
            "mean": [1.0, 5.0, 3.0, np.nan],
            "n_pixels": [3.0, 1.0, 2.0, 9.0],
        }
    )
    assert mean_by_frame([windows]).tolist() == [2.0, 3.0]
    assert mean_by_frame([windows[:1], windows[1:]]).tolist() == [2.0, 3.0]
