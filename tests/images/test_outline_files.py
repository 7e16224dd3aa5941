"""Outlines of QuPath, ImageJ and StarDist as masks."""

import json
import pickle
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from numpy.testing import assert_array_equal

from cytodisk.errors import ReadError
from cytodisk.images.frame_file import FileChoice, FrameFile
from cytodisk.images.frames import open_frames
from cytodisk.images.what_it_is import look_at
from outline_files import RIGHT, SQUARE, Ring, feature, rectangle, write_geojson, write_stardist_rois

roifile = pytest.importorskip("roifile")

LIKE = FileChoice(like=(1, 30, 40))


def polygon(ring: Ring, **places: Any) -> Any:
    """As ImageJ's polygon tool: whole pixels' corners."""
    roi = roifile.ImagejRoi.frompoints(np.array(ring, dtype=int), **places)
    roi.roitype = roifile.ROI_TYPE.POLYGON
    return roi


def saved(path: Path, *rois: Any) -> Path:
    if path.suffix == ".roi":
        roifile.roiwrite(path, rois[0])
    else:
        roifile.roiwrite(path, rois, name=[f"{number:04d}.roi" for number in range(len(rois))])
    return path


def notes(file: FrameFile) -> str:
    return "; ".join(file.notes)


def test_each_object_of_qupath_is_a_label(tmp_path: Path) -> None:
    file = open_frames(write_geojson(tmp_path / "a.geojson", feature(SQUARE), feature(RIGHT)), choice=LIKE)
    assert (file.axes, file.shape, file.notes) == ("YX", (30, 40), ())
    assert_array_equal(file.frame(0)[0], rectangle((30, 40), SQUARE, RIGHT))
    assert look_at(file).kind == "labels"


def test_each_roi_of_imagej_is_a_label(tmp_path: Path) -> None:
    path = saved(tmp_path / "RoiSet.zip", polygon(SQUARE), polygon(RIGHT))
    file = open_frames(path, choice=LIKE)
    assert_array_equal(file.frame(0)[0], rectangle((30, 40), SQUARE, RIGHT))
    assert file.notes == ()


def test_one_roi_is_one_mask(tmp_path: Path) -> None:
    file = open_frames(saved(tmp_path / "a.roi", polygon(SQUARE)), choice=LIKE)
    assert_array_equal(file.frame(0)[0], rectangle((30, 40), SQUARE))
    assert look_at(file).kind == "mask"


def test_stardists_polygons_count_from_pixel_centres(tmp_path: Path) -> None:
    angle = np.linspace(0, 2 * np.pi, 32, endpoint=False)
    star = np.array([12.0 + 7.1 * np.sin(angle), 15.0 + 7.1 * np.cos(angle)])
    file = open_frames(write_stardist_rois(tmp_path / "a_rois.zip", [star]), choice=LIKE)
    y, x = np.mgrid[:30, :40]
    assert_array_equal(file.frame(0)[0] > 0, shapely.contains_xy(shapely.Polygon(star.T), y, x))
    assert file.axes == "YX"  # its position 1 is that of the one image


@pytest.mark.parametrize("subpixel", [False, True])
def test_ovals_and_rectangles(tmp_path: Path, subpixel: bool) -> None:
    rois = []
    for kind, left in ((roifile.ROI_TYPE.OVAL, 2), (roifile.ROI_TYPE.RECT, 20)):
        roi = roifile.ImagejRoi()
        roi.roitype, roi.left, roi.top, roi.right, roi.bottom = kind, left, 4, left + 16, 24
        if subpixel:
            roi.version, roi.options = 223, roifile.ROI_OPTIONS.SUB_PIXEL_RESOLUTION
            roi.xd, roi.yd, roi.widthd, roi.heightd = left, 4, 16, 20
        rois.append(roi)
    labels = open_frames(saved(tmp_path / "a.zip", *rois), choice=LIKE).frame(0)[0]
    assert (labels == 1).sum() == pytest.approx(np.pi * 8 * 10, abs=4)
    assert (labels == 2).sum() == 16 * 20


