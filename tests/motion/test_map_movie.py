import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from curves import circle, lobed, masks_of, moved

from cytodisk import DiskMovie, map_movie, map_to_disk, simulate
from cytodisk.errors import MapError, MaskError, ParameterError, ReadError, StudyError
from cytodisk.motion.following import map_frames
from cytodisk.motion.mapped_frame import MovieSettings
from cytodisk.simulate import SimulatedMovie

QUICK = {"method": "harmonic", "edge_length": 4.0}
Mapped = Callable[..., tuple[SimulatedMovie, DiskMovie]]


@pytest.fixture(scope="module")
def masks() -> np.ndarray:
    """Six frames of a small moving cell; the third and the fifth are empty."""
    outlines = [moved(lobed(15.0), 2.0 * time, (0.5 * time - 30.0, -30.0)) for time in range(6)]
    drawn = masks_of(outlines, (64, 60))
    drawn[[2, 4]] = False
    return drawn


@pytest.fixture(scope="module")
def gappy(masks: np.ndarray) -> DiskMovie:
    return map_movie(masks)


def assert_same(one: DiskMovie, other: DiskMovie) -> None:
    assert one.status == other.status
    np.testing.assert_array_equal(one.points_yx, other.points_yx)
    assert one.transforms == other.transforms
    for time in np.flatnonzero(one.mapped):
        for name in ("vertices_yx", "vertices_uv", "triangles", "boundary", "mask"):
            np.testing.assert_array_equal(getattr(one[time], name), getattr(other[time], name))
        assert one[time].report == other[time].report
        assert one[time].start == other[time].start


@pytest.mark.parametrize("kind", ["bulging", "spiky", "neutrophil", "necking", "dropping"])
def test_every_frame_has_a_valid_certificate(mapped: Mapped, kind: str) -> None:
    shown, movie = mapped(kind, 12)
    np.testing.assert_array_equal(movie.mapped, shown.present)
    for time in np.flatnonzero(movie.mapped):
        assert movie[time].certificate.valid, movie[time].certificate.faults
        assert movie[time].converged
        np.testing.assert_array_equal(movie[time].mask, shown.masks[time])


@pytest.mark.parametrize("kind", ["bulging", "neutrophil"])
def test_the_inside_goes_on_from_the_last_frame(mapped: Mapped, kind: str) -> None:
    movie = mapped(kind, 12)[1]
    assert {disk.start for disk in movie[1:]} == {"previous"}
    assert movie[0].start != "previous"


def test_the_first_frame_is_mapped_like_a_single_image(masks: np.ndarray, gappy: DiskMovie) -> None:
    alone = map_to_disk(masks[0])
    np.testing.assert_allclose(gappy[0].vertices_uv, alone.vertices_uv, atol=1e-9)
    turned = map_movie(masks, align=90.0, **QUICK)
    expected = map_to_disk(masks[0], align=90.0, **QUICK)
    np.testing.assert_allclose(turned[0].vertices_uv, expected.vertices_uv, atol=1e-9)


def test_gaps_have_their_reason_and_the_movie_goes_on(gappy: DiskMovie) -> None:
    assert gappy.status == ["ok", "ok", "refused", "ok", "refused", "ok"]
    assert all("is empty" in gappy.records[time].reason for time in (2, 4))
    assert all(gappy.records[time].reason == "" for time in (0, 1, 3, 5))
    assert all(record.boundary is None or not record.boundary.restarted for record in gappy.records)
    for time in (2, 4, -2):
        with pytest.raises(MapError, match=rf"frame {time % 6} has no map: .*empty"):
            gappy[time]
    assert gappy.transforms[2] is None
    for time in (3, 5):
        transform = gappy.transforms[time]
        assert transform is not None
        assert -3.0 * time < np.degrees(transform.angle) < -0.5 * time
        assert gappy[time].start == "previous"
    for table in (gappy.points_yx, gappy.normals_yx, gappy.lengths_px, gappy.residual_px):
        lost = np.isnan(table.reshape(6, -1))
        np.testing.assert_array_equal(lost.all(axis=1), [False, False, True, False, True, False])
        np.testing.assert_array_equal(lost.any(axis=1), lost.all(axis=1))
    assert not gappy.on_border.any()


def test_a_movie_is_indexed_like_a_list(gappy: DiskMovie) -> None:
    assert len(gappy) == 6
    assert gappy[-1] is gappy[5]
    assert gappy[np.int64(3)] is gappy[3]
    assert gappy[:2] == [gappy[0], gappy[1]]
    assert gappy[5:2:-2] == [gappy[5], gappy[3]]
    assert gappy[3:3] == []
    for time in (6, -7, 100):
        with pytest.raises(IndexError, match=f"frame {time} of a movie of 6 frames"):
            gappy[time]
    with pytest.raises(ParameterError, match="indexed by frame number, got 'first'"):
        gappy["first"]  # type: ignore[call-overload]
    with pytest.raises(MapError):
        gappy[:3]


