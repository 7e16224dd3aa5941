from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import tifffile
from numpy.testing import assert_array_equal

import cytodisk as cd
from cytodisk.errors import MaskError, ParameterError, ReadError, SignalError, StudyError
from cytodisk.files import temporary_name
from cytodisk.runs.cells.cell_inputs import CellInputs, open_inputs
from cytodisk.runs.map.checked_cells import check_cells
from cytodisk.runs.map.map_parameters import MapParameters
from cytodisk.runs.map.map_study import map_study
from cytodisk.runs.parameters_file import parameters_from
from cytodisk.runs.run_options import MapOptions
from cytodisk.store.study_folder import StudyFolder, part_key
from cytodisk.store.study_room import alone_in

WriteStack = Callable[[int], tuple[Path, Path]]
SMALL = MapParameters(layers=3, sectors=8)


class Stopped(Exception):
    """What stands for a kill."""


def assert_same_study(first: cd.Study, second: cd.Study) -> None:
    """All but the time that each cell took is the same, to the last bit."""
    pd.testing.assert_frame_equal(
        first.cells.drop(columns="seconds"), second.cells.drop(columns="seconds"), check_exact=True
    )
    pd.testing.assert_frame_equal(first.windows, second.windows, check_exact=True)
    tables = [(study.path / "windows.parquet").read_bytes() for study in (first, second)]
    assert tables[0] == tables[1]


def damage(path: Path, page_number: int) -> None:
    """Overwrite the compressed pixels of one page."""
    with tifffile.TiffFile(path) as tiff:
        page = tiff.pages[page_number]
        start, count = page.dataoffsets[0], page.databytecounts[0]
    with path.open("r+b") as file:
        file.seek(start)
        file.write(b"\xff" * count)


def test_a_study_holds_every_cell_window_and_channel(write_stack: WriteStack, tmp_path: Path) -> None:
    masks, signal = write_stack(3)
    study = map_study(open_inputs(masks, signal, SMALL), tmp_path / "out", geojson=True)
    assert study.cells["status"].tolist() == ["ok"] * 3
    assert study.cells["certificate_valid"].all()
    assert len(study.windows) == 3 * 2 * 3 * 8
    assert study.provenance["status"] == "complete"
    for cell in range(3):
        disk = study.map(cell)
        windows = cd.polar_windows(3, 8).on(disk)
        data = cd.sample(windows, tifffile.imread(signal)[cell])
        found = study.windows[(study.windows["cell"] == cell) & (study.windows["channel"] == "RhoA")]
        assert_array_equal(found["mean"], data["mean"][1].to_numpy().ravel())
        assert found["area"].sum() == pytest.approx(study.cells["area"][cell], rel=1e-9)
        assert (study.path / "maps" / f"cell_{cell:05d}.geojson").exists()


def test_the_pixel_size_scales_lengths_and_areas(write_stack: WriteStack, tmp_path: Path) -> None:
    masks, _ = write_stack(1)
    plain = map_study(open_inputs(masks, None, SMALL), tmp_path / "px")
    scaled_parameters = SMALL.model_copy(update={"pixel_size_um": 0.5})
    scaled = map_study(open_inputs(masks, None, scaled_parameters), tmp_path / "um")
    np.testing.assert_allclose(scaled.windows["area"], 0.25 * plain.windows["area"])
    np.testing.assert_allclose(scaled.cells["perimeter"], 0.5 * plain.cells["perimeter"])
    assert plain.windows.attrs["units"]["area"] == "px²"
    assert scaled.windows.attrs["units"]["area"] == "µm²"


def test_without_a_signal_windows_have_area_and_no_mean(write_stack: WriteStack, tmp_path: Path) -> None:
    masks, _ = write_stack(1)
    windows = map_study(open_inputs(masks, None, SMALL), tmp_path / "out").windows
    assert set(windows["status"]) == {"no signal"}
    assert windows["mean"].isna().all()
    assert (windows["area"] > 0).all()


def test_results_do_not_depend_on_workers(write_stack: WriteStack, tmp_path: Path) -> None:
    inputs = open_inputs(*write_stack(6), SMALL)
    one = map_study(inputs, tmp_path / "one", workers=1)
    two = map_study(inputs, tmp_path / "two", workers=2)
    assert_same_study(one, two)


