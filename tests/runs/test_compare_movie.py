import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest
import tifffile

import cytodisk as cd
from cytodisk.errors import MapError, ParameterError, SignalError
from cytodisk.runs.compare_windows import compare_movie as module
from cytodisk.runs.parameters_file import parameters_from

METHODS = ("newton", "harmonic", "edge")
GRID = cd.CompareMovieParameters(methods=METHODS, layers=4, sectors=12, depth_px=5.0)


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A cell that moves on; the third of five frames is empty."""
    shown = cd.simulate.movie("translating", 2, frames=5, radius_px=14.0)
    assert shown.signal is not None
    folder = tmp_path_factory.mktemp("movie")
    masks = shown.masks.astype(np.uint8)
    masks[2] = 0
    options: Any = {"photometric": "minisblack"}
    tifffile.imwrite(folder / "masks.tif", masks, metadata={"axes": "TYX"}, **options)
    names = {"axes": "TCYX", "Channel": {"Name": ["material", "edge"]}}
    tifffile.imwrite(folder / "signal.ome.tif", shown.signal.to_numpy(), metadata=names, **options)
    return folder / "masks.tif", folder / "signal.ome.tif"


@pytest.fixture(scope="module")
def comparison(files: tuple[Path, Path], tmp_path_factory: pytest.TempPathFactory) -> cd.Comparison:
    masks, signal = files
    return cd.run_compare_windows(
        masks, tmp_path_factory.mktemp("comparison") / "out", parameters=GRID, signal=signal
    )


def test_measures_are_those_of_the_movie(comparison: cd.Comparison, files: tuple[Path, Path]) -> None:
    masks, signal = (cd.read_image(path, unnamed="T") for path in files)
    movie = cd.map_movie(masks)
    for method, grid in (("newton", cd.polar_windows(4, 12)), ("edge", cd.EdgeGrid(4, 12, 5.0))):
        activity = cd.sample_movie(movie, grid, signal)
        np.testing.assert_allclose(comparison.activity(0, method), activity["mean"], rtol=1e-9)
        rows = comparison.consistency
        rows = rows[(rows["method"] == method) & (rows["channel"] == "edge")]
        wide = rows.pivot_table(index="frame", columns="layer", values="correlation", dropna=False)
        expected = cd.consecutive_correlation(activity["mean"].sel(channel="edge"))
        np.testing.assert_allclose(wide.reindex(range(5)), expected, rtol=1e-6)
        moved = rows.pivot_table(index="frame", columns="layer", values="centroid_displacement", dropna=False)
        expected = cd.centroid_displacement(movie, activity).mean("sector")
        np.testing.assert_allclose(moved.reindex(range(5)), expected, rtol=1e-6)
        complete = rows.pivot_table(index="frame", columns="layer", values="completeness")
        held = (activity["area"] > 0).mean("sector").sel(frame=[0, 1, 3, 4])
        np.testing.assert_allclose(complete, held)


def test_medians_over_frames_stand_by_method_channel_and_layer(comparison: cd.Comparison) -> None:
    table = pd.read_csv(comparison.path / "comparison_movie.csv")
    here = comparison.through_time.astype({"layer": float})
    pd.testing.assert_frame_equal(table, here, check_dtype=False, rtol=1e-4)
    assert len(table) == 3 * 2 * (4 + 1)
    rows = comparison.consistency
    rows = rows[(rows["method"] == "edge") & (rows["channel"] == "material")]
    found = table[(table["method"] == "edge") & (table["channel"] == "material")].set_index("layer")
    assert found.loc[0.0, "frames"] == 2  # 0 to 1 and 3 to 4
    for name in ("correlation", "centroid_displacement"):
        first = rows.loc[rows["layer"] == 0, name]
        assert found.loc[0.0, name] == pytest.approx(first.median(), rel=1e-4)
        assert found.loc[0.0, f"{name}_q75"] == pytest.approx(first.quantile(0.75), rel=1e-4)
        in_all = found.loc[found.index.isna(), name].item()
        assert in_all == pytest.approx(rows.groupby("frame")[name].mean().median(), rel=1e-4)
    assert comparison.through_time.attrs["units"]["centroid_displacement"] == "px"
    told = pd.read_csv(comparison.path / "comparison_columns.csv")
    assert list(told.loc[told["table"] == "comparison_movie.csv", "name"]) == list(table.columns)
    assert comparison.by_method["area_error_q25"].isna().all()


def test_a_comparison_of_an_earlier_version_opens(comparison: cd.Comparison, tmp_path: Path) -> None:
    earlier = tmp_path / "earlier"
    shutil.copytree(comparison.path, earlier)
    table = pq.read_table(earlier / "cells.parquet").drop_columns(["folded", "carried_outside"])
    pq.write_table(table, earlier / "cells.parquet")
    found = cd.open_comparison(earlier)
    assert not {"folded", "carried_outside"} & set(found.cells)
    pd.testing.assert_frame_equal(found.by_method, comparison.by_method)
    pd.testing.assert_frame_equal(found.through_time, comparison.through_time)


def test_a_row_sums_up_the_frames(comparison: cd.Comparison) -> None:
    assert list(comparison.cells["method"]) == list(METHODS)
    assert (comparison.cells["status"] == "partly").all()
    assert comparison.cells["reason"].str.contains("frame 2: mask .* is empty").all()
    assert (comparison.cells["mapped"] == 4).all()
    assert (comparison.cells["frames"] == 4).all()  # an empty mask is no cell that could be mapped
    newton, _, edge = comparison.cells.to_dict("records")
    assert (newton["certificate_valid"], newton["invalid_maps"], newton["empty_windows"]) == (True, 0, 0)
    assert edge["certificate_valid"] is None
    layers = comparison.layers[comparison.layers["method"] == "edge"]
    assert edge["empty_windows"] == pytest.approx(12 * (1 - layers["completeness"]).sum())
    assert edge["depth_px"] == 5.0
    assert set(comparison.layers["frame"]) == {0, 1, 3, 4}


def test_edge_windows_are_as_deep_as_the_first_frame(files: tuple[Path, Path], tmp_path: Path) -> None:
    grid = GRID.model_copy(update={"depth_px": None, "methods": ("edge", "rings")})
    found = cd.run_compare_windows(files[0], tmp_path / "out", parameters=grid)
    depth = cd.edge_windows(cd.read_image(files[0], unnamed="T")[0], 4, 12).depth_px
    assert found.cells["depth_px"].tolist()[0] == pytest.approx(depth)
    assert found.consistency["channel"].isna().all()
    assert found.consistency["correlation"].isna().all()
    assert found.consistency["centroid_displacement"].notna().any()


def test_a_stopped_run_goes_on_with_the_next_method(
    comparison: cd.Comparison, files: tuple[Path, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as patched:

        def stop(masks: Any, **options: Any) -> cd.DiskMovie:
            if options["method"] == "harmonic":
                raise KeyboardInterrupt
            return cd.map_movie(masks, **options)

        patched.setattr(module, "map_movie", stop)
        with pytest.raises(KeyboardInterrupt):
            cd.run_compare_windows(files[0], tmp_path / "out", parameters=GRID, signal=files[1])
    assert not list((tmp_path / "out").glob(".*.maps"))
    mapped: list[str] = []

    def note(masks: Any, **options: Any) -> cd.DiskMovie:
        mapped.append(options["method"])
        return cd.map_movie(masks, **options)

    monkeypatch.setattr(module, "map_movie", note)
    done: list[tuple[int, int]] = []
    resumed = cd.run_compare_windows(
        files[0],
        tmp_path / "out",
        parameters=GRID,
        signal=files[1],
        resume=True,
        progress=lambda *counts: done.append(counts),
    )
    assert mapped == ["harmonic", "harmonic"]  # the second is for the edge alone
    assert done[0] == (5, 15)
    assert done[-1] == (15, 15)
    assert [here for here, _ in done] == sorted(here for here, _ in done)
    pd.testing.assert_frame_equal(resumed.consistency, comparison.consistency)
    pd.testing.assert_frame_equal(resumed.layers, comparison.layers)


@pytest.mark.slow
def test_results_do_not_depend_on_workers(
    comparison: cd.Comparison, files: tuple[Path, Path], tmp_path: Path
) -> None:
    done: list[int] = []
    found = cd.run_compare_windows(
        files[0],
        tmp_path / "out",
        parameters=GRID,
        signal=files[1],
        workers=2,
        progress=lambda frames, _: done.append(frames),
    )
    assert done == [0, 5, 10, 15]
    pd.testing.assert_frame_equal(found.consistency, comparison.consistency)
    pd.testing.assert_frame_equal(found.layers, comparison.layers)


def test_a_movie_that_a_method_cannot_map_has_a_row_with_the_reason(
    files: tuple[Path, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(masks: Any, **options: Any) -> cd.DiskMovie:
        if options["method"] == "newton":
            raise MapError("no valid map was found: for the test")
        return cd.map_movie(masks, **options)

    monkeypatch.setattr(module, "map_movie", fail)
    found = cd.run_compare_windows(files[0], tmp_path / "out", parameters=GRID)
    assert found.cells["status"].tolist() == ["no map", "partly", "partly"]
    assert found.cells["reason"].iloc[0] == "no valid map was found: for the test"
    newton = found.by_method.set_index("method").loc["newton"]
    assert (newton["tried"], newton["mapped"], newton["completeness"]) == (4, 0, 0.0)


def test_inputs_that_do_not_fit_are_refused(files: tuple[Path, Path], tmp_path: Path) -> None:
    short, image = tmp_path / "short.tif", np.zeros((2, 20, 20), dtype=np.uint8)
    tifffile.imwrite(short, image, photometric="minisblack", metadata={"axes": "TYX"})
    with pytest.raises(SignalError, match="2 frames"):
        cd.run_compare_windows(files[0], tmp_path / "out", parameters=GRID, signal=short)
    with pytest.raises(ParameterError, match="did you mean methods"):
        parameters_from({"method": "harmonic"}, None, cd.CompareMovieParameters)
    with pytest.raises(ParameterError, match="depth_px and depth_um exclude each other"):
        parameters_from({"depth_px": 1.0, "depth_um": 1.0}, None, cd.CompareMovieParameters)
