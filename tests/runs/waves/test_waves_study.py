"""Waves of a study: the numbers of the function, the way as on the picture, a row for every cell."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from wave_studies import series_study

import cytodisk as cd
from cytodisk.errors import ParameterError, StudyError
from cytodisk.runs.waves.run_waves import run_waves
from cytodisk.runs.waves.waves_columns import WAVE_TABLES
from cytodisk.scale import Scale

FEW: Any = {"surrogates": 19, "max_mode": 3}


def wave(kind: Any = "running", seed: int = 0, layers: int | None = None, **how: Any) -> xr.DataArray:
    settings = {"mode": 2, "period_s": 50.0, "frame_interval_s": 5.0} | how
    return cd.simulate.wave_series(kind, seed, 48, 12, layers, **settings)


def test_numbers_are_those_of_the_function(tmp_path: Path) -> None:
    study = series_study(tmp_path, [wave()])
    found = run_waves(study, **FEW)
    values = study.activity(0)["velocity"][:-1]
    expected = cd.edge_waves(values, frame_interval_s=5.0, edge_length_um=40.0, **FEW)
    row = found.cells.iloc[0]
    for name in ("mode", "period_s", "speed", "direction", "persistence_s", "order", "p"):
        assert row[name] == pytest.approx(float(expected[name])), name
    assert row["speed_um_s"] == row["edge_speed"] == pytest.approx(40.0 / 100.0, rel=0.05)
    assert (row["kind"], row["way"], row["mode"], row["frames"]) == ("rotating", "clockwise", 2, 47)
    assert row["period"] == pytest.approx(10.0, rel=0.05)
    assert row["periods"] == pytest.approx(47 / row["period"])
    phase = found.phase.set_index(["frame", "sector"])["phase"].to_xarray()
    np.testing.assert_array_equal(phase, expected["wave_phase"])
    assert found.phase["time_s"].max() == 230.0
    assert study.wave_signals == [("velocity",)]
    assert found.settings["surrogates"] == 19


def test_tables_have_the_columns_that_are_told(tmp_path: Path) -> None:
    found = run_waves(series_study(tmp_path, [wave(layers=2)]), "Rac1", geometry=False, **FEW)
    for name, columns in WAVE_TABLES.items():
        table = getattr(found, name)
        if table is not None:
            assert table.columns.tolist() == [column.name for column in columns], name
            assert table.attrs["units"].keys() == {column.name for column in columns}
    assert found.layers.attrs["units"]["edge_speed"] == "µm/s"


def test_the_other_way_is_anticlockwise(tmp_path: Path) -> None:
    found = run_waves(series_study(tmp_path, [wave(direction=-1)]), **FEW)
    row = found.cells.iloc[0]
    assert row["way"] == "anticlockwise"
    assert row["edge_speed"] == pytest.approx(-40.0 / 100.0, rel=0.05)
    assert found.spectrum.loc[found.spectrum["power"].idxmax(), "mode"] == -2
    assert found.spectrum["power"].sum() == pytest.approx(found.modes["power"].sum())


def test_every_layer_of_a_signal_has_its_own_speed(tmp_path: Path) -> None:
    study = series_study(tmp_path, [wave(layers=3)])
    found = run_waves(study, "Rac1", layer=1, geometry=False, **FEW)
    assert found.layers["layer"].tolist() == [0, 1, 2]
    assert (found.layers["q"] >= found.layers["p"]).all()
    turn = found.layers["speed"].to_numpy()
    around = 12 * 2 * np.sin(np.pi / 12) * np.array([15.0, 10.0]) * 0.2  # of the middle of the layers, in µm
    np.testing.assert_allclose(found.layers["edge_speed"], turn * [40.0, *around], rtol=1e-6)
    assert found.cells["layer"].tolist() == [1]
    assert found.cells["edge_speed"].iloc[0] == found.layers["edge_speed"].iloc[1]


def test_a_spiral_runs_inwards_and_around(tmp_path: Path) -> None:
    values = wave("spiral", layers=3, mode=1, wavelength_um=6.0, noise=0.3)
    found = run_waves(series_study(tmp_path, [values]), "Rac1", geometry=False, **FEW)
    row = found.cells.iloc[0]
    assert (row["inside"], row["inside_way"], row["inside_mode"]) == ("spiral", "clockwise", 1)
    assert row["inward_speed"] == pytest.approx(0.12, rel=0.1)  # 6 µm in 50 s
    assert row["around_speed"] == pytest.approx(40.0 / 50.0, rel=0.1)
    assert found.depths is not None
    assert found.depths["depth"].tolist() == [0.5, 1.5, 2.5]
    np.testing.assert_allclose(found.depths["inward_speed"], 0.12, rtol=0.15)
    assert (np.diff(found.depths["lag_s"]) > 0).all()
    expected = cd.disk_waves(values, depth_um=[0.5, 1.5, 2.5], **FEW)["wave_phase"]
    inside = found.phase.set_index(["frame", "layer", "sector"])["phase_inside"].to_xarray()
    np.testing.assert_array_equal(inside, expected)


def test_a_layer_with_an_empty_window_has_waves_without_a_speed_along_it(tmp_path: Path) -> None:
    values = wave(layers=2)
    values[:, 1, 4] = np.nan
    study = series_study(tmp_path, [values])
    for axis in "yx":
        place = study.given[0][f"centroid_{axis}"]
        study.given[0][f"centroid_{axis}"] = place.where(values.notnull().values)
    layers = run_waves(study, "Rac1", geometry=False, **FEW).layers
    assert layers["status"].tolist() == ["ok", "ok"]
    assert layers["edge_speed"].isna().tolist() == [False, True]
    assert layers["speed"].iloc[1] == pytest.approx(0.01, rel=0.1)


def test_without_a_scale_numbers_are_in_frames_and_pixels(tmp_path: Path) -> None:
    found = run_waves(series_study(tmp_path, [wave()], scale=Scale()), **FEW)
    row = found.cells.iloc[0]
    assert row["period"] == pytest.approx(10.0, rel=0.05)
    assert row["edge_speed"] == pytest.approx(40.0 / 20.0, rel=0.05)
    assert row[["period_s", "speed", "speed_um_s", "persistence_s"]].isna().all()
    assert found.cells.attrs["units"]["edge_speed"] == "px/frame"


def test_a_cell_that_cannot_be_used_has_a_row_that_says_why(tmp_path: Path) -> None:
    study = series_study(tmp_path, [wave(), xr.zeros_like(wave())])
    found = run_waves(study, **FEW)
    assert found.cells["status"].tolist() == ["ok", "refused"]
    assert found.cells["reason"].iloc[1]
    assert found.layers["cell"].tolist() == [0]
    with pytest.raises(ParameterError, match="waves cannot be looked for in any cell"):
        run_waves(study, cells=[1], **FEW)


def test_a_wave_that_is_the_cells_motion_is_flagged(tmp_path: Path) -> None:
    study = series_study(tmp_path, [wave(noise=0.2)])
    still = np.random.default_rng(1).normal(size=study.given[0]["velocity"].shape)
    study.given[0]["velocity_cell_frame"] = (("time", "sector"), still)
    row = run_waves(study, **FEW).cells.iloc[0]
    assert row["p_partial"] > 0.05
    assert row["qc_flags"] == "waves of the cell's motion"
    again = run_waves(study, geometry=False, name="as it is", **FEW)
    assert again.cells["qc_flags"].tolist() == [""]


def test_without_registration_the_cells_motion_is_not_known(tmp_path: Path) -> None:
    study = series_study(tmp_path, [wave(noise=0.2)])
    study.provenance["parameters"]["registration"] = False
    row = run_waves(study, **FEW).cells.iloc[0]
    assert row["qc_flags"] == "cell's motion not tested"
    assert "without registration" in row["geometry_not_tested"]


def test_frames_are_those_that_were_asked_for(tmp_path: Path) -> None:
    found = run_waves(series_study(tmp_path, [wave()]), frames=(6, 40), name="middle", **FEW)
    assert found.path.name == "velocity~middle"
    assert found.phase["frame"].agg(["min", "max"]).tolist() == [6, 39]  # a step needs both frames


def test_wrong_names_are_refused_with_what_there_is(tmp_path: Path) -> None:
    study = series_study(tmp_path, [wave(layers=2)])
    with pytest.raises(ParameterError, match=r"signal 'RhoA' is not in the study: .*'velocity', .*'Rac1'"):
        run_waves(study, "RhoA")
    with pytest.raises(ParameterError, match="layer 5 is not in the study: it has 0:1"):
        run_waves(study, "Rac1", layer=5)
    with pytest.raises(ParameterError, match="layer 1 is given, but velocity is that of the edge alone"):
        run_waves(study, layer=1)
    with pytest.raises(ParameterError, match="frames 5:48 are not in the movie: it has 0:47"):
        run_waves(study, frames=(5, 48))
    for cell in study.given.values():
        cell["channel"] = ["velocity"]
    with pytest.raises(ParameterError, match="a channel called 'velocity'"):
        run_waves(study)
    with pytest.raises(ParameterError, match="has no cell 4"):
        run_waves(study, cells=[4])
    study.provenance["run"] = "map"
    with pytest.raises(StudyError, match="not that of a movie"):
        run_waves(study)
