"""Runs over masks with holes: what becomes of these is the same for Python and every command."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import tifffile
from numpy.testing import assert_allclose

import cytodisk as cd
from cytodisk.errors import MaskError

BRIGHT = 60_000.0  # in the hole


def ring(shift: int = 0, hole: int = 12) -> np.ndarray:
    """A disk of radius 25 with a square hole around its middle, moved to the right."""
    mask = cd.simulate.disk(25, margin=8)
    middle = mask.shape[0] // 2
    mask[middle - hole // 2 : middle + hole // 2, middle - hole // 2 : middle + hole // 2] = hole == 0
    return np.roll(mask, shift, axis=1)


def write(path: Path, values: np.ndarray, axes: str) -> Path:
    tifffile.imwrite(path, values, photometric="minisblack", metadata={"axes": axes})
    return path


@pytest.fixture
def files(tmp_path: Path) -> tuple[Path, Path]:
    mask = ring()
    signal = np.where(mask, np.random.default_rng(0).normal(500.0, 50.0, mask.shape), BRIGHT)
    masks = write(tmp_path / "mask.tif", mask.astype(np.uint8), "YX")
    return masks, write(tmp_path / "signal.tif", signal.astype(np.float32), "YX")


@pytest.fixture
def movie_files(tmp_path: Path) -> tuple[Path, Path]:
    """Six frames; the hole closes in frame 3 alone."""
    masks = np.stack([ring(shift, 0 if shift == 3 else 12) for shift in range(6)])
    signal = np.where(masks, 500.0, BRIGHT).astype(np.float32)
    found = write(tmp_path / "masks.tif", masks.astype(np.uint8), "TYX")
    return found, write(tmp_path / "movie.tif", signal, "TYX")


def total(windows: pd.DataFrame) -> float:
    return float((windows["n_pixels"] * windows["mean"]).sum())


def test_windows_of_a_map_hold_the_mask_without_its_hole(files: tuple[Path, Path], tmp_path: Path) -> None:
    mask, signal = ring(), tifffile.imread(files[1]).astype(np.float64)
    study = cd.run_map(files[0], tmp_path / "out", signal=files[1], layers=24, sectors=24, holes="exclude")
    (row,) = study.cells.to_dict("records")
    assert (row["holes"], row["filled_px"], row["excluded_px"]) == (1, 0, 144)
    assert row["area_px"] == mask.sum()
    assert row["notes"] == "1 hole excluded (144 px, 7.3%)"
    assert_allclose(study.windows["area"].sum(), mask.sum(), rtol=1e-9)
    assert_allclose(total(study.windows), signal[mask].sum(), rtol=1e-9)
    assert study.map(0).holes is not None
    assert study.map(0).holes.box.sum() == 144
    gone = study.windows[study.windows["status"] == "in a hole"]
    assert len(gone) == row["empty_windows"] > 0
    assert set(gone["layer"]) <= {22, 23}
    assert (gone["area"] == 0.0).all()
    assert gone[["mean", "depth", "centroid_y", "eccentricity"]].isna().all(axis=None)
    assert study.windows.loc[~study.windows.index.isin(gone.index), "status"].eq("ok").all()
    assert row["smallest_window_px"] > 0.0
    assert np.isfinite(row["window_area_error"])


def test_pixels_in_a_hole_raise_no_flag_and_are_no_nan(tmp_path: Path) -> None:
    mask = ring()
    masks = write(tmp_path / "mask.tif", mask.astype(np.uint8), "YX")
    for name, value in (("nan", np.nan), ("zero", 0.0)):
        values = np.where(mask, np.random.default_rng(0).normal(500.0, 50.0, mask.shape), value)
        image = write(tmp_path / f"{name}.tif", values.astype(np.float32), "YX")
        filled = cd.run_map(masks, tmp_path / f"filled_{name}", signal=image, layers=3, sectors=8).cells.iloc[
            0
        ]
        study = cd.run_map(masks, tmp_path / name, signal=image, layers=3, sectors=8, holes="exclude")
        row = study.cells.iloc[0]
        assert (row["nan_px"], row["clipped_share"]) == (0, 0.0)
        assert filled["nan_px"] == 144 if name == "nan" else filled["clipped_share"] > 0.05
        assert study.windows["mean"].notna().all()
        assert cd.qc_flags(study) == []


def test_a_large_hole_is_flagged(tmp_path: Path) -> None:
    masks = write(tmp_path / "mask.tif", ring(hole=18).astype(np.uint8), "YX")
    study = cd.run_map(masks, tmp_path / "out", layers=3, sectors=8, holes="exclude")
    (flag,) = [flag for flag in cd.qc_flags(study) if flag.name == "flagged masks"]
    assert "holes take 17% of the area within the outline" in flag.places[0].note


def test_error_refuses_the_cell_and_says_what_to_pass(files: tuple[Path, Path], tmp_path: Path) -> None:
    study = cd.run_map(files[0], tmp_path / "out", signal=files[1], holes="error")
    assert study.cells["status"].tolist() == ["refused"]
    assert "--holes exclude" in study.cells["reason"].iloc[0]
    with pytest.raises(MaskError, match=r"1 hole \(144 px\)"):
        cd.map_to_disk(ring(), holes="error")


def test_parameters_of_a_study_can_be_fed_back(files: tuple[Path, Path], tmp_path: Path) -> None:
    cd.run_map(files[0], tmp_path / "out", signal=files[1], layers=3, sectors=8, holes="exclude")
    assert 'holes = "exclude"' in (tmp_path / "out" / "parameters.toml").read_text(encoding="utf-8")


def test_each_frame_of_a_movie_has_its_own_holes(movie_files: tuple[Path, Path], tmp_path: Path) -> None:
    masks, signal = (tifffile.imread(file) for file in movie_files)
    study = cd.run_movie(
        movie_files[0], tmp_path / "out", signal=movie_files[1], layers=8, sectors=24, holes="exclude"
    )
    assert study.cells["excluded_px"].tolist() == [144, 144, 144, 0, 144, 144]
    assert [study.movie(0)[frame].holes is None for frame in range(6)] == [False] * 3 + [True] + [False] * 2
    for frame, windows in study.windows.groupby("frame"):
        assert_allclose(windows["area"].sum(), masks[frame].sum(), rtol=1e-9)
        assert_allclose(total(windows), signal[frame][masks[frame] > 0].sum(), rtol=1e-6)
    assert not any(flag.name == "area jumps" for flag in cd.qc_flags(study))
    velocity = study.edge["velocity"].to_numpy()
    filled = cd.run_movie(movie_files[0], tmp_path / "filled", signal=movie_files[1], layers=8, sectors=24)
    np.testing.assert_array_equal(velocity, filled.edge["velocity"].to_numpy())  # the outline is the same


def test_a_movie_in_memory_does_the_same(movie_files: tuple[Path, Path]) -> None:
    masks, signal = (tifffile.imread(file) for file in movie_files)
    movie = cd.map_movie(masks, holes="exclude")
    activity = cd.sample_movie(movie, cd.polar_windows(8, 24), signal)
    sums = (activity["mean"] * activity["n_pixels"]).sum(("layer", "sector")).squeeze().to_numpy()
    assert_allclose(sums, [signal[frame][masks[frame] > 0].sum() for frame in range(6)], rtol=1e-6)
    inner = activity["mean"].isel(layer=7).squeeze()
    assert inner[3].notnull().all()
    assert (activity["area"][2] < activity["area"][3]).any()
    edge = cd.sample_movie(movie, cd.EdgeGrid(4, 12, 3.0), signal)
    assert float(edge["max"].max()) < BRIGHT


def test_means_over_time_and_depth_know_nothing_of_holes() -> None:
    masks = np.stack([ring(shift % 3) for shift in range(12)])
    noise = np.random.default_rng(2).normal(100.0, 10.0, masks.shape)
    movie, grid = cd.map_movie(masks, holes="exclude"), cd.polar_windows(4, 8)
    found = [
        cd.geometry_controls(movie, grid, np.where(masks, noise, value), 1) for value in (-1e6, 0.0, np.nan)
    ]
    for other in found[1:]:
        for name in ("lab", "depth_profile"):
            assert_allclose(other[name], found[0][name], rtol=1e-9)
    assert float(abs(found[0]["lab"] - 100.0).max()) < 20.0


def test_features_are_those_of_the_outline_but_for_the_area(files: tuple[Path, Path], tmp_path: Path) -> None:
    filled = cd.shape_features([ring()])
    holed = cd.shape_features([ring()], holes="exclude")
    assert holed["area"].iloc[0] == filled["area"].iloc[0] - 144 == ring().sum()
    names = [name for name in filled.attrs["units"] if name != "area"]
    pd.testing.assert_frame_equal(holed[names], filled[names])
    assert holed["notes"].iloc[0].startswith("1 hole excluded")
    table = cd.run_shapes(files[0], tmp_path / "shapes", holes="exclude")
    assert table["area"].iloc[0] == ring().sum()
    refused = cd.shape_features([ring()], holes="error")
    assert refused["status"].tolist() == ["refused"]


def test_comparisons_of_windows_leave_holes_out(files: tuple[Path, Path], tmp_path: Path) -> None:
    methods = ("newton", "advection", "edge", "rings")
    found = cd.run_compare_windows(
        files[0], tmp_path / "out", layers=4, sectors=12, methods=methods, holes="exclude"
    )
    cells = found.cells.set_index("method")
    assert (cells["area_px"] == ring().sum()).all()
    assert_allclose(cells["coverage"], 1.0)
    assert_allclose(cells["lost_px"], 0.0, atol=1e-6)
    with np.load(tmp_path / "out" / "maps" / "windows_00000.npz") as labels:
        per_side = 4  # of a small cell, subpixels
        assert labels["mask"].sum() == ring().sum() * per_side**2
        for method in methods:
            assert ((labels[method] >= 0) == labels["mask"]).all()
