from pathlib import Path

import numpy as np
import pytest
import tifffile

import cytodisk as cd
from cytodisk.runs.qc_flags.finest_grid import finest_grid, finest_grid_with_nucleus
from cytodisk.runs.qc_flags.qc_flag import QCFlag
from cytodisk.runs.qc_flags.window_flags import nucleus_words, percent
from cytodisk.windows.window_sizes import between_pixels, window_sizes


def flags_of(masks: np.ndarray, folder: Path, movie: bool = True, **settings: object) -> dict[str, QCFlag]:
    tifffile.imwrite(
        folder / "masks.tif",
        masks.astype("uint8"),
        metadata={"axes": "TYX" if movie else "YX"},
        photometric="minisblack",
    )
    run = cd.run_movie if movie else cd.run_map
    study = run(folder / "masks.tif", folder / "out", **settings)
    return {flag.name: flag for flag in cd.qc_flags(study)}


def disks(radius: float, frames: int = 3) -> np.ndarray:
    return np.stack([np.pad(cd.simulate.disk(radius), 3)] * frames)


def grid_in(words: str) -> dict[str, int]:
    """Numbers behind the flags in an advice."""
    parts = words.split("parameters.toml ")[1].split(" -o ")[0].split()
    return {name.removeprefix("--"): int(value) for name, value in zip(parts[::2], parts[1::2], strict=True)}


@pytest.mark.parametrize("movie", [True, False])
def test_small_windows_are_flagged_with_a_grid_that_is_not(tmp_path: Path, movie: bool) -> None:
    masks = disks(20.0) if movie else disks(20.0)[0]
    flag = flags_of(masks, tmp_path, movie, layers=10, sectors=30)["small windows"]
    assert f"in {3 if movie else 1} {'frames' if movie else 'cell'}" in flag.what
    assert "median down to 4.2 px" in flag.what
    assert f": cytodisk {'movie' if movie else 'map'} " in flag.advice
    wanted = grid_in(flag.advice)
    assert 1257 / 13 < wanted["layers"] * wanted["sectors"] < 1257 / 10
    (tmp_path / "again").mkdir()
    assert "small windows" not in flags_of(masks, tmp_path / "again", movie, **wanted)


@pytest.mark.parametrize(
    ("share", "words"),
    [(0.0, "0%"), (1e-5, "less than 0.1%"), (0.125, "12.5%"), (0.9999, "more than 99.9%"), (1.0, "100%")],
)
def test_only_all_windows_are_100_percent(share: float, words: str) -> None:
    assert percent(share) == words


def test_windows_of_ten_pixels_are_not_flagged(tmp_path: Path) -> None:
    assert "small windows" not in flags_of(disks(20.0), tmp_path, layers=4, sectors=30)


def test_layers_by_depth_keep_their_number_in_the_advice(tmp_path: Path) -> None:
    settings = {"depth_um": (1.0, 3.0), "pixel_size_um": 1.0}
    flag = flags_of(disks(20.0), tmp_path, sectors=90, **settings)["small windows"]
    (tmp_path / "again").mkdir()
    wanted = grid_in(flag.advice)
    assert list(wanted) == ["sectors"]
    assert "small windows" not in flags_of(disks(20.0), tmp_path / "again", **wanted, **settings)


def test_a_border_by_depth_that_nearly_reaches_the_centre_is_named(tmp_path: Path) -> None:
    settings = {"pixel_size_um": 1.0, "sectors": 8}
    flag = flags_of(disks(8.0), tmp_path, depth_um=(2.0, 7.0), **settings)["small windows"]
    assert flag.advice.startswith("Leave out 7 of --depth-um")
    (tmp_path / "again").mkdir()
    assert "small windows" not in flags_of(disks(8.0), tmp_path / "again", depth_um=(2.0,), **settings)


