"""Waves on the whole disk: inwards, outwards, around and spirals of known speed."""

from typing import Any

import numpy as np
import pytest

import cytodisk as cd
from cytodisk.errors import ParameterError

FEW = {"surrogates": 19, "max_mode": 3}


def wave(kind: Any, **more: Any) -> Any:
    how = {"mode": 1, "period_s": 60.0, "wavelength_um": 6.0, "noise": 1.0} | more
    return cd.simulate.wave_series(kind, 1, 30, 8, 5, **how)


@pytest.mark.parametrize(
    ("kind", "expected"),
    [("inward", "inwards"), ("outward", "outwards"), ("running", "around"), ("spiral", "spiral")],
)
def test_kind_and_speeds(kind: str, expected: str) -> None:
    values = wave(kind)
    found = cd.disk_waves(values, edge_length_um=100.0, **FEW)
    assert found["kind"] == expected
    if kind != "running":
        assert found["inward_speed_um_s"].item() == pytest.approx(values.attrs["inward_speed_um_s"], rel=0.1)
    if kind in ("running", "spiral"):
        assert found["speed_um_s"].item() == pytest.approx(values.attrs["speed_um_s"], rel=0.1)


@pytest.mark.slow
def test_a_wave_towards_lower_sectors_that_runs_inwards() -> None:
    found = cd.disk_waves(wave("spiral", direction=-1, noise=0.3), **FEW)
    seen = wave("spiral", noise=0.3)
    mirrored = cd.disk_waves(seen.copy(data=seen.to_numpy()[..., ::-1]), **FEW)
    assert found["direction"] < -0.9
    assert mirrored["direction"] < -0.9
    assert mirrored["inward_direction"] > 0.5


def test_layers_without_values_are_left_out_and_said() -> None:
    values = wave("inward").copy()
    values[:, 2] = np.nan
    values["layer"] = np.arange(3, 8)
    found = cd.disk_waves(values, **FEW)
    assert found.attrs["layers_without_values"] == [5]
    assert np.isnan(found["layer_power"][2])
    assert found["inward_speed_um_s"].item() == pytest.approx(values.attrs["inward_speed_um_s"], rel=0.1)


def test_depths_must_increase() -> None:
    with pytest.raises(ParameterError, match="increase from layer to layer"):
        cd.disk_waves(wave("inward"), depth_um=[5.0, 4.0, 3.0, 2.0, 1.0], **FEW)
