"""Tracks of TrackMate and GEFFs, and the labels that they belong to."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile
import zarr

from cytodisk.errors import MaskError, ReadError
from cytodisk.images.file_parameters import KindParameters
from cytodisk.images.frames import open_frames
from cytodisk.images.spots.label_spots import LabelTracks, label_tracks
from cytodisk.images.spots.spots import Spots, branches
from cytodisk.images.spots.track_files import read_tracks
from cytodisk.images.spots.track_units import frame_interval_s, length_unit, pixel_size_um
from cytodisk.images.what_it_is import look_at
from cytodisk.scale import UNKNOWN, Scale
from outline_files import trackmate_xml, write_geff

# The first cell divides after frame 1; labels change from frame to frame.
NODES = {
    "id": [10, 11, 12, 13, 20, 21, 22],
    "t": [0, 1, 2, 2, 0, 1, 2],
    "y": [10.0, 10.0, 6.0, 16.0, 20.0, 20.0, 20.0],
    "x": [10.0, 12.0, 12.0, 12.0, 30.0, 31.0, 32.0],
}
EDGES = [(10, 11), (11, 12), (11, 13), (20, 21), (21, 22)]
TRACKS = [(10, 11, 0), (11, 12, 0), (11, 13, 0), (20, 21, 4), (21, 22, 4)]
LABELS = [3, 8, 2, 5, 7, 3, 9]


def spots_of(size: float = 1.0, **more: Any) -> list[dict[str, Any]]:
    keys = zip(NODES["id"], NODES["t"], NODES["y"], NODES["x"], strict=True)
    return [{"id": i, "frame": t, "y": y * size, "x": x * size} | more for i, t, y, x in keys]


def movie(radius: float = 3.5) -> np.ndarray:
    y, x = np.mgrid[:30, :40]
    labels = np.zeros((3, 30, 40), dtype=np.uint8)
    for t, at_y, at_x, label in zip(NODES["t"], NODES["y"], NODES["x"], LABELS, strict=True):
        labels[t][np.hypot(y - at_y, x - at_x) <= radius] = label
    return labels


def matched(spots: Spots, labels: np.ndarray, folder: Path, scale: Scale = UNKNOWN) -> LabelTracks:
    tifffile.imwrite(folder / "labels.tif", labels, metadata={"axes": "TYX"}, imagej=True)
    file = open_frames(folder / "labels.tif")
    return label_tracks(spots, file, look_at(file, KindParameters(kind="labels")).labels, scale)


def trackmate(folder: Path, text: str) -> Spots:
    (folder / "a.xml").write_text(text)
    return read_tracks(folder / "a.xml")


def of_trackmate(folder: Path) -> Spots:
    return trackmate(folder, trackmate_xml(spots_of(0.5), TRACKS, unit="µm", size=0.5))


def of_exported_tracks(folder: Path) -> Spots:
    detections = {
        track: "".join(f'<detection t="{t}" x="{x}" y="{y}" z="0.0" />' for t, y, x in places)
        for track, places in (("a", [(0, 10, 10), (1, 10, 12)]), ("b", [(2, 6, 12)]), ("c", [(2, 16, 12)]))
    }
    detections["d"] = "".join(f'<detection t="{t}" x="{30 + t}" y="20" z="0.0" />' for t in range(3))
    particles = "".join(f'<particle nSpots="1">{held}</particle>' for held in detections.values())
    head = '<Tracks nTracks="4" spaceUnits="pixel" frameInterval="2.0" timeUnits="sec" from="TrackMate v7">'
    return trackmate(folder, f'<?xml version="1.0" encoding="UTF-8"?>{head}{particles}</Tracks>')


def of_geff(folder: Path) -> Spots:
    return read_tracks(write_geff(folder / "a.geff", NODES, EDGES))


def of_geff_3(folder: Path) -> Spots:
    return read_tracks(write_geff(folder / "b.geff", NODES, EDGES, zarr_format=3))


def of_geff_with_labels(folder: Path) -> Spots:
    nowhere = {"y": [0.0] * 7, "x": [0.0] * 7}
    return read_tracks(write_geff(folder / "c.geff", NODES | nowhere | {"seg_id": LABELS}, EDGES))


@pytest.mark.parametrize("read", [of_trackmate, of_exported_tracks, of_geff, of_geff_3, of_geff_with_labels])
def test_each_label_gets_the_track_of_its_spot(tmp_path: Path, read: Callable[[Path], Spots]) -> None:
    found = matched(read(tmp_path), movie(), tmp_path)
    (first, second, third) = found.frames
    cell, other = first[3], first[7]
    assert cell != other
    assert second == {8: cell, 3: other}
    assert third[9] == other
    assert len({cell, other, third[2], third[5]}) == 4  # daughters are cells of their own
    if read is not of_exported_tracks:  # which has no divisions
        assert found.mothers == {third[2]: cell, third[5]: cell}
        assert f"1 track divide: daughters are cells of their own ({cell} → " in "; ".join(found.remarks)


def test_tracks_keep_their_numbers(tmp_path: Path) -> None:
    spots = of_trackmate(tmp_path)
    assert sorted(set(branches(spots).track.tolist())) == [1, 5, 6, 7]  # TrackMate counts from 0
    named = NODES | {"track": [40, 40, 41, 42, 7, 7, 7]}
    path = write_geff(tmp_path / "a.geff", named, EDGES, track_node_props={"tracklet": "track"})
    assert branches(read_tracks(path)).track.tolist() == [40, 40, 41, 42, 7, 7, 7]


def test_tracks_that_merge(tmp_path: Path) -> None:
    nodes = {"id": [1, 2, 3, 4], "t": [0, 0, 1, 3], "y": [1.0, 2.0, 1.0, 1.0], "x": [1.0, 1.0, 1.0, 1.0]}
    found = branches(read_tracks(write_geff(tmp_path / "a.geff", nodes, [(1, 3), (3, 2), (4, 3)])))
    assert found.track.tolist() == [1, 2, 3, 3]  # across a missing frame, and whichever way links run
    assert (found.mothers, found.merged) == ({}, {3: (1, 2)})


def test_links_within_a_frame_are_left_out(tmp_path: Path) -> None:
    nodes = {"id": [1, 2, 3], "t": [0, 0, 1], "y": [1.0, 2.0, 1.0], "x": [1.0, 1.0, 1.0]}
    found = branches(read_tracks(write_geff(tmp_path / "a.geff", nodes, [(1, 2), (1, 3)])))
    assert (found.track.tolist(), found.ignored) == ([1, 2, 1], 1)


def test_tracks_that_trackmate_filters_out_are_told(tmp_path: Path) -> None:
    text = trackmate_xml(spots_of(), TRACKS).replace('<TrackID TRACK_ID="4" />', "")
    spots = trackmate(tmp_path, text)
    assert len(spots) == 4
    assert spots.remarks == ("3 of 7 spots are in no track that TrackMate shows",)
    found = matched(spots, movie(), tmp_path)
    assert "3 labels without a spot left out (label 7 in frame 0, label 3 in frame 1" in "; ".join(
        found.remarks
    )


def test_positions_in_micrometres_need_the_pixel_size(tmp_path: Path) -> None:
    nodes = NODES | {name: [0.25 * value for value in NODES[name]] for name in "yx"}
    spots = read_tracks(write_geff(tmp_path / "a.geff", nodes, EDGES, unit="micrometer"))
    with pytest.raises(ReadError, match=r"positions in micrometer.*unknown: pass it \(--pixel-size\)"):
        matched(spots, movie(), tmp_path)
    assert len(matched(spots, movie(), tmp_path, Scale(0.25)).frames[0]) == 2
    with pytest.raises(MaskError, match=r"of 7 spots lie in a label.*right pixel size \(--pixel-size\)"):
        matched(spots, movie(), tmp_path, Scale(0.05))


def test_a_pixel_size_that_only_trackmate_knows_is_told(tmp_path: Path) -> None:
    spots = of_trackmate(tmp_path)
    assert "say pixels of 0.5 µm: pass --pixel-size 0.5" in "; ".join(
        matched(spots, movie(), tmp_path).remarks
    )
    against = matched(spots, movie(), tmp_path, Scale(0.3)).remarks
    assert "say pixels of 0.5 µm, the movie 0.3 µm: which one is right?" in "; ".join(against)
    assert "pixels" not in "; ".join(matched(spots, movie(), tmp_path, Scale(0.5)).remarks)


def test_a_spot_in_no_label_is_told(tmp_path: Path) -> None:
    labels = movie()
    labels[1][labels[1] == 8] = 0
    found = matched(of_geff(tmp_path), labels, tmp_path)
    assert "1 of 7 spots lie in no label (track 1 in frame 1)" in found.remarks
    assert found.frames[1] == {3: 2}


def test_two_spots_in_one_label_are_told(tmp_path: Path) -> None:
    labels = movie()
    labels[2][labels[2] == 5] = 2
    found = matched(of_geff(tmp_path), labels, tmp_path)
    assert (
        "1 label with several spots left out (label 2 in frame 2: tracks 3 and 4): correct the "
        "segmentation, or the tracks" in found.remarks
    )
    assert found.frames[2] == {9: 2}


def test_a_label_without_a_spot_is_told(tmp_path: Path) -> None:
    labels = movie()
    labels[1, :3, :3] = 77
    found = matched(of_geff(tmp_path), labels, tmp_path)
    assert "1 label without a spot left out (label 77 in frame 1)" in found.remarks


def test_spots_after_the_last_frame_are_told(tmp_path: Path) -> None:
    found = matched(of_geff(tmp_path), movie()[:2], tmp_path)
    assert "3 of 7 spots stand after the last frame: does the movie lack some?" in found.remarks
    assert len(found.frames) == 2


def test_tracks_of_another_movie_are_refused(tmp_path: Path) -> None:
    with pytest.raises(MaskError, match=r"0 of 7 spots lie in a label .*: are they tracks of this movie"):
        matched(of_geff(tmp_path), np.roll(movie(), 15, axis=2), tmp_path)


def test_the_centre_of_a_crescent_lies_outside_of_it(tmp_path: Path) -> None:
    labels = movie()
    for frame in range(3):
        labels[frame, 16:25, 24:40] = 0
        labels[frame, 17:24, 27] = 60 + frame
    spots = trackmate(tmp_path, trackmate_xml(spots_of(radius=6.0), TRACKS))
    found = matched(spots, labels, tmp_path)
    assert [frame.get(60 + number) for number, frame in enumerate(found.frames)] == [5, 5, 5]


def test_an_outline_says_which_label_is_meant(tmp_path: Path) -> None:
    spots = spots_of()
    labels = movie()
    for spot in spots:  # outlines stand on the labels, centres elsewhere
        y, x = spot["y"], spot["x"]
        spot["polygon"] = [(x - 3, y - 3), (x + 3, y - 3), (x + 3, y + 3), (x - 3, y + 3)]
        spot["y"], spot["x"] = 1.0, 1.0
    found = matched(trackmate(tmp_path, trackmate_xml(spots, TRACKS)), labels, tmp_path)
    assert found.frames[0] == {3: 1, 7: 5}


def test_frames_of_a_geff_by_their_times(tmp_path: Path) -> None:
    seconds = [{"name": "t", "type": "time", "unit": "second"}]
    space = [{"name": name, "type": "space", "unit": "pixel"} for name in "yx"]

    def frames(times: list[float], interval: float | None) -> list[int]:
        nodes = NODES | {"t": times}
        path = write_geff(tmp_path / "a.geff", nodes, EDGES, axes=seconds + space)
        return read_tracks(path, interval).frame.tolist()

    assert frames([0.0, 2.5, 5.0, 5.0, 0.0, 2.5, 5.0], 2.5) == NODES["t"]
    assert frames([0, 5, 10, 10, 0, 5, 10], 5.0) == NODES["t"]
    assert frames(NODES["t"], 5.0) == NODES["t"]
    with pytest.raises(
        ReadError, match=r"no whole frames: pass the time between frames \(--frame-interval\)"
    ):
        frames([0.0, 2.5, 5.0, 5.0, 0.0, 2.5, 5.0], None)
    with pytest.raises(ReadError, match=r"do not lie on frames 2 second apart"):
        frames([0.0, 2.5, 5.0, 5.0, 0.0, 2.5, 5.0], 2.0)
    path = write_geff(tmp_path / "b.geff", NODES | {"t": [0, 5, 10, 10, 0, 5, 10]}, EDGES)
    assert "tracks stand on every 5th frame" in read_tracks(path).remarks[0]


def test_a_geff_of_trackmate_has_other_names_for_its_axes(tmp_path: Path) -> None:
    names = {"FRAME": "time", "POSITION_X": "space", "POSITION_Y": "space"}
    axes = [{"name": name, "type": kind, "unit": "pixel"} for name, kind in names.items()]
    hints = {"display_horizontal": "POSITION_X", "display_vertical": "POSITION_Y", "display_time": "FRAME"}
    nodes = NODES | {"radius": [4.0] * 7, "TRACK_ID": [0, 0, 0, 0, 1, 1, 1]}
    more = {"axes": axes, "display_hints": hints, "track_node_props": {"lineage": "TRACK_ID"}}
    spots = read_tracks(write_geff(tmp_path / "a.geff", nodes, EDGES, **more))
    assert (spots.frame.tolist(), spots.yx.T.tolist()) == (NODES["t"], [NODES["y"], NODES["x"]])
    assert spots.radius.tolist() == [4.0] * 7
    assert len(matched(spots, movie(), tmp_path).mothers) == 2


def test_a_geff_within_a_group_is_found(tmp_path: Path) -> None:
    zarr.open_group(str(tmp_path / "a.zarr"), mode="w", zarr_format=2)
    write_geff(tmp_path / "a.zarr" / "tracks", NODES, EDGES)
    assert len(read_tracks(tmp_path / "a.zarr")) == 7
    write_geff(tmp_path / "a.zarr" / "more", NODES, EDGES)
    with pytest.raises(ReadError, match=r"holds several graphs: pass one of them, as .*more"):
        read_tracks(tmp_path / "a.zarr")


@pytest.mark.parametrize(
    ("nodes", "edges", "about", "words"),
    [
        ({"y": "left out"}, EDGES, {}, "has no array nodes/props/y/values"),
        ({"y": [1.0] * 6}, EDGES, {}, r"y has shape \(6,\)"),
        ({"y": [np.nan] * 7}, EDGES, {}, "y is missing, or no finite number"),
        ({"x": [None, *NODES["x"][1:]]}, EDGES, {}, "x is missing, or no finite number"),
        ({}, [(10, 99)], {}, "has edges to nodes that it has not"),
        (
            {},
            EDGES,
            {"axes": [{"name": "t", "type": "time"}]},
            "one of time and two or three of space are needed",
        ),
        ({"id": []}, [], {}, "holds no node"),
    ],
)
def test_a_geff_that_lacks_something(
    tmp_path: Path, nodes: dict[str, Any], edges: Any, about: dict[str, Any], words: str
) -> None:
    held = {name: values for name, values in (NODES | nodes).items() if values != "left out"}
    path = write_geff(tmp_path / "a.geff", held, edges, **about)
    with pytest.raises(ReadError, match=words):
        read_tracks(path)


def test_a_claim_of_a_geff_is_compared_with_what_is_stored(tmp_path: Path) -> None:
    path = write_geff(tmp_path / "a.geff", NODES, EDGES)
    group = zarr.open_group(str(path), mode="a")
    group.create_array("nodes/ids", shape=(10**12,), dtype="uint64", chunks=(1000,), overwrite=True)
    with pytest.raises(ReadError, match="nodes/ids claims 8000000000000 bytes"):
        read_tracks(path)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("<TrackMate", "<Other"), "begins with <Other>, not with <TrackMate>"),
        (('POSITION_X="10.0"', 'POSITION_X="nan"'), "POSITION_X is nan: save it again with TrackMate"),
        (('POSITION_X="10.0"', 'POSITION_X="x"'), "line 6: could not convert string to float"),
        (('POSITION_X="10.0"', ""), "has no POSITION_X"),
        (('FRAME="1"', 'FRAME="1.5"'), "frame is 1.5, no whole number"),
        (('SPOT_TARGET_ID="11"', 'SPOT_TARGET_ID="99"'), "1 links lead to spots that the file has not"),
        (("</TrackMate>", ""), "is no XML file, or is cut short"),
        (("UTF-8", "UTF1"), "unknown encoding: UTF1.: save it again"),
        (("UTF-8", "UTF-7"), "multi-byte encodings are not supported: save it again"),
        (("<Edge ", "<Other "), "holds no track: track the cells"),
    ],
)
def test_files_of_trackmate_that_are_damaged(tmp_path: Path, change: tuple[str, str], words: str) -> None:
    text = trackmate_xml(spots_of(), TRACKS).replace(*change)
    if change[0] == "<TrackMate":
        text = text.replace("</TrackMate", "</Other")
    with pytest.raises(ReadError, match=words):
        trackmate(tmp_path, text)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_no_entity_is_expanded_and_no_other_file_is_read(tmp_path: Path, encoding: str) -> None:
    (tmp_path / "secret.txt").write_text("1 2 3 4 5 6")
    bomb = '<!ENTITY a "ha"><!ENTITY b "&a;&a;"><!ENTITY other SYSTEM "secret.txt">'
    text = f'<?xml version="1.0" encoding="{encoding}"?><!DOCTYPE TrackMate [{bomb}]>'
    text += "<TrackMate>&other;</TrackMate>"
    (tmp_path / "a.xml").write_bytes(text.encode(encoding))
    with pytest.raises(ReadError, match="the file has a document type"):
        read_tracks(tmp_path / "a.xml")


def test_what_is_no_file_of_tracks(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match="do not exist: check the path"):
        read_tracks(tmp_path / "gone.xml")
    (tmp_path / "a.csv").write_text("1,2")
    for path in (tmp_path / "a.csv", tmp_path):
        with pytest.raises(
            ReadError, match="holds no tracks that can be read: pass an XML file of TrackMate, or a"
        ):
            read_tracks(path)
    zarr.open_group(str(tmp_path / "a.zarr"), mode="w")
    with pytest.raises(ReadError, match="is no GEFF: the zarr group has no attribute 'geff'"):
        read_tracks(tmp_path / "a.zarr")


def test_a_file_of_the_geff_library(tmp_path: Path) -> None:
    geff = pytest.importorskip("geff", reason="its numcodecs is older than the one of this environment")
    graph = pytest.importorskip("networkx").DiGraph()
    for number, node in enumerate(NODES["id"]):
        graph.add_node(node, **{name: NODES[name][number] for name in "tyx"})
    graph.add_edges_from(EDGES)
    types, units = ["time", "space", "space"], ["frame", "pixel", "pixel"]
    geff.write(graph, tmp_path / "a.geff", axis_names=list("tyx"), axis_types=types, axis_units=units)
    assert len(matched(read_tracks(tmp_path / "a.geff"), movie(), tmp_path).mothers) == 2


def test_files_of_tracks_do_not_slow_the_start() -> None:
    code = "import sys, cytodisk.images.spots.track_files; assert 'zarr' not in sys.modules"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


@pytest.mark.parametrize(
    ("unit", "side_um"),
    [("microns", 0.2), ("Micrometres", 0.2), ("\u03bcm", 0.2), ("Å", 2e-5), ("nm", 2e-4), ("pixel", None)],
)
def test_units_of_tracks_are_those_of_images(unit: str, side_um: float | None) -> None:
    assert pixel_size_um((0.2, 0.2), length_unit(unit)) == pytest.approx(side_um)


@pytest.mark.parametrize(
    ("interval", "unit", "seconds"),
    [
        ("0,5", "min", 30.0),
        ("250", "msec", 0.25),
        ("2", "hrs", 7200.0),
        ("1", "frame", None),
        (None, "s", None),
    ],
)
def test_intervals_of_tracks(interval: str | None, unit: str, seconds: float | None) -> None:
    assert frame_interval_s(interval, unit) == pytest.approx(seconds)