def test_composite_rois_have_holes_curves_and_pieces(tmp_path: Path) -> None:
    moves = [(0, 2.0, 2.0), (1, 22.0, 2.0), (1, 22.0, 22.0), (1, 2.0, 22.0), (4,)]
    hole = [(0, 5.0, 5.0), (1, 9.0, 5.0), (1, 9.0, 9.0), (1, 5.0, 9.0), (4,)]
    k = 4 * 4 * (np.sqrt(2) - 1) / 3  # a circle around (30, 15) in four curves
    curve = [
        (0, 34.0, 15.0),
        (3, 34.0, 15.0 + k, 30.0 + k, 19.0, 30.0, 19.0),
        (3, 30.0 - k, 19.0, 26.0, 15.0 + k, 26.0, 15.0),
        (3, 26.0, 15.0 - k, 30.0 - k, 11.0, 30.0, 11.0),
        (3, 30.0 + k, 11.0, 34.0, 15.0 - k, 34.0, 15.0),
        (4,),
    ]
    roi = roifile.ImagejRoi()
    roi.roitype, roi.left, roi.top, roi.right, roi.bottom = roifile.ROI_TYPE.RECT, 2, 2, 34, 22
    roi.multi_coordinates = np.array([v for step in (*moves, *hole, *curve) for v in step], dtype=np.float32)
    roi.shape_roi_size = len(roi.multi_coordinates)
    labels = open_frames(saved(tmp_path / "a.roi", roi), choice=LIKE).frame(0)[0]
    expected = rectangle((30, 40), [(2, 2), (22, 22)]) - rectangle((30, 40), [(5, 5), (9, 9)])
    assert_array_equal(labels[:, :24], expected[:, :24])
    assert labels[:, 24:].sum() == pytest.approx(np.pi * 16, abs=3)


def test_rois_without_an_area_are_told(tmp_path: Path) -> None:
    line = roifile.ImagejRoi.frompoints(np.array(SQUARE))
    line.roitype = roifile.ROI_TYPE.POLYLINE
    point = roifile.ImagejRoi.frompoints(np.array([(3, 4)]))
    point.roitype = roifile.ROI_TYPE.POINT
    file = open_frames(saved(tmp_path / "a.zip", line, polygon(RIGHT), point), choice=LIKE)
    assert file.frame(0)[0].max() == 1
    assert "ROIs without an area left out: 1 × polyline, 1 × point" in notes(file)
    with pytest.raises(ReadError, match=r"holds no ROI with an area: .* 1 × point"):
        open_frames(saved(tmp_path / "b.roi", point))


def test_holes_and_pieces_of_geojson(tmp_path: Path) -> None:
    outer: Ring = [(2, 2), (22, 2), (22, 22), (2, 22)]
    hole: Ring = [(5, 5), (9, 5), (9, 9), (5, 9)]
    pieces = {"type": "MultiPolygon", "coordinates": [[outer, hole], [[(25, 5), (30, 5), (30, 9), (25, 9)]]]}
    whole = {"type": "Feature", "geometry": pieces, "properties": {"name": "cell 1"}}
    file = open_frames(write_geojson(tmp_path / "a.geojson", whole), choice=LIKE)
    expected = rectangle((30, 40), outer) - rectangle((30, 40), hole)
    expected += rectangle((30, 40), [(25, 5), (30, 9)])
    assert_array_equal(file.frame(0)[0], expected)


@pytest.mark.parametrize("seed", range(5))
def test_the_area_is_that_of_the_polygon(tmp_path: Path, seed: int) -> None:
    rng = np.random.default_rng(seed)
    angle = np.sort(rng.uniform(0, 2 * np.pi, 40))
    radius = 80 + 30 * np.sin(3 * angle) + rng.uniform(-10, 10, 40)
    ring = [
        (float(x), float(y))
        for x, y in zip(*(130 + radius * turn(angle) for turn in (np.cos, np.sin)), strict=True)
    ]
    hole: Ring = [(120.3, 110.7), (150.2, 118.1), (138.4, 149.9)]
    file = open_frames(write_geojson(tmp_path / "a.geojson", feature(ring, hole)))
    area = shapely.Polygon(ring, [hole]).area
    assert (file.frame(0) > 0).sum() == pytest.approx(area, rel=0.005)