def test_tables_of_points_have_their_shapes(gappy: DiskMovie) -> None:
    n = gappy.n_points
    assert n == 256
    assert gappy.points_yx.shape == gappy.normals_yx.shape == (6, n, 2)
    assert gappy.lengths_px.shape == gappy.on_border.shape == (6, n)
    assert gappy.residual_px.shape == (6,)
    assert repr(gappy) == "<DiskMovie: 4 of 6 frames mapped, 256 boundary points>"


def test_a_folder_holds_the_same_maps_bit_for_bit(
    masks: np.ndarray, gappy: DiskMovie, tmp_path: Path
) -> None:
    folder = tmp_path / "deep" / "maps"
    stored = map_movie(masks, folder=folder)
    assert_same(stored, gappy)
    assert sorted(path.name for path in folder.iterdir()) == [f"frame_0000{t}.npz" for t in (0, 1, 3, 5)]
    with pytest.raises(StudyError, match="holds maps already: pass another folder"):
        map_movie(masks, folder=folder, **QUICK)


def test_a_folder_that_is_a_file_is_refused(masks: np.ndarray, tmp_path: Path) -> None:
    (tmp_path / "maps").write_text("here")
    with pytest.raises(StudyError, match=r"cannot write .*maps.*: Not a directory"):
        map_movie(masks, folder=tmp_path / "maps", **QUICK)


@pytest.mark.parametrize("as_given", [list, tuple, np.uint8, np.float32, lambda masks: 7 * masks.astype(int)])
def test_masks_come_in_many_types(masks: np.ndarray, as_given: Callable[[np.ndarray], object]) -> None:
    assert_same(map_movie(as_given(masks), **QUICK), map_movie(masks, **QUICK))


def test_a_sequence_reads_its_frames_one_by_one(masks: np.ndarray) -> None:
    class Reader:
        def __init__(self) -> None:
            self.read: list[int] = []

        def __len__(self) -> int:
            return len(masks)

        def __getitem__(self, time: int) -> np.ndarray:
            frame = masks[time]
            self.read.append(time)
            return frame

    reader = Reader()
    done: list[tuple[int, int]] = []
    movie = map_movie(reader, progress=lambda n, total: done.append((n, total)), **QUICK)
    assert_same(movie, map_movie(masks, **QUICK))
    assert reader.read == list(range(6))
    assert done == [(n, 6) for n in range(1, 7)]


def test_a_data_array_brings_its_scale_in_any_order_of_dims(masks: np.ndarray) -> None:
    attrs = {"pixel_size_um": 0.2, "frame_interval_s": 5}
    given = xr.DataArray(masks, dims=("time", "y", "x"), attrs=attrs).transpose("x", "time", "y")
    movie = map_movie(given, **QUICK)
    assert (movie.scale.pixel_size_um, movie.scale.frame_interval_s) == (0.2, 5.0)
    assert_same(movie, map_movie(masks, **QUICK))
    told = map_movie(given, pixel_size_um=0.3, frame_interval_s=2.0, **QUICK)
    assert (told.scale.pixel_size_um, told.scale.frame_interval_s) == (0.3, 2.0)
    unknown = map_movie(masks, **QUICK)
    assert (unknown.scale.pixel_size_um, unknown.scale.frame_interval_s) == (None, None)


ONE = simulate.disk(6.0)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (ONE[None], "hold 1 frame: a movie has two at least"),
        ([ONE], "hold 1 frame"),
        ([], "hold 0 frame"),
        (ONE, r"shape \(29, 29\): a movie of one cell is \(time, y, x\)"),
        (np.zeros((2, 3, 29, 29), dtype=bool), r"shape \(2, 3, 29, 29\)"),
        (5, "got int"),
        (None, "got NoneType"),
        ([ONE, ONE[1:]], r"differ in shape \(\[\(28, 29\), \(29, 29\)\]\)"),
        (np.zeros((100, 100, 12), dtype=bool), "looks like time on the last axis"),
        (xr.DataArray(np.stack([ONE, ONE]), dims=("z", "y", "x")), "dims .*'z'"),
        (xr.DataArray(ONE, dims=("y", "x")), "dims"),
        (xr.DataArray(np.zeros((2, 2, 9, 9)), dims=("time", "channel", "y", "x")), "dims .*'channel'"),
    ],
)
def test_what_is_no_movie_is_refused(given: object, message: str) -> None:
    with pytest.raises(MaskError, match=message):
        map_movie(given)


def test_a_movie_without_a_cell_is_refused() -> None:
    with pytest.raises(MaskError, match=r"no frame of 4.*empty"):
        map_movie(np.zeros((4, 20, 20), dtype=bool))


