"""`cytodisk movie` sends and keeps the boxes of cells: the same tables, and no memory for what is around."""

import pickle
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import tifffile

import cytodisk as cd
from cytodisk.images import frame_pixels
from cytodisk.images.frame_file import FrameFile
from cytodisk.runs.movie import measured_frame, movie_study
from cytodisk.runs.movie.measured_frame import FrameRows, FrameTask

SETTINGS = {"layers": 2, "sectors": 4}
CELLS = [np.pad(mask, 2) for mask in (cd.simulate.disk(6), cd.simulate.random_smooth(3, radius=8, margin=0))]


def written(folder: Path, side: int) -> tuple[Path, Path]:
    """Two cells in three frames, which move by a pixel."""
    folder.mkdir()
    labels = np.zeros((3, side, side), dtype=np.uint16)
    for frame in range(3):
        for number, mask in enumerate(CELLS):
            y, x = 2 + 40 * number, 3 + 40 * number + frame
            labels[frame, y : y + mask.shape[0], x : x + mask.shape[1]][mask] = 5 * number + 2
    signal = np.zeros((3, 2, side, side), dtype=np.uint16)
    signal[..., :100, :100] = np.random.default_rng(0).poisson(200, (3, 2, 100, 100))
    options = {"compression": "zlib", "tile": (32, 32), "photometric": "minisblack"}
    tifffile.imwrite(folder / "masks.tif", labels, metadata={"axes": "TYX"}, **options)
    tifffile.imwrite(folder / "signal.tif", signal, metadata={"axes": "TCYX"}, **options)
    return folder / "masks.tif", folder / "signal.tif"


def test_frames_read_by_piece_give_the_same_study(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    masks, signal = written(tmp_path / "in", 100)
    whole = cd.run_movie(masks, tmp_path / "whole", signal=signal, **SETTINGS)
    monkeypatch.setattr(frame_pixels, "WHOLE_BYTES", 0)
    monkeypatch.setattr(frame_pixels, "_STRIP_PX", 2000)
    monkeypatch.setattr(FrameFile, "frame", None)  # nobody asks for it
    cut = cd.run_movie(masks, tmp_path / "cut", signal=signal, **SETTINGS)
    assert whole.cells["status"].tolist() == ["ok"] * 6
    pd.testing.assert_frame_equal(whole.cells.drop(columns="seconds"), cut.cells.drop(columns="seconds"))
    pd.testing.assert_frame_equal(whole.windows, cut.windows)
    pd.testing.assert_frame_equal(whole.edge, cut.edge)


def test_what_a_worker_gets_does_not_grow_with_the_frame(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sizes: dict[int, list[int]] = {}
    studies = []
    for side in (100, 500):
        seen = sizes.setdefault(side, [])

        def measured(task: FrameTask, seen: list[int] = seen) -> FrameRows:
            seen.append(len(pickle.dumps(task)))
            return measured_frame.measure_frame(task)

        monkeypatch.setattr(movie_study, "measure_frame", measured)
        masks, signal = written(tmp_path / f"in_{side}", side)
        studies.append(cd.run_movie(masks, tmp_path / f"out_{side}", signal=signal, **SETTINGS))
    assert len(sizes[100]) == 6
    assert max(sizes[500]) < 1.01 * max(sizes[100])
    small, large = studies
    pd.testing.assert_frame_equal(small.windows, large.windows)
    pd.testing.assert_frame_equal(small.cells.drop(columns="seconds"), large.cells.drop(columns="seconds"))


def test_a_damaged_piece_of_the_signal_costs_the_cells_that_lie_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    masks, signal = written(tmp_path / "in", 100)
    with tifffile.TiffFile(signal) as opened:
        offset = opened.pages[3].dataoffsets[0]  # frame 1, second channel, upper left
    content = bytearray(signal.read_bytes())
    content[offset : offset + 6] = b"broken"
    signal.write_bytes(content)
    monkeypatch.setattr(frame_pixels, "WHOLE_BYTES", 0)
    study = cd.run_movie(masks, tmp_path / "out", signal=signal, **SETTINGS)
    cells = study.cells.set_index(["cell", "frame"]).sort_index()
    assert cells.index[cells["status"] != "ok"].tolist() == [(0, 1)]
    assert cells.loc[(0, 1), "status"] == "unreadable"
    assert "frame 1 cannot be read" in cells.loc[(0, 1), "reason"]
    assert "unreadable" in cells.loc[(0, 1), "qc_flags"]
    edge = study.edge[study.edge["cell"] == 0]
    assert edge["velocity"].isna().all()  # no frame of this cell and the next one both have a map
    assert sorted(path.name for path in (study.path / "maps").glob("cell_00000_*")) == [
        "cell_00000_t00000.npz",
        "cell_00000_t00002.npz",
    ]
