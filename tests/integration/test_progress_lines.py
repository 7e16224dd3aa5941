"""Progress where stderr is no terminal."""

import pytest

from cytodisk.cli import console
from cytodisk.runs.told.speed_words import rate_words


def test_a_log_gets_a_line_every_half_minute(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    reads = iter([100.0, 100.0, 129.0, 130.0, 159.0, 160.0])
    monkeypatch.setattr(console.clock, "monotonic", lambda: next(reads))
    lines = console.ProgressLines("frames of 3 methods")
    for done in (6, 20, 24, 30, 36):
        lines.report(done, 36)
    assert capsys.readouterr().err.splitlines() == [
        "frames of 3 methods 24/36, 0.6 frames/s, 20 s left",
        "frames of 3 methods 36/36, 0.5 frames/s",
    ]


def test_percents_have_no_rate(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    reads = iter([0.0, 0.0, 32.0])
    monkeypatch.setattr(console.clock, "monotonic", lambda: next(reads))
    lines = console.ProgressLines("percent")
    for done in (0, 33):
        lines.report(done, 99)
    assert capsys.readouterr().err == "33 %, 64 s left\n"


def test_no_time_is_left_before_the_third_frame(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    reads = iter([0.0, 40.0, 80.0, 120.0])
    monkeypatch.setattr(console.clock, "monotonic", lambda: next(reads))
    lines = console.ProgressLines("frames")
    for done in (1, 2, 3):
        lines.report(done, 4)
    assert capsys.readouterr().err.splitlines() == [
        "frames 1/4",
        "frames 2/4, 0.75 frames/min",
        "frames 3/4, 1 frames/min, 60 s left",
    ]


@pytest.mark.parametrize(
    ("a_second", "words"),
    [(1234.5, "1234 inputs/s"), (0.25, "0.25 inputs/s"), (0.05, "3 inputs/min"), (1 / 1800, "2 inputs/h")],
)
def test_a_rate_is_said_over_a_time_in_which_something_happens(a_second: float, words: str) -> None:
    assert rate_words(a_second, "inputs") == words


@pytest.mark.parametrize("quiet", [False, True])
def test_quiet_means_no_lines(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], quiet: bool
) -> None:
    monkeypatch.setattr(console, "SECONDS_A_LINE", 0.0)
    with console.progress_bar(quiet, "cells") as report:
        report(1, 2)
    lines = capsys.readouterr().err.splitlines()
    assert [line.split(",")[0] for line in lines] == ([] if quiet else ["cells 1/2"])