@pytest.mark.parametrize("name", ["frame_interval_s", "pixel_size_um"])
@pytest.mark.parametrize("value", [0, -1.0, np.inf, np.nan, "fast", True])
def test_a_scale_is_a_number_that_can_be(masks: np.ndarray, name: str, value: object) -> None:
    message = f"{name} must be a number from 0.000001 to 1000000, got {re.escape(repr(value))}"
    with pytest.raises(ParameterError, match=message):
        map_movie(masks, **{name: value})
    with pytest.raises(ParameterError, match=message):
        map_movie(xr.DataArray(masks, dims=("time", "y", "x"), attrs={name: value}))


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("tracker", "snakes"),
        ("tension", 2.0),
        ("renew_every", 0),
        ("align", "left"),
        ("method", "magic"),
        ("shape_weight", 0.0),
        ("edge_length", 0.1),
        ("inertia", -1.0),
        ("inertia", np.nan),
    ],
)
def test_bad_parameters_are_refused(masks: np.ndarray, name: str, value: object) -> None:
    with pytest.raises(ParameterError, match=f"{name} must be .*got {re.escape(repr(value))}"):
        map_movie(masks, **({"edge_length": 4.0} | {name: value}))


def test_a_frame_in_two_pieces_is_mapped_and_says_so(masks: np.ndarray) -> None:
    spoilt = masks.copy()
    spoilt[1, 2:5, 2:5] = True
    movie = map_movie(spoilt, **QUICK)
    assert movie.status[1] == "ok"
    assert movie[1].report.components == 2
    assert any("1 fragment dropped (9 px" in note for note in movie[1].report.notes)
    assert movie[0].report.notes == ()
    np.testing.assert_array_equal(movie.points_yx, map_movie(masks, **QUICK).points_yx)


def test_frames_that_are_no_masks_are_refused_one_by_one(masks: np.ndarray) -> None:
    floats = masks.astype(np.float64)
    floats[1] *= 0.7
    floats[1][floats[1] == 0.0] = 0.3
    floats[5, 30, 30] = np.nan
    movie = map_movie(floats, **QUICK)
    assert movie.status == ["ok", "refused", "refused", "ok", "refused", "refused"]
    assert "values other than 0 and 1" in movie.records[1].reason
    assert "NaN" in movie.records[5].reason
    labels = masks.astype(int)
    labels[3, :2, :2] = 2
    assert "2 labels" in map_movie(labels, **QUICK).records[3].reason


def test_errors_among_the_frames_become_their_reasons(masks: np.ndarray) -> None:
    frames = [*masks[:2], ReadError("frame 2 is damaged"), masks[3]]
    results = list(map_frames(frames, MovieSettings(method="harmonic", edge_length=4.0)))
    assert [result.record.status for result in results] == ["ok", "ok", "unreadable", "ok"]
    assert results[2].record.reason == "frame 2 is damaged"
    movie = map_movie(frames, **QUICK)
    assert movie.status == ["ok", "ok", "unreadable", "ok"]


def test_movies_may_start_and_end_with_a_gap(masks: np.ndarray) -> None:
    movie = map_movie(masks[2:5], **QUICK)
    assert movie.status == ["refused", "ok", "refused"]
    transform = movie.transforms[1]
    assert transform is not None
    assert transform.angle == 0.0


def test_a_cell_that_becomes_another_starts_anew_and_goes_on() -> None:
    drawn = masks_of([circle(6.0), circle(40.0), circle(40.5)], (121, 121))
    movie = map_movie(drawn, **QUICK)
    boundaries = [record.boundary for record in movie.records]
    assert [bool(boundary and boundary.restarted) for boundary in boundaries] == [False, True, False]
    assert all(disk.certificate.valid for disk in movie)


@pytest.mark.parametrize("tracker", ["matching", "demons"])
def test_both_trackers_give_valid_maps_and_the_same_twice(masks: np.ndarray, tracker: str) -> None:
    one, two = (map_movie(masks[:2], tracker=tracker, **QUICK) for _ in range(2))
    assert_same(one, two)
    assert all(disk.certificate.valid for disk in one)


def test_inertia_keeps_the_inside_where_it_was() -> None:
    shown = simulate.movie("bulging", 2, frames=8, radius_px=25.0, signals=False)
    grid = np.stack(np.meshgrid(np.linspace(-0.6, 0.6, 9), np.linspace(-0.6, 0.6, 9)), axis=-1).reshape(-1, 2)
    moves = []
    for inertia in (0.0, 1.0, 100.0):
        places = np.stack([disk.to_cell(grid) for disk in map_movie(shown.masks, inertia=inertia)])
        moves.append(float(np.linalg.norm(np.diff(places, axis=0), axis=-1).mean()))
    assert moves[0] > moves[1] > moves[2]