def test_an_outline_that_crosses_itself_is_told(tmp_path: Path) -> None:
    eight: Ring = [(5, 5), (25, 25), (25, 5), (5, 25)]
    touching: Ring = [(30, 5), (33, 5), (33, 8), (36, 8), (36, 11), (33, 11), (33, 8), (30, 8)]
    path = write_geojson(tmp_path / "a.geojson", feature(eight, name="eight"), feature(touching))
    file = open_frames(path, choice=LIKE)
    area = shapely.make_valid(shapely.Polygon(eight)).area
    assert (file.frame(0) == 1).sum() == pytest.approx(area, rel=0.06)
    assert "1 of 2 outlines cross themselves (eight)" in notes(file)


def test_outlines_that_overlap_are_told(tmp_path: Path) -> None:
    near: Ring = [(10, 5), (20, 5), (20, 15), (10, 15)]
    within: Ring = [(5, 4), (8, 4), (8, 8), (5, 8)]
    path = write_geojson(
        tmp_path / "a.geojson", feature(SQUARE), feature(near), feature(within, name="inner")
    )
    file = open_frames(path, choice=LIKE)
    labels = file.frame(0)[0]
    assert_array_equal(labels == 1, rectangle((30, 40), SQUARE) == 1)  # the first has the shared pixels
    assert (labels == 2).sum() == 100 - 3 * 7
    assert (labels == 3).sum() == 0
    assert "2 pairs of outlines overlap (most: feature 1 and inner, 100% of the latter)" in notes(file)
    assert "outlines that lie in others give no cell (inner)" in notes(file)


def test_outlines_that_share_a_side_do_not_overlap(tmp_path: Path) -> None:
    beside: Ring = [(13, 2), (23, 2), (23, 12), (13, 12)]
    file = open_frames(write_geojson(tmp_path / "a.geojson", feature(SQUARE), feature(beside)), choice=LIKE)
    assert file.notes == ()
    assert_array_equal(file.frame(0)[0], rectangle((30, 40), SQUARE, beside))


def test_outlines_out_of_the_image_are_told(tmp_path: Path) -> None:
    cut: Ring = [(-5, -5), (4, -5), (4, 4), (-5, 4)]
    away: Ring = [(100, 100), (110, 100), (110, 110)]
    path = write_geojson(
        tmp_path / "a.geojson", feature(cut, name="cut"), feature(away, name="away"), feature(RIGHT)
    )
    file = open_frames(path, choice=LIKE)
    assert "1 outline outside of the image of 30 × 40 pixels left out (away)" in notes(file)
    assert "1 outline cut by the border of the image (cut)" in notes(file)
    assert (file.frame(0) == 1).sum() == 16
    path = write_geojson(tmp_path / "b.geojson", feature(away))
    with pytest.raises(ReadError, match="no outline lies in the image: 1 outline outside"):
        open_frames(path, choice=LIKE)


def test_without_an_image_its_size_is_a_box_and_told(tmp_path: Path) -> None:
    file = open_frames(write_geojson(tmp_path / "a.geojson", feature(RIGHT)))
    assert file.image_shape == (15, 31)  # one pixel more, so that the cell does not touch the border
    assert "size of the image unknown: a box around the outlines; pass the image" in notes(file)
    assert "size of the image unknown" in file.evidence


def test_outlines_without_a_pixel_are_told(tmp_path: Path) -> None:
    small: Ring = [(3.1, 3.1), (3.4, 3.1), (3.4, 3.4)]
    path = write_geojson(tmp_path / "a.geojson", feature(RIGHT), feature(small, name="small"))
    file = open_frames(path, choice=LIKE)
    assert "1 of 2 outlines hold no pixel's centre and give no cell (small): are they in pixels?" in notes(
        file
    )