@pytest.mark.parametrize("stop_after", [0, 1, 4])
def test_resume_does_the_rest(write_stack: WriteStack, tmp_path: Path, stop_after: int) -> None:
    inputs = open_inputs(*write_stack(5), SMALL)
    whole = map_study(inputs, tmp_path / "whole")

    def stop(done: int, total: int) -> None:
        if done == stop_after:
            raise Stopped

    with pytest.raises(Stopped):
        map_study(inputs, tmp_path / "out", progress=stop)
    with pytest.raises(ReadError, match="is not complete"):
        cd.open_study(tmp_path / "out")
    calls: list[tuple[int, int]] = []
    resumed = map_study(inputs, tmp_path / "out", resume=True, progress=lambda *call: calls.append(call))
    assert calls == [(done, 5) for done in range(stop_after, 6)]
    assert_same_study(whole, resumed)


def test_a_complete_study_is_returned_at_once(write_stack: WriteStack, tmp_path: Path) -> None:
    inputs = open_inputs(*write_stack(2), SMALL)
    first = map_study(inputs, tmp_path / "out")
    before = {path: path.stat().st_mtime_ns for path in (tmp_path / "out").rglob("*")}
    calls: list[int] = []
    again = map_study(inputs, tmp_path / "out", resume=True, progress=lambda done, total: calls.append(done))
    assert calls == []
    assert {path: path.stat().st_mtime_ns for path in (tmp_path / "out").rglob("*")} == before
    pd.testing.assert_frame_equal(first.cells, again.cells, check_exact=True)


def test_another_run_is_not_resumed(write_stack: WriteStack, tmp_path: Path) -> None:
    masks, signal = write_stack(1)
    first = map_study(open_inputs(masks, signal, SMALL), tmp_path / "out")
    other = open_inputs(masks, signal, SMALL.model_copy(update={"layers": 4}))
    with pytest.raises(StudyError, match=r"holds another run .*layers: 3 then, 4 now"):
        map_study(other, tmp_path / "out", resume=True)
    with pytest.raises(StudyError, match=r"--resume.*--overwrite"):
        map_study(other, tmp_path / "out")
    assert_same_study(first, cd.open_study(tmp_path / "out"))
    assert len(map_study(other, tmp_path / "out", overwrite=True).windows) == 2 * 4 * 8


