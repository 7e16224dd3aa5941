"""Several cells in masks of 0 and 1: refused with both remedies, numbered, or the largest alone."""

import json
from pathlib import Path

import numpy as np
import pytest
import tifffile

import cytodisk as cd
from cytodisk.errors import MaskError

SIZE = {"layers": 2, "sectors": 6}
FRAMES = 4


def disk(y: float, x: float, radius: float) -> np.ndarray:
    rows, columns = np.indices((80, 110))
    return np.hypot(rows - y, columns - x) < radius


MANY = np.stack([disk(22 + t, 22, 12) | disk(55, 25 + t, 13) | disk(40, 85 - t, 14) for t in range(FRAMES)])
ONE = np.stack([disk(40, 50 + t, 14) for t in range(FRAMES)])


def written(path: Path, masks: np.ndarray) -> Path:
    tifffile.imwrite(path, masks.astype(np.uint8) * 255, photometric="minisblack")
    return path


def test_a_movie_of_several_cells_is_refused_before_anything_is_written(tmp_path: Path) -> None:
    path = written(tmp_path / "a.tif", MANY)
    for run in (cd.run_movie, cd.run_map):
        with pytest.raises(MaskError, match=r"in each frame.*3 pieces.*--label.*--fragments largest"):
            run(path, tmp_path / "out", **SIZE)
    assert not (tmp_path / "out").exists()


def test_one_frame_of_several_cells_costs_its_row(tmp_path: Path) -> None:
    path = written(tmp_path / "a.tif", np.concatenate([ONE[:2], MANY[:1], ONE[2:]]))
    for run in (cd.run_movie, cd.run_map):
        cells = run(path, tmp_path / run.__name__, **SIZE).cells
        assert cells["status"].tolist() == ["ok", "ok", "refused", "ok", "ok"]
        assert "--label" in cells["reason"][2]
        assert "--fragments largest" in cells["reason"][2]
    largest = cd.run_movie(path, tmp_path / "largest", fragments="largest", **SIZE).cells
    assert largest["status"].tolist() == ["ok"] * 5
    assert "a large fragment was dropped" in largest["mask_remarks"][2]


def test_pieces_are_cells_of_map_and_tracks_of_movie(tmp_path: Path) -> None:
    pytest.importorskip("laptrack")
    path = written(tmp_path / "a.tif", MANY)
    cells = cd.run_map(path, tmp_path / "map", label=True, **SIZE).cells
    assert (cells["status"] == "ok").sum() == len(cells) == 3 * FRAMES
    movie = cd.run_movie(path, tmp_path / "movie", label=True, **SIZE).cells
    assert movie.groupby("cell")["frame"].apply(list).tolist() == [list(range(FRAMES))] * 3
    steps = movie.groupby("cell")["centroid_x"].diff().dropna().to_numpy()
    np.testing.assert_allclose(np.abs(steps), np.round(np.abs(steps)), atol=0.01)
    assert np.abs(steps).max() == pytest.approx(1, abs=0.01)


def test_files_of_a_folder_are_numbered_too(tmp_path: Path) -> None:
    pytest.importorskip("laptrack")
    (tmp_path / "masks").mkdir()
    for number, mask in enumerate(MANY):
        written(tmp_path / "masks" / f"t{number}.tif", mask)
    movie = cd.run_movie(tmp_path / "masks", tmp_path / "movie", label=True, **SIZE).cells
    assert movie["cell"].nunique() == 3
    cells = cd.run_map(tmp_path / "masks", tmp_path / "map", label=True, **SIZE).cells
    assert len(cells) == 3 * FRAMES
    refused = cd.run_map(tmp_path / "masks", tmp_path / "refused", **SIZE).cells
    assert refused["status"].tolist() == ["refused"] * FRAMES


def test_a_label_of_two_pieces_costs_its_row(tmp_path: Path) -> None:
    labels = (disk(22, 22, 12) + 2 * (disk(55, 25, 13) | disk(40, 85, 14))).astype(np.uint8)
    tifffile.imwrite(tmp_path / "a.tif", labels)
    cells = cd.run_map(tmp_path / "a.tif", tmp_path / "out", **SIZE).cells
    assert cells["status"].tolist() == ["ok", "refused"]
    assert "label 2 has 2 pieces" in cells["reason"][1]


@pytest.mark.parametrize("share", [1.0, 0.5])
def test_labels_that_change_name_the_remedy(tmp_path: Path, share: float) -> None:
    labels = np.zeros((6, 80, 110), dtype=np.uint8)
    for frame, image in enumerate(labels):
        order = [1, 2, 3] if frame % 2 and share < 1 else np.roll([1, 2, 3], frame)
        for number, place in zip(order, ((22, 22), (55, 25), (40, 85)), strict=True):
            image[disk(*place, 12)] = number
    tifffile.imwrite(tmp_path / "a.tif", labels, photometric="minisblack")
    with pytest.raises(MaskError, match=r"label 1 of frame . is label . in frame .*--link.*--no-link"):
        cd.run_movie(tmp_path / "a.tif", tmp_path / "out", **SIZE)
    kept = cd.run_movie(tmp_path / "a.tif", tmp_path / "kept", link=False, **SIZE).cells
    assert kept["cell"].nunique() == 3


def test_one_label_that_changes_is_told(tmp_path: Path) -> None:
    labels = np.zeros((4, 80, 110), dtype=np.uint8)
    for frame, image in enumerate(labels):
        for number, place in enumerate(((22, 22), (55, 25), (40, 85)), start=1):
            image[disk(*place, 12)] = 9 if (number, frame) == (3, 3) else number
    tifffile.imwrite(tmp_path / "a.tif", labels, photometric="minisblack")
    for link, said in [(None, True), (False, False), (True, False)]:
        cd.run_movie(tmp_path / "a.tif", tmp_path / str(link), link=link, **SIZE)
        told = json.loads((tmp_path / str(link) / "provenance.json").read_text())["warnings"]
        assert any("label 3 of frame 2 is label 9 in frame 3" in words for words in told) is said
        assert any(words.endswith("pass --link") for words in told) is said
