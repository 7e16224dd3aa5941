"""The benchmark of simulated cells whose edge moves, on one movie of each kind."""

import sys
from pathlib import Path
from typing import Any

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import moving_truth


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_a_short_run_prints_what_was_put_in_and_what_came_out(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    cell: dict[str, Any] = {"radius_px": 18.0, "sectors": 12}
    monkeypatch.setattr(moving_truth, "CELL", cell)
    monkeypatch.setattr(moving_truth, "PREDICT", {"one way": {"strength": 0.7, "edge_speed_px": 0.5}})
    monkeypatch.setattr(moving_truth, "FRAMES", 50)
    monkeypatch.setattr(moving_truth, "PERIODS", {0.5: 10})
    moving_truth.run(1, ("predict", "waves"), map)
    said = capsys.readouterr().out
    for case in ("| one way |", "| running, 0.5 µm/s |", "| standing |"):
        line = next(line for line in said.splitlines() if line.startswith(case))
        assert "| 1 (≥ 0.9) |" in line
        assert "MISSED" not in line
    assert "| none | " in said