def test_a_window_below_a_pixel_is_flagged_where_the_median_is_large(tmp_path: Path) -> None:
    masks = np.pad(disks(30.0, 2), ((0, 0), (0, 0), (0, 60)))
    masks[:, masks.shape[1] // 2, 33:120] = True  # an arm a pixel wide
    flag = flags_of(masks, tmp_path, layers=8, sectors=30)["small windows"]
    cells = cd.open_study(tmp_path / "out").cells
    assert (cells["median_window_px"] > 10).all()
    assert (cells["smallest_window_px"] < 1).all()
    assert len(flag.places) == 2


def test_sizes_are_those_of_the_windows() -> None:
    windows = cd.polar_windows(6, 40).on(cd.map_to_disk(np.pad(cd.simulate.migrating(seed=3, size=0.3), 2)))
    found = window_sizes(windows)
    areas = windows.areas
    assert found["median_window_px"] == pytest.approx(np.median(areas))
    assert found["smallest_window_px"] == pytest.approx(areas.min())
    assert found["windows_below_10px"] == pytest.approx((areas < 10).mean())
    assert found["window_area_error"] == pytest.approx(np.abs(np.log(areas / areas.mean())).mean())
    assert found["windows_below_1px"] == pytest.approx((areas < 1).mean())


@pytest.mark.parametrize(("layers", "sectors"), [(4, 12), (30, 80)])
def test_windows_between_pixels_hold_the_centre_of_none(layers: int, sectors: int) -> None:
    windows = cd.polar_windows(layers, sectors).on(cd.map_to_disk(np.pad(cd.simulate.disk(12), 2)))
    centres = np.argwhere(windows.mask).astype(float)
    held = windows.grid.window_of(windows.disk.to_disk(centres, outside="nearest"))
    expected = np.setdiff1d(np.arange(layers * sectors), held)
    np.testing.assert_array_equal(between_pixels(windows), expected)
    assert bool(expected.size) == (layers == 30)


def test_the_finest_grid_of_even_windows() -> None:
    even = [np.full((6, 40), 5.0)]  # 1200 px
    layers, sectors = finest_grid(even, 10.0, 1.0) or (0, 0)
    assert 0.8 * 1200 / 11 <= layers * sectors <= 1200 / 11
    assert finest_grid([np.full((2, 2), 1.0)], 10.0, 1.0) is None


@pytest.mark.parametrize("radius", [8, 16])
def test_a_coarser_grid_suits_cytoplasm_and_nucleus(radius: int) -> None:
    mask = np.pad(cd.simulate.disk(40), 2)
    inner = cd.simulate.disk(radius)
    nucleus = np.pad(inner, (mask.shape[0] - inner.shape[0]) // 2)
    disk = cd.map_to_disk(mask, nucleus=nucleus)
    areas = cd.polar_windows(20, 60, nucleus_layers=5).on(disk).areas
    found = finest_grid_with_nucleus([areas, areas], 5, 10.0, 1.0)
    assert found is not None
    layers, sectors, nucleus_layers = found
    assert sectors < 60
    assert 1 <= nucleus_layers <= 5
    windows = cd.polar_windows(layers, sectors, nucleus_layers=nucleus_layers).on(disk)
    assert np.median(windows.areas[:layers]) >= 10
    assert np.median(windows.areas[layers:]) >= 10
    assert windows.areas.min() >= 1
    plain = np.where(np.arange(25)[:, None] < 20, areas, np.nan)  # a cell without a nucleus beside it
    assert finest_grid_with_nucleus([areas, plain], 5, 10.0, 1.0) == found


def test_a_nucleus_of_a_few_pixels_takes_no_windows() -> None:
    areas = np.concatenate([np.full((4, 12), 50.0), np.full((2, 12), 0.3)])
    assert finest_grid_with_nucleus([areas], 2, 10.0, 1.0) is None


def test_where_the_nucleus_alone_is_small_the_cytoplasm_keeps_its_sectors() -> None:
    areas = np.concatenate([np.full((8, 60), 15.0), np.full((3, 60), 0.3)])
    layers, sectors, nucleus_layers = finest_grid_with_nucleus([areas], 3, 10.0, 1.0) or (0, 0, 0)
    assert (layers, nucleus_layers) == (8, 1)
    assert 0 < sectors < 10
    assert nucleus_words([areas], 3, sectors, by_depth=False) == (
        "The nucleus is what is small: for the cytoplasm --sectors 60 will do, if you leave windows of the "
        "nucleus out."
    )
    assert "--layers 7 --sectors 56" in nucleus_words([areas * 0.6], 3, 4, by_depth=False)
    assert nucleus_words([areas], 3, 40, by_depth=False) == ""
    assert nucleus_words([areas[:8]], 0, 4, by_depth=False) == ""
