"""The commands that flags print run as they stand, and replace nothing."""

import shlex
from pathlib import Path

import pytest
import tifffile
from command_line import Run

import cytodisk as cd
from cytodisk.runs.qc_flags.qc_flag import Place
from cytodisk.runs.qc_flags.remedy import without_frames
from cytodisk.store.tables import write_table

FEW = {"max_lag": 3, "surrogates": 19, "geometry": False, "clusters": False}


@pytest.fixture
def study(tmp_path: Path) -> cd.Study:
    truth = cd.simulate.movie("fluctuating", 1000, frames=24, radius_px=14)
    assert truth.signal is not None
    signal = truth.signal.to_numpy()[:, :1]
    tifffile.imwrite(tmp_path / "masks.tif", truth.masks.astype("uint8"), metadata={"axes": "TYX"})
    tifffile.imwrite(tmp_path / "my signal.ome.tif", signal, metadata={"axes": "TCYX"})
    inputs = tmp_path / "masks.tif", tmp_path / "out"
    return cd.run_movie(
        *inputs, signal=tmp_path / "my signal.ome.tif", layers=6, sectors=20, channels=("a b",)
    )


def test_commands_of_flags_run_as_they_are_printed(run: Run, study: cd.Study) -> None:
    found = cd.run_correlate(study, "a b", name="linear", detrend="linear", **FEW)
    marks = {"stress": "common pulse", "pulse_frames": "3,4,5", "pulse_share": 0.6}
    cells = found.cells.assign(jitter=-0.2, drifting_signal=0.9, **marks)
    write_table(cells, found.path / "cells.parquet")
    flags = {flag.name: flag for flag in cd.qc_flags(cd.open_study(study.path))}
    for name in ("jitter", "common pulse", "drifting series", "small windows"):
        words = shlex.split(flags[name].advice.partition(": cytodisk ")[2])
        code, _, error = run(*words, "--figures", 0)
        assert code == 0, (name, error)
    variants = {names[2]: study.correlation(*names).settings for names in study.correlations}
    assert set(variants) == {"linear", "linear_without_jitter", "linear_without_pulse", "linear_steps"}
    assert variants["linear_without_jitter"]["skip_lags"] == [-1, 0]
    assert variants["linear_without_pulse"]["without_frames"] == [3, 4, 5]
    assert [one["detrend"] for one in variants.values()] == ["linear"] * 4
    assert {one["surrogates"] for one in variants.values()} == {19}
    (again,) = set(study.path.parent.glob("out_*"))
    assert "small windows" not in {flag.name for flag in cd.qc_flags(cd.open_study(again))}


@pytest.mark.slow
def test_flags_of_other_correlations_are_not_mixed_in(run: Run, study: cd.Study) -> None:
    found = cd.run_correlate(study, "a b", name="odd", **FEW)
    write_table(found.cells.assign(jitter=-0.2), found.path / "cells.parquet")
    few = ("--max-lag", 3, "--surrogates", 0, "--no-geometry", "--figures", 0, "--name", "other")
    code, said, error = run("correlate", study.path, *few)
    assert code == 0, error
    assert "(odd)" not in said
    assert f"flags of other results: cytodisk report {study.path}" in said


@pytest.mark.slow
def test_a_movie_without_a_signal_is_not_told_to_correlate(study: cd.Study, tmp_path: Path) -> None:
    bare = cd.run_movie(tmp_path / "masks.tif", tmp_path / "bare", layers=2, sectors=8)
    places = [Place(cell=0, frame=7, note="")]
    assert "--without-frames 7" in without_frames(study, places)
    assert without_frames(bare, places) == ""