@pytest.mark.parametrize("which", ["masks", "signal"])
@pytest.mark.parametrize("workers", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_a_damaged_frame_loses_that_frame_alone(
    write_stack: WriteStack, tmp_path: Path, which: str, workers: int
) -> None:
    masks, signal = write_stack(4)
    whole = map_study(open_inputs(masks, signal, SMALL), tmp_path / "whole")
    damage(*((masks, 2) if which == "masks" else (signal, 5)))
    study = map_study(open_inputs(masks, signal, SMALL), tmp_path / "out", workers=workers)
    assert study.cells["status"].tolist() == ["ok", "ok", "unreadable", "ok"]
    assert "frame 2 cannot be read as an image" in study.cells["reason"][2]
    assert len(study.provenance["warnings"]) == 1
    others = whole.windows[whole.windows["cell"] != 2].reset_index(drop=True)
    pd.testing.assert_frame_equal(study.windows, others, check_exact=True)


def test_cells_that_cannot_be_mapped_have_a_reason(tmp_path: Path) -> None:
    masks = np.zeros((3, 20, 20), dtype=np.uint8)
    masks[0, 5:15, 5:15] = 1
    masks[2, 3:9, 3:9] = 1
    tifffile.imwrite(tmp_path / "masks.tif", masks, photometric="minisblack")
    inputs = open_inputs(tmp_path / "masks.tif", None, SMALL)
    assert [(checked.found.cell, bool(checked.reason)) for checked in check_cells(inputs)] == [
        (0, False),
        (1, True),
        (2, False),
    ]
    study = map_study(inputs, tmp_path / "out")
    assert study.cells["status"].tolist() == ["ok", "no cell", "ok"]
    assert "is empty: no pixel belongs to the cell" in study.cells["reason"][1]
    assert study.windows["cell"].unique().tolist() == [0, 2]


def test_a_label_image_gives_a_cell_a_label_with_one_signal(tmp_path: Path) -> None:
    labels = np.zeros((40, 40), dtype=np.uint16)
    labels[2:15, 2:15], labels[20:38, 20:38] = 4, 9
    signal = cd.simulate.linear_signal((40, 40), (1.0, 2.0)).astype(np.float32)
    tifffile.imwrite(tmp_path / "labels.tif", labels)
    tifffile.imwrite(tmp_path / "signal.tif", signal)
    study = map_study(open_inputs(tmp_path / "labels.tif", tmp_path / "signal.tif", SMALL), tmp_path / "out")
    assert study.cells[["frame", "label", "area_px"]].to_numpy().tolist() == [[0, 4, 169], [0, 9, 324]]
    expected = study.windows["centroid_y"] + 2.0 * study.windows["centroid_x"]
    # Whole pixels have the signal, parts of pixels the centre: they differ by less than a tenth of a pixel.
    np.testing.assert_allclose(study.windows["mean"], expected, rtol=0, atol=0.3)


def test_nan_in_the_signal_is_counted(tmp_path: Path) -> None:
    mask = np.zeros((20, 20), dtype=np.uint8)
    mask[4:16, 4:16] = 1
    signal = np.ones((20, 20), dtype=np.float32)
    signal[5, 5:8] = np.nan
    signal[0, 0] = np.nan
    tifffile.imwrite(tmp_path / "mask.tif", mask)
    tifffile.imwrite(tmp_path / "signal.tif", signal)
    paths = tmp_path / "mask.tif", tmp_path / "signal.tif"
    study = map_study(open_inputs(*paths, SMALL), tmp_path / "out")
    assert study.cells["nan_px"].tolist() == [3]
    assert "3 NaN or infinite values in the signal" in study.cells["notes"][0]
    touched = study.windows["n_nan"] > 0
    assert study.windows["n_nan"].sum() == pytest.approx(3.0)
    assert touched.any()
    assert (study.windows["mean"].isna() == touched).all()
    assert (study.windows["status"] == np.where(touched, "NaN in signal", "ok")).all()
    omitting = parameters_from({"layers": 3, "sectors": 8, "nan": "omit"}, None, MapParameters)
    windows = map_study(open_inputs(*paths, omitting), tmp_path / "omit").windows
    np.testing.assert_allclose(windows["mean"].dropna(), 1.0)
    assert windows["mean"].isna().sum() < touched.sum()


def test_a_signal_that_does_not_fit_is_refused(write_stack: WriteStack, tmp_path: Path) -> None:
    masks, _ = write_stack(4)
    other = tmp_path / "other.tif"
    tifffile.imwrite(other, np.zeros((4, 50, 61), dtype=np.uint8), photometric="minisblack")
    with pytest.raises(SignalError, match=r"\(50, 61\).*\(50, 60\)"):
        open_inputs(masks, other, SMALL)
    tifffile.imwrite(other, np.zeros((3, 50, 60), dtype=np.uint8), photometric="minisblack")
    with pytest.raises(SignalError, match=r"3 frames.*4"):
        open_inputs(masks, other, SMALL)
    tifffile.imwrite(other, np.zeros((50, 60), dtype=np.complex64))
    with pytest.raises(SignalError, match="of type complex64, which cannot be measured: save it as uint16"):
        open_inputs(masks, other, SMALL)


def test_a_stack_is_no_single_mask(write_stack: WriteStack) -> None:
    masks, _ = write_stack(2)
    with pytest.raises(MaskError, match="stack of 2 frames"):
        open_inputs(masks, None, parameters_from({"kind": "mask"}, None, MapParameters))


def test_workers_must_be_positive(write_stack: WriteStack, tmp_path: Path) -> None:
    inputs: CellInputs = open_inputs(write_stack(1)[0], None, SMALL)
    with pytest.raises(ParameterError, match=r"workers.*0"):
        map_study(inputs, tmp_path / "out", workers=0)
    assert not (tmp_path / "out").exists()


def test_two_runs_do_not_write_into_one_folder(write_stack: WriteStack, tmp_path: Path) -> None:
    masks, signal = write_stack(1)
    with alone_in(tmp_path / "out"), pytest.raises(StudyError, match="another run is writing there"):
        map_study(open_inputs(masks, signal, SMALL), tmp_path / "out")
    assert map_study(open_inputs(masks, signal, SMALL), tmp_path / "out").cells["status"].tolist() == ["ok"]
    assert not list((tmp_path / "out").glob(".cytodisk*"))


@pytest.mark.parametrize("kill", [True, False])
@pytest.mark.parametrize(
    ("then", "now", "words"),
    [
        ({}, {"geojson": True}, "without outlines of windows: .*--overwrite .* leave --geojson out"),
        ({"maps": False}, {}, "without maps: .*--overwrite .* pass --no-maps"),
        ({"geojson": True}, {}, ""),
        ({"geojson": True}, {"maps": False, "geojson": True}, ""),
    ],
)
def test_cells_that_are_done_do_not_silently_lack_what_is_asked_for(
    write_stack: WriteStack,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    kill: bool,
    then: dict[str, bool],
    now: dict[str, bool],
    words: str,
) -> None:
    masks, signal = write_stack(2)
    inputs = open_inputs(masks, signal, SMALL)
    with monkeypatch.context() as patch, suppress(Stopped):
        if kill:
            patch.setattr(StudyFolder, "finish", _stop)
        map_study(inputs, tmp_path / "out", **then)
    if not words:
        assert len(map_study(inputs, tmp_path / "out", resume=True, **now).cells) == 2
        return
    with pytest.raises(StudyError, match=words):
        map_study(inputs, tmp_path / "out", resume=True, **now)
    study = map_study(inputs, tmp_path / "out", overwrite=True, **now)
    assert len([*(study.path / "maps").iterdir()]) == 2 * len(MapOptions(**now).writes)


def test_a_run_killed_before_its_first_note_can_be_repeated(write_stack: WriteStack, tmp_path: Path) -> None:
    masks, signal = write_stack(1)
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / ".cytodisk.lock").touch()
    (tmp_path / "out" / temporary_name(".json")).touch()
    assert len(map_study(open_inputs(masks, signal, SMALL), tmp_path / "out").cells) == 1


