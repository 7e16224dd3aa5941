"""The command that prints figures beside their targets: its blocks are there, and a missed target is said."""

import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"


@pytest.fixture(scope="module")
def honest() -> Iterator[Any]:
    sys.path.insert(0, str(BENCHMARKS))
    try:
        yield import_module("honest")
    finally:
        sys.path.remove(str(BENCHMARKS))


def test_every_block_is_there_and_told_in_the_help(honest: Any) -> None:
    for name, module in honest.BLOCKS.items():
        assert callable(getattr(import_module(module), name))
        assert f"* {name}: " in honest.__doc__


def test_a_missed_target_and_a_block_that_fails_are_said(
    honest: Any, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    figure = import_module("figure").Figure
    blocks = ModuleType("blocks")
    blocks.__dict__["good"] = lambda trials: iter([figure("seen", 1.0, most=2.0), figure("told", 9.0)])
    blocks.__dict__["bad"] = lambda trials: iter([figure("seen", 3.0, most=2.0)])
    monkeypatch.setitem(sys.modules, "blocks", blocks)
    monkeypatch.setattr(honest, "BLOCKS", dict.fromkeys(("good", "bad", "none"), "blocks"))
    trials = honest.Trials(quick=True, given=None, workers=1)
    assert [honest.run(name, trials) for name in ("good", "bad", "none")] == [True, False, False]
    shown = capsys.readouterr().out
    assert "| seen | ≤ 2 | 3 | NO |" in shown
    assert "| block none |  | not measured | NO | AttributeError" in shown


def test_seeds_are_those_that_no_threshold_was_tuned_on(honest: Any) -> None:
    assert honest.Trials(False, None, 1).seeds(100, 4) == range(1000, 1100)
    assert honest.Trials(True, None, 1).seeds(100, 4) == range(1000, 1004)
    assert honest.Trials(True, (7, 9), 1).seeds(100, 4) == range(7, 10)


def test_the_true_velocity_of_a_disk_that_grows_is_its_speed_in_every_sector(honest: Any) -> None:
    from cytodisk import map_movie, simulate

    edge = import_module("honest_edge")
    truth = simulate.movie("growing", frames=3, radius_px=20.0, signals=False)
    known = edge.velocity_by_sector(truth, map_movie(truth.masks))
    np.testing.assert_allclose(known[:-1], 1.0, atol=1e-3)
    assert np.isnan(known[-1]).all()
