"""`cytodisk map` on frames that are read by piece: the same study as from whole frames, bit for bit."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import tifffile
from numpy.testing import assert_array_equal

import cytodisk as cd
from cytodisk.images import frame_pixels
from cytodisk.images.frame_file import FrameFile
from cytodisk.runs.cells.cell_inputs import open_inputs
from cytodisk.runs.cells.cell_parts import CellTask
from cytodisk.runs.map.map_parameters import MapParameters
from cytodisk.runs.map.map_study import map_study
from cytodisk.runs.map.map_work import MapWork

LABELS = cd.simulate.label_image(5, 2)
SIGNAL = np.random.default_rng(0).poisson(200, (2, *LABELS.shape)).astype(np.uint16)
PARAMETERS = MapParameters(layers=2, sectors=4)


def written(folder: Path, layout: str) -> tuple[Path, Path]:
    options: dict[str, Any] = {
        "strips": {"rowsperstrip": 9},
        "tiles": {"tile": (32, 32), "compression": "zlib"},
        "compressed strips": {"rowsperstrip": 9, "compression": "zlib"},
    }.get(layout, {})
    signal = folder / "signal.tif"
    tifffile.imwrite(signal, SIGNAL, photometric="minisblack", metadata={"axes": "CYX"}, **options)
    if layout == "npy":
        np.save(folder / "masks.npy", LABELS)
        return folder / "masks.npy", signal
    tifffile.imwrite(folder / "masks.tif", LABELS, **options)
    return folder / "masks.tif", signal


def figures(folder: Path, name: str, windows: Any, image: Any, _heading: str) -> list[Path]:
    mean = float(image.to_numpy()[:, windows.mask].mean())
    (folder / f"{name}.txt").write_text(f"{windows.mask.sum()} {mean:.12g}")
    return []


@pytest.mark.parametrize("layout", ["strips", "tiles", "compressed strips", "npy"])
def test_the_study_is_the_same(tmp_path: Path, layout: str, monkeypatch: pytest.MonkeyPatch) -> None:
    masks, signal = written(tmp_path, layout)
    studies = []
    for name, whole_bytes in (("whole", frame_pixels.WHOLE_BYTES), ("cut", 0)):
        monkeypatch.setattr(frame_pixels, "WHOLE_BYTES", whole_bytes)
        monkeypatch.setattr(frame_pixels, "_STRIP_PX", 2000)
        inputs = open_inputs(masks, signal, PARAMETERS)
        studies.append(map_study(inputs, tmp_path / name, draw=figures, draw_at_most=2))
    whole, cut = studies
    pd.testing.assert_frame_equal(whole.cells.drop(columns="seconds"), cut.cells.drop(columns="seconds"))
    pd.testing.assert_frame_equal(whole.windows, cut.windows)
    assert whole.provenance["fingerprint"] == cut.provenance["fingerprint"]
    for path in sorted((tmp_path / "whole" / "maps").iterdir()):
        one, other = cd.load_map(path), cd.load_map(tmp_path / "cut" / "maps" / path.name)
        assert_array_equal(one.mask, other.mask)
        assert_array_equal(one.vertices_yx, other.vertices_yx)
    drawn = sorted((tmp_path / "whole" / "figures").iterdir())
    assert len(drawn) == 2
    assert [path.read_text() for path in drawn] == [
        (tmp_path / "cut" / "figures" / path.name).read_text() for path in drawn
    ]


def test_a_worker_gets_crops_and_the_frame_is_not_read_whole(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    masks, signal = written(tmp_path, "tiles")
    monkeypatch.setattr(frame_pixels, "WHOLE_BYTES", 0)
    monkeypatch.setattr(FrameFile, "frame", None)  # nobody asks for it
    tasks: list[CellTask] = []
    work = MapWork.__call__
    monkeypatch.setattr(MapWork, "__call__", lambda made, task: tasks.append(task) or work(made, task))
    study = map_study(open_inputs(masks, signal, PARAMETERS), tmp_path / "out")
    assert study.cells["status"].tolist() == ["ok"] * 5
    assert len(tasks) == 5
    for task in tasks:
        assert task.found.mask is not None
        assert task.signal is not None
        assert task.signal.values.shape == (2, *task.found.mask.shape)
        assert task.image is None


def test_a_damaged_piece_of_the_signal_costs_the_cells_that_lie_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    masks, signal = written(tmp_path, "tiles")
    y, x = (int(place) // 32 for place in np.argwhere(LABELS)[0])  # a tile in which a cell lies
    with tifffile.TiffFile(signal) as opened:
        offset = opened.pages[1].dataoffsets[y * -(-LABELS.shape[1] // 32) + x]
    content = bytearray(signal.read_bytes())
    content[offset : offset + 6] = b"broken"
    signal.write_bytes(content)
    monkeypatch.setattr(frame_pixels, "WHOLE_BYTES", 0)
    study = map_study(open_inputs(masks, signal, PARAMETERS), tmp_path / "out", draw=figures, draw_at_most=5)
    lost = study.cells["status"] != "ok"
    assert 0 < lost.sum() < 5
    assert set(study.cells["status"][lost]) == {"unreadable"}
    assert len(list((tmp_path / "out" / "figures").iterdir())) == 5 - lost.sum()
