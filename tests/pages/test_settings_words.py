import numpy as np

from cytodisk.pages.settings_words import scope_words, settings_words, used_windows


def test_defaults_need_no_words() -> None:
    usual = {"detrend": "none", "difference": False, "skip_lags": [], "rule": "nearest", "null": "phase"}
    usual |= {"surrogates": 1999, "min_pairs": 10, "sectors": None, "frames": None, "without_frames": []}
    assert settings_words(usual) == []
    assert settings_words({}) == []  # of an older study
    assert used_windows(usual, 3, 5, 4).all()


def test_what_differs_is_said() -> None:
    assert settings_words({"detrend": "median", "detrend_frames": 41, "name": "late"}) == [
        "“late”",
        "median detrending (41 frames)",
    ]
    assert settings_words({"statistic": "spearman"}) == ["Spearman (ranks)"]
    words = settings_words({"skip_lags": [0], "difference": True, "rule": "largest", "null": "shift"})
    assert words == [
        "differences between frames",
        "without lag 0",
        "largest peak",
        "surrogates by circular shift",
    ]
    assert settings_words({"surrogates": 0, "min_pairs": 5}) == [
        "no surrogates",
        "5 or more frames at a lag",
    ]


def test_geometry_that_was_not_tested_is_said() -> None:
    assert settings_words({"geometry": False}) == ["geometry was not tested"]
    assert settings_words({"geometry": True}) == []


def test_numbers_in_a_row_are_a_range() -> None:
    assert scope_words({"sectors": [3, 20]}) == ["only sectors 3–20"]
    assert scope_words({"sectors": (7, 7), "frames": [50, 80]}) == ["only sectors 7", "only frames 50–80"]
    assert scope_words({"without_frames": [4, 9]}) == ["without frames 4, 9"]
    assert scope_words({"without_frames": [0, 1, 2, 7, 9, 8]}) == ["without frames 0–2, 7–9"]


def test_used_windows_are_those_of_the_settings() -> None:
    used = used_windows({"sectors": [4, 1], "frames": [11, 13], "without_frames": [12]}, 10, 5, 6)
    times, places = np.array([False, True, False, True, False]), np.array([1, 1, 0, 0, 1, 1], dtype=bool)
    np.testing.assert_array_equal(used, times[:, None] & places)
    used = used_windows({"sectors": [2, 3], "without_frames": [10, 14]}, 10, 5, 6)
    np.testing.assert_array_equal(np.flatnonzero(used.any(axis=0)), [2, 3])
    np.testing.assert_array_equal(np.flatnonzero(used.any(axis=1)), [1, 2, 3])
