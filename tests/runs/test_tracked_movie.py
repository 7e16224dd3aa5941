"""Movies whose labels have the tracks of another program."""

from pathlib import Path

import numpy as np
import pytest
import tifffile

import cytodisk as cd
from cytodisk.errors import MaskError, ParameterError
from cytodisk.runs.batch.batch_file import read_batch
from cytodisk.runs.batch.input_row import files_mark
from cytodisk.runs.movie.movie_parameters import MovieParameters
from outline_files import feature, trackmate_xml, write_geff, write_geojson

PLACES = [(14.0, 14.0), (14.0, 15.0), (36.0, 40.0), (36.0, 41.0)]  # two cells in two frames, (y, x)
FRAMES = [0, 1, 0, 1]


def labels(folder: Path) -> Path:
    y, x = np.mgrid[:50, :60]
    stack = np.zeros((2, 50, 60), dtype=np.uint8)
    for (at_y, at_x), frame, label in zip(PLACES, FRAMES, [1, 2, 2, 1], strict=True):  # they change
        stack[frame][np.hypot(y - at_y, x - at_x) <= 9] = label
    tifffile.imwrite(folder / "labels.tif", stack, metadata={"axes": "TYX"}, imagej=True)
    return folder / "labels.tif"


def session(folder: Path, outlines: bool = False) -> Path:
    angle = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    spots = []
    for number, ((y, x), frame) in enumerate(zip(PLACES, FRAMES, strict=True)):
        spot = {"id": number, "frame": frame, "y": y, "x": x}
        if outlines:
            spot["polygon"] = np.column_stack([x + 9 * np.cos(angle), y + 9 * np.sin(angle)]).tolist()
        spots.append(spot)
    text = trackmate_xml(spots, [(0, 1, 6), (2, 3, 2)])
    (folder / "session.xml").write_text(text.replace('width="40" height="30"', 'width="60" height="50"'))
    return folder / "session.xml"


def graph(folder: Path) -> Path:
    nodes = {"id": range(4), "t": FRAMES, "y": [y for y, _ in PLACES], "x": [x for _, x in PLACES]}
    return write_geff(folder / "a.geff", nodes, [(0, 1), (2, 3)])


def run(folder: Path, masks: Path, **more: object) -> cd.Study:
    return cd.run_movie(masks, folder / "out", layers=2, sectors=4, workers=1, **more)


@pytest.mark.parametrize(("tracks", "numbers"), [(session, [3, 7]), (graph, [1, 2])])
def test_each_cell_is_a_track(tmp_path: Path, tracks: object, numbers: list[int]) -> None:
    path = tracks(tmp_path)  # type: ignore[operator]
    study = run(tmp_path, labels(tmp_path), tracks=path)
    assert study.cells["status"].tolist() == ["ok"] * 4
    assert study.cells.groupby("cell")["label"].unique().map(list).tolist() == [[n] for n in numbers]
    assert study.provenance["inputs"]["tracks"]["path"] == str(path)
    assert "2 cells" in study.provenance["inputs"]["tracks"]["read as"]


def test_outlines_of_trackmate_are_masks_with_their_tracks(tmp_path: Path) -> None:
    study = run(tmp_path, session(tmp_path, outlines=True))
    assert study.cells["status"].tolist() == ["ok"] * 4
    assert study.cells["label"].unique().tolist() == [3, 7]
    assert study.cells["area"].to_numpy() == pytest.approx(np.pi * 81, rel=0.03)


def test_a_division_is_told_and_kept_in_the_study(tmp_path: Path) -> None:
    nodes = {"id": range(4), "t": [0, 1, 1, 0], "y": [20.0, 12.0, 30.0, 20.0], "x": [15.0, 15.0, 15.0, 45.0]}
    path = write_geff(tmp_path / "a.geff", nodes, [(0, 1), (0, 2)])
    y, x = np.mgrid[:50, :60]
    stack = np.zeros((2, 50, 60), dtype=np.uint8)
    for number, (t, at_y, at_x) in enumerate(zip(*(nodes[key] for key in "tyx"), strict=True), start=1):
        stack[t][np.hypot(y - at_y, x - at_x) <= 8] = number
    tifffile.imwrite(tmp_path / "labels.tif", stack, metadata={"axes": "TYX"}, imagej=True)
    study = run(tmp_path, tmp_path / "labels.tif", tracks=path)
    assert study.cells.set_index("label")["frame"].to_dict() == {1: 0, 2: 0, 3: 1, 4: 1}
    assert study.provenance["mothers"] == {"3": 1, "4": 1}
    assert any("1 track divide" in words for words in study.provenance["warnings"])


