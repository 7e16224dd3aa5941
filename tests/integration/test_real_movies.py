"""Recorded movies, shortened: every frame is mapped one to one or has its reason, and no window is empty."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import tifffile

import cytodisk as cd
from cytodisk.runs.correlate.correlate_study import correlate_study
from cytodisk.runs.movie.movie_inputs import open_movie
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.movie.movie_study import movie_study

GRID = MovieParameters(layers=8, sectors=36)
STATISTICS = ("mean", "sd", "min", "max", "n_pixels", "n_nan")
GEOMETRY = ("area", "centroid_y", "centroid_x", "depth", "depth_p5", "depth_p95")


def shortened(source: Path, target: Path, frames: int, axes: str = "TYX") -> Path:
    """The first frames of a movie, as a file of their own."""
    if not source.is_file():
        pytest.skip(f"real data is absent: {source} is not in the folder")
    pages = frames * (2 if axes == "TCYX" else 1)
    values = tifffile.imread(source, key=range(pages))
    if axes == "TCYX":
        values = values.reshape(frames, 2, *values.shape[-2:])
    metadata = {"axes": axes}
    tifffile.imwrite(target, values, metadata=metadata, ome=axes == "TCYX", photometric="minisblack")
    return target


def assert_each_frame_is_mapped_or_has_a_reason(cells: pd.DataFrame) -> pd.DataFrame:
    mapped = cells["status"] == "ok"
    assert mapped.any()
    assert (cells.loc[~mapped, "reason"] != "").all()
    assert (cells.loc[mapped, "reason"] == "").all()
    assert cells.loc[mapped, "certificate_valid"].all()
    assert (cells.loc[mapped, ["flipped", "empty_windows", "order_violations"]] == 0).all(axis=None)
    return cells[mapped]


def assert_whole(study: cd.Study) -> None:
    """What must hold for any movie."""
    mapped = assert_each_frame_is_mapped_or_has_a_reason(study.cells)
    for row in mapped.itertuples():
        assert study.map(row.cell, row.frame).certificate.valid
    windows = study.windows
    assert (windows["area"] > 0).all()
    n_channels = windows["channel"].nunique() or 1
    assert len(windows) == len(mapped) * n_channels * GRID.layers * GRID.sectors
    areas = windows.groupby(["cell", "frame"])["area"].sum() / n_channels
    known = mapped.set_index(["cell", "frame"])["area"]
    pd.testing.assert_series_equal(areas, known, check_names=False, rtol=1e-9)
    edge = study.edge
    fine = edge["status"] == "ok"
    for name in ("velocity", "velocity_cell_frame", "velocity_error"):
        assert edge.loc[fine, name].notna().all()
        assert edge.loc[~fine, name].isna().all()
    for cell in study.cells["cell"].unique():
        activity = study.activity(int(cell)).load()
        ok = activity["status"] == "ok"
        for name in (*STATISTICS, *GEOMETRY):
            if name in activity:
                assert bool(activity[name].where(ok, drop=True).notnull().all()), name
                assert bool(activity[name].where(~ok, drop=True).isnull().all()), name


def test_melanoma(data_dir: Path, tmp_path: Path) -> None:
    folder = data_dir / "melanoma_vasp_lpd"
    masks = shortened(folder / "mask.tif", tmp_path / "masks.tif", 6)
    signal = shortened(folder / "signal.ome.tif", tmp_path / "signal.ome.tif", 6, "TCYX")
    study = movie_study(open_movie(masks, signal, GRID), tmp_path / "out")
    assert study.cells["status"].tolist() == ["ok"] * 6
    assert_whole(study)
    assert study.consistency.loc[study.consistency["frame"] < 5, "correlation"].median() > 0.8


def test_dictyostelium(data_dir: Path, tmp_path: Path) -> None:
    folder = data_dir / "dictyostelium_rac1"
    masks = shortened(folder / "mask.tif", tmp_path / "masks.tif", 15)
    signal = shortened(folder / "rac1.tif", tmp_path / "rac1.tif", 15)
    given = GRID.model_copy(update={"frame_interval_s": 1.29})
    study = movie_study(open_movie(masks, signal, given), tmp_path / "out")
    assert study.cells["status"].tolist() == ["ok"] * 15
    assert_whole(study)
    assert study.edge.attrs["units"]["velocity"] == "px/s"
    values = tifffile.imread(signal)
    windows = study.windows
    sums = (windows["mean"] * windows["n_pixels"]).groupby(windows["frame"]).sum()
    for time in range(15):
        inside = study.map(0, time).mask
        assert sums[time] == pytest.approx(values[time][inside].sum(dtype=float), rel=1e-10)


@pytest.mark.slow
def test_masks_that_jitter_are_flagged(data_dir: Path, tmp_path: Path) -> None:
    folder = data_dir / "dictyostelium_rac1"
    masks = shortened(folder / "mask.tif", tmp_path / "masks.tif", 60)
    signal = shortened(folder / "rac1.tif", tmp_path / "rac1.tif", 60)
    given = GRID.model_copy(update={"layers": 4, "sectors": 36})
    study = movie_study(open_movie(masks, signal, given), tmp_path / "out")
    settings: dict[str, Any] = {"max_lag": 10, "surrogates": 0, "geometry": False}
    found = correlate_study(study, "rac1", **settings)
    assert found.cells["velocity_jitter"].item() > 0.1
    assert abs(found.cells["jitter"].item()) > 0.02
    (flag,) = [flag for flag in cd.qc_flags(study) if flag.name == "jitter"]
    assert "--skip-lags=-1,0" in flag.advice
    without = correlate_study(study, "rac1", skip_lags=(-1, 0), **settings)
    assert without.cells["jitter"].item() == 0.0


@pytest.mark.parametrize(
    "name", ["PhC-C2DH-U373_01_ST_cell02_t043-102.tif", "DIC-C2DH-HeLa_01_ST_cell01_t000-029.tif"]
)
def test_tracked_cells(data_dir: Path, tmp_path: Path, name: str) -> None:
    masks = shortened(data_dir / "tracked_cells" / name, tmp_path / "masks.tif", 10)
    study = movie_study(open_movie(masks, None, GRID), tmp_path / "out")
    assert len(study.cells) == 10
    assert_whole(study)


def test_a_field_of_labels(data_dir: Path, tmp_path: Path) -> None:
    source = data_dir / "label_movies" / "PhC-C2DH-U373_01_ST_SEG_labels.tif"
    labels = shortened(source, tmp_path / "labels.tif", 6)
    study = movie_study(open_movie(labels, None, GRID), tmp_path / "out")
    values = tifffile.imread(labels)
    tracks = sorted(set(np.unique(values)) - {0})
    assert len(tracks) > 1
    for cell, label in enumerate(tracks):
        rows = study.cells[study.cells["cell"] == cell]
        present = np.flatnonzero((values == label).any(axis=(1, 2)))
        assert set(rows["label"]) == {label}
        assert rows["frame"].tolist() == list(range(present[0], present[-1] + 1))
    assert_whole(study)
