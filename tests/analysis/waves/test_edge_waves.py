"""Waves around a cell: known speed, direction and period are found, and what cannot be seen is said."""

from typing import Any

import numpy as np
import pytest

import cytodisk as cd
from cytodisk.errors import ParameterError

FEW = {"surrogates": 39}


def running(direction: int = 1, mode: int = 2, **more: Any) -> Any:
    return cd.simulate.wave_series(
        "running", 3, frames=48, sectors=24, mode=mode, period_s=60.0, direction=direction, noise=1.0, **more
    )


@pytest.mark.parametrize("direction", [1, -1])
def test_speed_direction_and_kind_of_a_running_wave(direction: int) -> None:
    wave = running(direction)
    found = cd.edge_waves(wave, edge_length_um=100.0, **FEW)
    assert found["kind"] == "rotating"
    assert found["mode"] == 2
    assert found["direction"] * direction > 0.9
    assert found["speed"].item() == pytest.approx(wave.attrs["speed"], rel=0.1)
    assert found["speed_um_s"].item() == pytest.approx(wave.attrs["speed_um_s"], rel=0.1)


def test_where_sector_0_is_does_not_matter() -> None:
    wave = running()
    found = cd.edge_waves(wave, **FEW)
    turned = cd.edge_waves(wave.roll(sector=7, roll_coords=False), **FEW)
    for name in ("mode", "period_s", "speed", "direction", "persistence_s", "order", "p"):
        assert turned[name].item() == pytest.approx(found[name].item(), rel=1e-6)
    back = np.exp(1j * turned["phase"].roll(sector=-7, roll_coords=False))
    assert np.abs(back - np.exp(1j * found["phase"])).max() < 1e-6


def test_a_short_movie_is_refused_with_its_periods() -> None:
    with pytest.raises(ParameterError, match=r"8 frames, 8 s, the longest .* 6.66667 s: pass at least 12"):
        cd.edge_waves(np.random.default_rng(0).normal(size=(10, 8)), frame_interval_s=1.0)
