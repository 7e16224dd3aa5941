"""Outlines and windows as ROIs: where they stand, their names, and that they can be read as masks."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile
from placed_windows import GRID, check_places, windows_of

import cytodisk as cd
from cytodisk.errors import MissingPartError, ParameterError, ReadError, StudyError

roifile = pytest.importorskip("roifile", reason="roifile is not installed")


def rois_in(path: Path) -> list[Any]:
    found = roifile.roiread(path)
    return found if isinstance(found, list) else [found]


def test_rois_of_windows_cover_the_pixels_of_their_windows(mapped: cd.Study, tmp_path: Path) -> None:
    written = cd.run_export(mapped.path, tmp_path, to="roi")
    assert [path.name for path in written] == ["outlines.zip", "windows.zip"]
    rois = rois_in(tmp_path / "windows.zip")
    assert [roi.name for roi in rois[:2]] == ["cell 0, layer 0, sector 0", "cell 0, layer 0, sector 1"]
    assert len({roi.name for roi in rois}) == len(rois) == 24
    for cell in (0, 1):
        windows = windows_of(mapped, cell)
        own = [roi for roi in rois if roi.name.startswith(f"cell {cell},")]
        check_places(windows, [roi.coordinates() for roi in own])
        by_layer = [{roi.stroke_color for roi in own if f"layer {layer}," in roi.name} for layer in (0, 1)]
        assert [len(colours) for colours in by_layer] == [1, 1]
        assert by_layer[0] != by_layer[1]
    assert {(roi.position, roi.t_position, roi.stroke_width) for roi in rois} == {(0, 0, 0)}


def test_rois_of_outlines_give_the_same_masks_again(mapped: cd.Study, tmp_path: Path) -> None:
    cd.run_export(mapped.path, tmp_path, to=["roi"], windows=False)
    assert not (tmp_path / "windows.zip").exists()
    signal = mapped.path.parent / "signal.ome.tif"
    again = cd.run_map(tmp_path / "outlines.zip", tmp_path / "again", signal=signal, **GRID)
    for cell in (0, 1):
        np.testing.assert_array_equal(again.map(cell).mask, mapped.map(cell).mask)


def test_rois_of_a_movie_stand_in_their_frames(followed: cd.Study, tmp_path: Path) -> None:
    cd.run_export(followed.path, tmp_path, to="roi", frames=(1, 3))
    outlines, windows = (rois_in(tmp_path / f"{name}.zip") for name in ("outlines", "windows"))
    assert [(roi.name, roi.t_position) for roi in outlines] == [
        ("0002-cell-0, outline", 2),
        ("0004-cell-0, outline", 4),
    ]
    assert windows[5].name == "0002-cell-0, layer 0, sector 5"
    for frame in (1, 3):
        own = [roi.coordinates() for roi in windows if roi.t_position == frame + 1]
        check_places(windows_of(followed, 0, frame), own)


def test_rois_of_a_movie_are_masks_of_its_frames_again(followed: cd.Study, tmp_path: Path) -> None:
    cd.run_export(followed.path, tmp_path, to="roi", windows=False)
    signal = followed.path.parent / "signal.tif"
    again = cd.run_movie(tmp_path / "outlines.zip", tmp_path / "again", signal=signal, **GRID)
    assert again.cells["status"].tolist() == followed.cells["status"].tolist()
    for frame in (0, 1, 3):
        np.testing.assert_array_equal(again.map(0, frame).mask, followed.map(0, frame).mask)


def test_nuclei_have_a_set_of_their_own(tmp_path: Path) -> None:
    cell = cd.simulate.disk(14).astype(np.uint8)
    y, x = np.indices(cell.shape) - np.array(cell.shape)[:, None, None] // 2
    nucleus = (np.hypot(y, x) < 6).astype(np.uint8)
    tifffile.imwrite(tmp_path / "cell.tif", cell)
    tifffile.imwrite(tmp_path / "nucleus.tif", nucleus)
    cd.run_map(tmp_path / "cell.tif", tmp_path / "out", nuclei=tmp_path / "nucleus.tif", **GRID)
    cd.run_export(tmp_path / "out", tmp_path / "rois", to="roi")
    (roi,) = rois_in(tmp_path / "rois" / "nuclei.zip")
    assert roi.name == "cell 0, nucleus"
    again = cd.run_map(
        tmp_path / "rois" / "nuclei.zip", tmp_path / "again", signal=tmp_path / "cell.tif", **GRID
    )
    np.testing.assert_array_equal(again.map(0).mask, nucleus > 0)


def test_what_is_there_is_not_replaced_unasked(mapped: cd.Study, tmp_path: Path) -> None:
    (tmp_path / "windows.zip").write_text("mine")
    with pytest.raises(StudyError, match=r"holds windows.zip already: .* or pass --overwrite"):
        cd.run_export(mapped.path, tmp_path, to=("geojson", "roi"))
    assert [path.name for path in tmp_path.iterdir()] == ["windows.zip"]
    cd.run_export(mapped.path, tmp_path, to="roi", cells=(1,), overwrite=True)
    assert len(rois_in(tmp_path / "windows.zip")) == 12


def test_an_input_of_the_study_is_never_replaced(mapped: cd.Study, tmp_path: Path) -> None:
    cd.run_export(mapped.path, tmp_path, to="roi", windows=False)
    before = (tmp_path / "outlines.zip").read_bytes()
    signal = mapped.path.parent / "signal.ome.tif"
    cd.run_map(tmp_path / "outlines.zip", tmp_path / "again", signal=signal, **GRID)
    with pytest.raises(StudyError, match=r"outlines.zip is an input of the study: name another folder"):
        cd.run_export(tmp_path / "again", tmp_path, to="roi", windows=False, overwrite=True)
    assert (tmp_path / "outlines.zip").read_bytes() == before


@pytest.mark.parametrize(
    ("given", "error", "words"),
    [
        ({"to": "doc"}, ParameterError, "must name some of roi, geojson, spatialdata, got 'doc'"),
        ({"to": ()}, ParameterError, "got none"),
        ({"to": "roi", "cells": (7,)}, ReadError, "has no cell 7: it has the cells 0 to 1"),
        ({"to": "roi", "frames": (3, 9)}, ParameterError, "frames must be some of 0 to 0"),
        ({"to": "roi", "frames": (9, 3)}, ParameterError, "must go from the first to the last"),
        ({"to": "roi", "layers": 3}, ParameterError, "layers"),
    ],
)
def test_what_cannot_be_written_is_refused(
    mapped: cd.Study, tmp_path: Path, given: dict[str, Any], error: type[Exception], words: str
) -> None:
    with pytest.raises(error, match=words.replace("(", r"\(")):
        cd.run_export(mapped.path, tmp_path / "new", **given)
    assert not (tmp_path / "new").exists()


def test_a_frame_without_a_map_is_refused_with_its_reason(followed: cd.Study, tmp_path: Path) -> None:
    with pytest.raises(ReadError, match=r"no map of any of the chosen cells: .*empty"):
        cd.run_export(followed.path, tmp_path, to="roi", frames=(2, 2))


def test_without_roifile_what_to_install_is_said(
    mapped: cd.Study, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "roifile", None)
    with pytest.raises(MissingPartError, match=r"needs roifile.*pip install 'cytodisk\[roi\]'"):
        cd.run_export(mapped.path, tmp_path / "new", to=("geojson", "roi"))
    assert not (tmp_path / "new").exists()
