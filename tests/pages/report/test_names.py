from pathlib import Path

import pandas as pd
import pytest

from cytodisk.pages.report.shown_names import (
    differences,
    file_name,
    labels_of,
    without_folders,
)
from cytodisk.runs.channel_names import correlation_name, shown_name
from cytodisk.store.study import Study


def test_numbered_channels_have_one_name() -> None:
    assert [shown_name(name) for name in ("0", "12", "VASP", "velocity")] == [
        "channel 0",
        "channel 12",
        "VASP",
        "velocity",
    ]


@pytest.mark.parametrize(
    ("names", "words"),
    [
        (("edge", "velocity"), "edge with velocity"),
        (("0", "velocity"), "channel 0 with velocity"),
        (("edge", "velocity", "early"), "edge with velocity (early)"),
    ],
)
def test_correlations_in_words(names: tuple[str, ...], words: str) -> None:
    assert correlation_name(names) == words


def test_only_what_is_not_usual_is_told() -> None:
    usual = {"detrend": "none", "skip_lags": [], "rule": "nearest", "against": "window", "surrogates": 1999}
    assert differences(usual) == ""
    told = differences(usual | {"detrend": "linear", "skip_lags": [-1, 0], "against": "edge"})
    assert told == "linear detrending, without lags −1, 0, against the edge"


def test_labels_tell_correlations_of_the_same_names_apart() -> None:
    detrended = {"name": "b", "detrend": "linear"}
    pairs = [(("A", "velocity"), {}), (("A", "velocity", "b"), detrended), (("B", "velocity"), detrended)]
    assert labels_of(pairs) == [
        "A with velocity",
        "A with velocity (b): linear detrending",
        "B with velocity",
    ]


@pytest.mark.parametrize("path", ["/home/me/cell.tif", "data/cell.tif", r"C:\me\cell.tif", "cell.tif"])
def test_folders_are_left_out(path: str) -> None:
    assert file_name(path) == "cell.tif"
    study = Study(Path("x"), pd.DataFrame(), {"inputs": {"masks": {"path": path}}})
    assert without_folders(f"refused: {path} is damaged", study) == "refused: cell.tif is damaged"