def test_tracks_need_labels_and_no_linking(tmp_path: Path) -> None:
    path = session(tmp_path)
    with pytest.raises(ParameterError, match=r"link and tracks exclude each other.*\(--link, --tracks\)"):
        run(tmp_path, labels(tmp_path), tracks=path, link=True)
    tifffile.imwrite(tmp_path / "one.tif", (tifffile.imread(labels(tmp_path)) == 1).astype(np.uint8))
    with pytest.raises(MaskError, match="hold one cell a frame, and tracks are for label images"):
        run(tmp_path, tmp_path / "one.tif", tracks=path, kind="stack", axes="TYX")


def test_outlines_have_the_size_of_the_signal(tmp_path: Path) -> None:
    ring = [(5.0, 5.0), (25.0, 5.0), (25.0, 25.0), (5.0, 25.0)]
    masks = write_geojson(tmp_path / "a.geojson", *(feature(ring, plane={"t": t}) for t in range(2)))
    tifffile.imwrite(
        tmp_path / "a.tif", np.ones((3, 50, 60), np.uint8), metadata={"axes": "TYX"}, imagej=True
    )
    study = run(tmp_path, masks, signal=tmp_path / "a.tif")
    assert study.provenance["image_shape"] == [50, 60]
    assert study.cells["status"].tolist() == ["ok", "ok", "refused"]  # no outline stands in the last frame
    one = cd.run_map(masks, tmp_path / "map", signal=tmp_path / "a.tif", layers=2, sectors=4, workers=1)
    assert len(one.cells) == 3


def test_a_folder_of_outlines_and_their_images(tmp_path: Path) -> None:
    ring = [(5.0, 5.0), (25.0, 5.0), (25.0, 25.0), (5.0, 25.0)]
    (tmp_path / "cells").mkdir()
    for name, shape in (("a", (50, 60)), ("b", (40, 45)), ("c", (20, 22))):
        write_geojson(tmp_path / "cells" / f"{name}.tif.geojson", feature(ring))
        tifffile.imwrite(tmp_path / "cells" / f"{name}.tif", np.ones(shape, np.uint8))
    (tmp_path / "cells" / "d.geojson").write_text("{")
    study = cd.run_map(
        tmp_path / "cells", tmp_path / "out", signal=tmp_path / "cells", layers=2, sectors=4, workers=1
    )
    assert study.cells["source"].tolist() == ["a.tif.geojson", "b.tif.geojson", "c.tif.geojson", "d.geojson"]
    assert study.cells["status"].tolist() == ["ok", "ok", "ok", "unreadable"]
    assert study.cells["area"].tolist()[:2] == [400, 400]
    warnings = "; ".join(study.provenance["warnings"])
    assert "1 outline cut by the border of the image" in warnings
    assert "size of the image unknown" not in warnings


def test_a_batch_finds_the_tracks_of_each_movie(tmp_path: Path) -> None:
    labels(tmp_path)
    graph(tmp_path).rename(tmp_path / "labels.geff")
    (tmp_path / "study.toml").write_text('[[inputs]]\nmasks = "lab*.tif"\ntracks = "{stem}.geff"\n')
    (item,) = read_batch(tmp_path / "study.toml").inputs
    assert item.parameters.part(MovieParameters).tracks == str(tmp_path / "labels.geff")
    before = files_mark(item)
    (tmp_path / "labels.geff" / "more").write_text("other tracks")
    assert files_mark(item) != before
    (tmp_path / "study.toml").write_text('[[inputs]]\nmasks = "lab*.tif"\ntracks = "{stem}.xml"\n')
    with pytest.raises(ParameterError, match=r"tracks .*labels\.xml do not exist"):
        read_batch(tmp_path / "study.toml")