def test_cells_of_qupath_without_their_annotation(tmp_path: Path) -> None:
    region: Ring = [(0, 0), (40, 0), (40, 30), (0, 30)]
    path = write_geojson(
        tmp_path / "a.geojson", feature(region), *(feature(r, objectType="cell") for r in (SQUARE, RIGHT))
    )
    file = open_frames(path, choice=LIKE)
    assert_array_equal(file.frame(0)[0], rectangle((30, 40), SQUARE, RIGHT))
    assert "1 annotation left out beside 2 cells or detections" in notes(file)


def movie_of_qupath(path: Path) -> Path:
    return write_geojson(path, *(feature(r, plane={"t": t}) for t in (0, 2) for r in (SQUARE, RIGHT)))


def movie_of_imagej(path: Path) -> Path:
    return saved(path, *(polygon(r, t=t) for t in (0, 2) for r in (SQUARE, RIGHT)))


@pytest.mark.parametrize(("make", "name"), [(movie_of_qupath, "a.geojson"), (movie_of_imagej, "a.zip")])
def test_frames_of_outlines_are_frames(tmp_path: Path, make: Any, name: str) -> None:
    path = make(tmp_path / name)
    for choice, frames in ((FileChoice(like=(1, 30, 40)), 3), (FileChoice(like=(5, 30, 40)), 5)):
        file = open_frames(path, choice=choice)
        assert (file.axes, file.n_frames, file.evidence[:6]) == ("TYX", frames, "frames")
        assert np.unique(file.frame(0)).tolist() == [0, 1, 2]
        assert np.unique(file.frame(1)).tolist() == [0]
        assert np.unique(file.frame(2)).tolist() == [0, 3, 4]  # nobody says which is which cell
    short = open_frames(path, choice=FileChoice(like=(2, 30, 40)))
    assert "2 outlines after the last of 2 frames left out" in notes(short)


def test_one_outline_a_frame_is_one_cell(tmp_path: Path) -> None:
    file = open_frames(saved(tmp_path / "a.zip", *(polygon(SQUARE, t=t) for t in range(4))), choice=LIKE)
    assert [int(file.frame(t).max()) for t in range(4)] == [1, 1, 1, 1]
    assert look_at(file).kind == "stack"


def test_slices_without_frames_are_frames_and_told(tmp_path: Path) -> None:
    for name, place in (("a.zip", "z"), ("b.zip", "position")):
        path = saved(tmp_path / name, *(polygon(SQUARE, **{place: number}) for number in range(3)))
        file = open_frames(path, choice=LIKE)
        assert file.n_frames == 3
        assert "slices are taken as frames; if they are those of a z-stack, choose one, as --z 0" in notes(
            file
        )
        one = open_frames(path, choice=FileChoice(like=(1, 30, 40), z="1"))
        assert (one.axes, int(one.frame(0).max())) == ("YX", 1)
        assert "2 outlines of other slices than 1 left out" in notes(one)


def test_slices_and_frames_need_a_choice(tmp_path: Path) -> None:
    path = saved(tmp_path / "a.zip", *(polygon(SQUARE, z=z, t=t) for z in range(2) for t in range(3)))
    with pytest.raises(ReadError, match="outlines in 2 slices of 3 frames: choose a slice, as --z 0"):
        open_frames(path)
    assert open_frames(path, choice=FileChoice(z="1")).n_frames == 3
    with pytest.raises(ReadError, match="no outline in slice 7: its outlines are in slices 0, 1"):
        open_frames(path, choice=FileChoice(z="7"))


def test_an_outline_in_no_frame_of_a_movie_is_told(tmp_path: Path) -> None:
    rois = [polygon(SQUARE, t=0), polygon(SQUARE, t=1), polygon(RIGHT, name="background")]
    file = open_frames(saved(tmp_path / "a.zip", *rois), choice=LIKE)
    assert "1 outline in no frame left out (background)" in notes(file)


