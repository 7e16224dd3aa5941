"""Windows with springs, and those of the first frame carried by a registration, in a comparison."""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile

import cytodisk as cd
from cytodisk.errors import MissingPartError, ParameterError
from cytodisk.runs.compare_windows.laid_frames import registered_frames, spring_frames

METHODS = ("newton", "springs", "registered")
SPRINGS = {"evenness": 1.0, "line_tension": 20.0}  # not the defaults


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    shown = cd.simulate.movie("translating", 2, frames=4, radius_px=14.0)
    assert shown.signal is not None
    folder = tmp_path_factory.mktemp("movie")
    options: Any = {"photometric": "minisblack"}
    tifffile.imwrite(folder / "masks.tif", shown.masks.astype("uint8"), metadata={"axes": "TYX"}, **options)
    names = {"axes": "TCYX", "Channel": {"Name": ["material", "edge"]}}
    tifffile.imwrite(folder / "signal.ome.tif", shown.signal.to_numpy(), metadata=names, **options)
    return folder / "masks.tif", folder / "signal.ome.tif"


@pytest.fixture(scope="module")
def comparison(files: tuple[Path, Path], tmp_path_factory: pytest.TempPathFactory) -> cd.Comparison:
    pytest.importorskip("SimpleITK")
    masks, signal = files
    settings: Any = {"methods": METHODS, "layers": 3, "sectors": 12, **SPRINGS}
    out = tmp_path_factory.mktemp("compared") / "out"
    return cd.run_compare_windows(masks, out, signal=signal, movie=True, **settings)


def test_rows_say_what_springs_and_a_registration_did(comparison: cd.Comparison) -> None:
    cells = comparison.cells.set_index("method")
    assert (cells["status"] == "ok").all()
    assert (cells["mapped"] == 4).all()
    assert cells["depth_px"].notna().tolist() == [False, True, False]
    for name in ("folded", "carried_outside"):
        assert cells[name].notna().tolist() == [False, False, True]
        assert 0.0 <= cells.loc["registered", name] < 0.1
    assert cells.loc["registered", "coverage"] > 0.95
    assert cells.loc["registered", "certificate_valid"] is None
    by_method = comparison.by_method.set_index("method")
    assert by_method.loc["registered", "folded"] == cells.loc["registered", "folded"]


def test_activity_is_that_of_the_windows(comparison: cd.Comparison, files: tuple[Path, Path]) -> None:
    masks, signal = (cd.read_image(path, unnamed="T") for path in files)
    movie = cd.map_movie(masks)
    depth = float(comparison.cells.set_index("method").loc["springs", "depth_px"])
    laid = {
        "springs": spring_frames(
            movie, cd.SpringGrid(3, 12, depth, SPRINGS["evenness"]), line_tension=SPRINGS["line_tension"]
        ),
        "registered": registered_frames(movie, cd.polar_windows(3, 12)),
    }
    for method, frames in laid.items():
        *_, last = frames
        expected = cd.sample(last.windows, signal.isel(time=3))["mean"].transpose(
            "channel", "layer", "sector"
        )
        np.testing.assert_allclose(comparison.activity(0, method).isel(time=3), expected, rtol=1e-9)


def test_springs_of_cells_are_as_strong_as_asked_for(tmp_path: Path) -> None:
    mask = cd.simulate.dumbbell(12, neck_width=4)
    tifffile.imwrite(tmp_path / "mask.tif", mask.astype("uint8"))
    settings: Any = {"methods": ("springs",), "layers": 3, "sectors": 12, "evenness": 0.0}
    found = cd.run_compare_windows(tmp_path / "mask.tif", tmp_path / "out", **settings)
    for evenness, same in ((0.0, True), (4.0, False)):
        windows = cd.spring_windows(mask, 3, 12, evenness=evenness)
        expected = cd.measures_by_layer(windows)["area_cv"].to_numpy()
        assert np.allclose(found.layers["area_cv"], expected, rtol=0.02) is same


def test_a_cell_that_only_moves_keeps_its_windows(files: tuple[Path, Path]) -> None:
    """The material of each window stays in it: both follow the cell."""
    movie = cd.map_movie(cd.read_image(files[0], unnamed="T"))
    grid = cd.polar_windows(3, 12)
    frames = [*registered_frames(movie, grid)]
    first, last = (
        movie.transforms[frame.frame](frame.windows.centroids_yx) for frame in (frames[0], frames[-1])
    )
    assert np.abs(first - last).max() < 1.0
    np.testing.assert_allclose(frames[0].windows.areas, grid.on(movie[0]).areas, rtol=0.05)
    springs = [*spring_frames(movie, cd.SpringGrid(3, 12, 4.0))]
    first, last = (
        movie.transforms[frame.frame](frame.windows.centroids_yx) for frame in (springs[0], springs[-1])
    )
    assert np.abs(first - last)[:2].max() < 1.5  # a few pixels of the middle are in the third layer


def test_registered_windows_need_a_movie(tmp_path: Path) -> None:
    tifffile.imwrite(tmp_path / "mask.tif", cd.simulate.disk(9).astype("uint8"))
    with pytest.raises(ParameterError, match=r"registered.*movies only.*--movie"):
        cd.run_compare_windows(tmp_path / "mask.tif", tmp_path / "out", methods=("newton", "registered"))
    found = cd.run_compare_windows(
        tmp_path / "mask.tif", tmp_path / "out", methods=("newton", "springs"), layers=2, sectors=6
    )
    assert found.by_method["empty_windows"].tolist() == [0, 0]


def test_registered_windows_need_simple_itk(
    files: tuple[Path, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "SimpleITK", None)
    with pytest.raises(MissingPartError, match=r'method "registered" needs SimpleITK.*cytodisk\[demons\]'):
        cd.run_compare_windows(files[0], tmp_path / "out", movie=True, methods=("registered",))
    assert not (tmp_path / "out").exists()