def test_an_overwrite_killed_half_way_can_be_repeated(
    write_stack: WriteStack, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    masks, signal = write_stack(1)
    inputs = open_inputs(masks, signal, SMALL)
    map_study(inputs, tmp_path / "out")
    with monkeypatch.context() as patch:
        patch.setattr(Path, "rmdir", _stop)
        with pytest.raises(Stopped):
            map_study(inputs, tmp_path / "out", overwrite=True)
    with pytest.raises(ReadError, match="not complete"):
        cd.open_study(tmp_path / "out")
    assert len(map_study(inputs, tmp_path / "out", overwrite=True).cells) == 1


def test_a_missing_part_is_not_passed_over(write_stack: WriteStack, tmp_path: Path) -> None:
    masks, signal = write_stack(2)

    def lose_a_part(done: int, total: int) -> None:
        if done == total:
            (tmp_path / "out" / ".parts" / f"{part_key(0)}.json").unlink()

    with pytest.raises(StudyError, match=r"has no part 00000 any more.*--resume"):
        map_study(open_inputs(masks, signal, SMALL), tmp_path / "out", progress=lose_a_part)


def test_a_files_own_scale_stays_out_of_the_parameters(write_stack: WriteStack, tmp_path: Path) -> None:
    masks, _ = write_stack(1)
    for name, size in (("fine", 0.1), ("coarse", 0.3)):
        metadata = {"axes": "YX", "PhysicalSizeX": size, "PhysicalSizeY": size}
        tifffile.imwrite(tmp_path / f"{name}.ome.tif", tifffile.imread(masks)[0], metadata=metadata)
    fine = tmp_path / "fine.ome.tif"
    study = map_study(open_inputs(tmp_path / "coarse.ome.tif", None, SMALL), tmp_path / "out")
    again = parameters_from({}, tmp_path / "out" / "parameters.toml", MapParameters)
    assert study.provenance["pixel_size_um"] == pytest.approx(0.3)
    assert open_inputs(fine, None, again).scale.pixel_size_um == pytest.approx(0.1)
    with pytest.raises(SignalError, match="pixel sizes differ"):
        open_inputs(fine, tmp_path / "coarse.ome.tif", SMALL)


def test_resume_and_overwrite_exclude_each_other(write_stack: WriteStack, tmp_path: Path) -> None:
    masks, signal = write_stack(1)
    with pytest.raises(ParameterError, match="exclude each other"):
        map_study(open_inputs(masks, signal, SMALL), tmp_path / "out", resume=True, overwrite=True)


def _stop(*_: object, **__: object) -> None:
    raise Stopped