def test_pieces_are_cut_as_from_the_whole(tmp_path: Path) -> None:
    near: Ring = [(10, 5), (20, 5), (20, 15), (10, 15)]
    file = open_frames(write_geojson(tmp_path / "a.geojson", feature(SQUARE), feature(near)), choice=LIKE)
    by_piece = pickle.loads(pickle.dumps(file)).stored.by_piece(0)
    assert by_piece is not None
    for rows, columns in (
        (slice(0, 30), slice(0, 40)),
        (slice(4, 9), slice(11, 33)),
        (slice(20, 22), slice(0, 1)),
    ):
        assert_array_equal(by_piece[0](rows, columns), file.frame(0)[:, rows, columns])


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("{", "is no GeoJSON, or is cut short"),
        ("[" * 100_000, "is no GeoJSON, or is cut short"),
        ('{"a": 1}', "is no GeoJSON: it holds dict"),
        ("3", "is no GeoJSON: it holds int"),
        ("[]", "holds no polygon: it is empty"),
        (
            '{"type": "Point", "coordinates": [1, 2]}',
            "holds no polygon: objects without an area left out: 1 × Point",
        ),
        ('{"type": "Polygon", "coordinates": [[[1, 2], [3, NaN], [4, 5]]]}', "no finite numbers"),
        ('{"type": "Polygon", "coordinates": [[["a", 2], [3, 4], [4, 5]]]}', "no finite numbers"),
        ('{"type": "Polygon", "coordinates": [[1, 2, 3]]}', "coordinates that are no points"),
        ('{"type": "Polygon", "coordinates": 5}', "no list of coordinates"),
        ('{"type": "Polygon", "coordinates": [[]]}', "no outline lies in the image|holds no outline"),
        (
            '{"type": "Polygon", "coordinates": [[[0, 0], [1e8, 0], [1e8, 9]]]}',
            "image of .* pixels: is that right",
        ),
        ('{"type": "Polygon", "coordinates": [[[0, 0], [1e300, 0], [9, 9]]]}', "as far as 1e.300 px"),
        (
            '{"type": "Polygon", "plane": {"t": "x"}, "coordinates": [[[0, 0], [5, 0], [9, 9]]]}',
            "whole numbers from 0",
        ),
    ],
)
def test_geojson_that_is_none(tmp_path: Path, text: str, words: str) -> None:
    (tmp_path / "a.geojson").write_text(text)
    with pytest.raises(ReadError, match=words):
        open_frames(tmp_path / "a.geojson")


def test_frames_far_away_are_refused(tmp_path: Path) -> None:
    path = write_geojson(tmp_path / "a.geojson", *(feature(SQUARE, plane={"t": t}) for t in (0, 10**9)))
    with pytest.raises(ReadError, match="2 outlines in 1000000001 frames: is that right"):
        open_frames(path)


def test_zip_files_that_are_no_sets(tmp_path: Path) -> None:
    (tmp_path / "a.zip").write_bytes(b"PK\3\4 no zip")
    with pytest.raises(ReadError, match="is no zip file, or is cut short"):
        open_frames(tmp_path / "a.zip")
    with zipfile.ZipFile(tmp_path / "b.zip", "w") as file:
        file.writestr("a.tif", b"..")
        file.writestr("__MACOSX/._a.roi", b"..")
    with pytest.raises(ReadError, match="holds no ROI"):
        open_frames(tmp_path / "b.zip")
    content = saved(tmp_path / "c.roi", polygon(SQUARE)).read_bytes()
    with zipfile.ZipFile(tmp_path / "d.zip", "w") as file:
        file.writestr("x.roi", content[:70])
    with pytest.raises(ReadError, match=r"ROI x\.roi is damaged"):
        open_frames(tmp_path / "d.zip")


def test_outlines_have_no_axes(tmp_path: Path) -> None:
    path = write_geojson(tmp_path / "a.geojson", feature(SQUARE))
    with pytest.raises(ReadError, match="holds outlines, which have no axes: take the axes out"):
        open_frames(path, choice=FileChoice(axes="TYX"))


def test_a_bare_geometry_and_a_list_are_read(tmp_path: Path) -> None:
    geometry = feature(SQUARE)["geometry"]
    for content in (geometry, [feature(SQUARE)], {"type": "GeometryCollection", "geometries": [geometry]}):
        (tmp_path / "a.json").write_text(json.dumps(content))
        assert_array_equal(
            open_frames(tmp_path / "a.json", choice=LIKE).frame(0)[0], rectangle((30, 40), SQUARE)
        )
