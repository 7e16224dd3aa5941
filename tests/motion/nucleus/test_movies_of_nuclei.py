"""Movies of a cell with its nucleus: maps, places that are followed, frames without a nucleus."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cytodisk import DiskMovie, edge_velocity, map_movie, simulate
from cytodisk.errors import MapError, NucleusError, ParameterError, ReadError
from cytodisk.geometry.locate import nearest_on_outline
from cytodisk.motion.following import map_frames
from cytodisk.motion.frame_file import load_frame, save_frame
from cytodisk.motion.mapped_frame import MappedFrame
from cytodisk.motion.nucleus.cell_and_nucleus import drawn
from cytodisk.motion.nucleus.movie_nuclei import CellsWithNuclei
from cytodisk.motion.tracking_parameters import MovieSettings
from cytodisk.simulate import MovieWithNuclei

FRAMES = 8


@cache
def truth_of(kind: str = "migrating", **settings: Any) -> MovieWithNuclei:
    return simulate.movie_with_nuclei(kind, frames=FRAMES, radius_px=24.0, **settings)  # type: ignore[arg-type]


@cache
def movie_of(kind: str = "migrating", **settings: Any) -> DiskMovie:
    truth = truth_of(kind, **settings)
    return map_movie(truth.masks, nuclei=truth.nuclei)


def turned_since_start(truth: MovieWithNuclei, movie: DiskMovie, frame: int) -> np.ndarray:
    """Degrees by which material points of the nucleus have other angles on the disk than in frame 0."""
    angles = []
    for time in (0, frame):
        disk = movie[time]
        assert disk.nucleus is not None
        assert disk.nucleus_outline_yx is not None
        edge, share = nearest_on_outline(truth.nucleus_yx[time], disk.nucleus_outline_yx)
        ends = np.append(disk.nucleus.boundary_angles, disk.nucleus.boundary_angles[0] + 2.0 * np.pi)
        angles.append(ends[edge] + share * np.diff(ends)[edge])
    return np.degrees(np.angle(np.exp(1j * (angles[1] - angles[0]))))


@pytest.mark.parametrize("kind", ["migrating", "bulging", "growing", "ruffling", "necking"])
def test_every_frame_has_a_valid_map_with_its_nucleus(kind: str) -> None:
    truth, movie = truth_of(kind), movie_of(kind)
    assert movie.mapped.all()
    for frame, disk in enumerate(movie):
        assert disk.certificate.valid
        assert disk.nucleus is not None
        np.testing.assert_array_equal(disk.nucleus.mask, truth.nuclei[frame])
        assert disk.nucleus_radius == 0.5


def test_places_of_the_nuclear_outline_keep_their_angle() -> None:
    away = turned_since_start(truth_of("bulging"), movie_of("bulging"), FRAMES - 1)
    assert np.median(np.abs(away)) < 2.0
    assert np.abs(away).max() < 8.0


def test_a_nucleus_that_turns_in_its_cell_is_followed() -> None:
    truth = truth_of("bulging", nucleus_turn_deg=15.0, nucleus_elongation=1.6)
    movie = movie_of("bulging", nucleus_turn_deg=15.0, nucleus_elongation=1.6)
    away = turned_since_start(truth, movie, FRAMES - 1)  # of 105 degrees
    assert np.abs(np.median(away)) < 10.0
    assert all(disk.certificate.valid for disk in movie)


def test_a_round_nucleus_turns_with_its_cell() -> None:
    cell = simulate.star(arms=5, body_radius=24, arm_length=8)
    size = max(cell.shape)
    cell = np.pad(cell, [(0, size - side) for side in cell.shape])
    y, x = np.mgrid[:size, :size]
    middle = np.argwhere(cell).mean(axis=0)
    nucleus = np.hypot(y - middle[0], x - middle[1]) < 9.0
    masks = []
    for frame in range(4):  # 5 degrees a frame about the middle of the cell
        turn = np.radians(5.0 * frame)
        away = np.stack([y - middle[0], x - middle[1]], axis=-1)
        rows = away[..., 0] * np.cos(turn) - away[..., 1] * np.sin(turn) + middle[0]
        columns = away[..., 0] * np.sin(turn) + away[..., 1] * np.cos(turn) + middle[1]
        rows, columns = (np.clip(np.rint(part), 0, size - 1).astype(int) for part in (rows, columns))
        masks.append(cell[rows, columns])
    frames = list(map_frames(CellsWithNuclei(np.stack(masks), [nucleus] * 4), MovieSettings()))
    last = frames[-1].mapped
    assert last is not None
    assert last.nucleus is not None
    assert abs(np.degrees(last.boundary.transform.angle)) > 10.0
    assert abs(np.degrees(last.nucleus.twist)) < 7.0


def test_the_edge_moves_as_it_does_without_the_nucleus() -> None:
    velocity = edge_velocity(movie_of("growing"), sectors=12)
    plain = edge_velocity(map_movie(truth_of("growing").masks), sectors=12)
    np.testing.assert_allclose(velocity, plain, rtol=1e-6, atol=1e-9)


def test_points_of_the_nuclear_outline_lie_on_it() -> None:
    movie = movie_of("bulging")
    points = movie.nucleus_points_yx
    assert points.shape == (FRAMES, 256, 2)
    for frame, disk in enumerate(movie):
        assert disk.nucleus_outline_yx is not None
        edge, share = nearest_on_outline(points[frame], disk.nucleus_outline_yx)
        ends = np.roll(disk.nucleus_outline_yx, -1, axis=0)[edge]
        nearest = disk.nucleus_outline_yx[edge] * (1 - share[:, None]) + ends * share[:, None]
        np.testing.assert_allclose(points[frame], nearest, atol=1e-6)


def with_gap(truth: MovieWithNuclei, frame: int) -> np.ndarray:
    nuclei = truth.nuclei.copy()
    nuclei[frame] = False
    return nuclei


def test_a_frame_without_a_nucleus_is_a_gap_with_a_reason_and_the_movie_goes_on() -> None:
    truth = truth_of("bulging")
    movie = map_movie(truth.masks, nuclei=with_gap(truth, 3))
    assert movie.status == ["ok"] * 3 + ["refused"] + ["ok"] * 4
    assert "no nucleus in this frame" in movie.records[3].reason
    assert "--missing hold" in movie.records[3].reason
    with pytest.raises(MapError, match="no nucleus"):
        movie[3]
    assert np.isnan(movie.nucleus_points_yx[3]).all()
    away = turned_since_start(truth, movie, FRAMES - 1)
    assert np.abs(away).max() < 8.0


def test_the_first_frame_has_no_nucleus_to_hold_and_held_ones_say_why_alone() -> None:
    truth = truth_of("bulging")
    masks, nuclei = truth.masks[:4], with_gap(truth, 0)[:4]
    middle = int(np.argwhere(nuclei[2])[:, 0].mean())
    nuclei[2, middle - 1 : middle + 2] = False
    assert "hold" not in map_movie(masks, nuclei=nuclei).records[0].reason
    movie = map_movie(masks, nuclei=nuclei, missing="hold")
    assert movie.status == ["refused", "ok", "ok", "ok"]
    assert movie.records[0].reason == (
        "the cell has no nucleus in this frame, and no frame before has a nucleus that could be held: "
        "complete the nuclei, or leave the frame out"
    )
    assert re.fullmatch(r"the cell has 2 nuclei, of \d+ and \d+ px", movie.nucleus_held[2])


def test_a_missing_nucleus_is_held_and_lies_where_it_is() -> None:
    truth = truth_of("migrating")
    nuclei = with_gap(truth, 3)
    nuclei[4] = False
    movie = map_movie(truth.masks, nuclei=nuclei, missing="hold")
    assert movie.mapped.all()
    assert [bool(words) for words in movie.nucleus_held] == [False] * 3 + [True, True] + [False] * 3
    for frame in (3, 4):
        disk = movie[frame]
        assert disk.certificate.valid
        assert disk.nucleus is not None
        shared = (disk.nucleus.mask & truth.nuclei[frame]).sum() / truth.nuclei[frame].sum()
        assert shared > 0.75
        assert disk.nucleus.report.area_px == pytest.approx(truth.nuclei[2].sum(), rel=0.02)


def test_two_nuclei_at_mitosis_are_a_gap_or_held() -> None:
    truth = truth_of("bulging")
    nuclei = truth.nuclei.astype(np.uint8)
    middle = int(np.argwhere(nuclei[4])[:, 1].mean())
    nuclei[4, :, middle - 1 : middle + 2] = 0
    refused = map_movie(truth.masks, nuclei=nuclei)
    assert refused.status[4] == "refused"
    assert "2 nuclei" in refused.records[4].reason
    held = map_movie(truth.masks, nuclei=nuclei, missing="hold")
    assert held.mapped.all()
    assert "2 nuclei" in held.nucleus_held[4]
    joined = map_movie(truth.masks, nuclei=nuclei, several="join")
    assert joined.mapped.all()


def test_the_first_frame_has_nothing_to_hold() -> None:
    truth = truth_of("bulging")
    movie = map_movie(truth.masks, nuclei=with_gap(truth, 0), missing="hold")
    assert movie.status[:2] == ["refused", "ok"]
    assert "no frame before" in movie.records[0].reason
    refused = map_movie(truth.masks, nuclei=with_gap(truth, 0))
    assert refused.status[:2] == ["refused", "ok"]
    assert "hold" not in refused.records[0].reason, "there is no nucleus that could be held"


def test_a_held_nucleus_that_does_not_fit_any_more_is_refused() -> None:
    truth = truth_of("bulging")
    masks, nuclei = truth.masks[:3].copy(), with_gap(truth, 2)[:3]
    columns = np.argwhere(truth.nuclei[2])[:, 1]
    masks[2, :, int(columns.mean()) :] = False  # half of the cell is gone, with half of its nucleus
    movie = map_movie(masks, nuclei=nuclei, missing="hold")
    assert movie.status[2] == "refused"
    assert "cannot be held" in movie.records[2].reason


def test_errors_and_nothing_may_stand_for_nuclei() -> None:
    truth = truth_of("bulging")
    nuclei: list[Any] = list(truth.nuclei[:4])
    nuclei[1], nuclei[2] = ReadError("frame 1 of nuclei.tif is damaged"), None
    movie = map_movie(list(truth.masks[:4]), nuclei=nuclei)
    assert movie.status == ["ok", "unreadable", "refused", "ok"]
    assert "damaged" in movie.records[1].reason


@pytest.mark.parametrize(
    ("change", "error", "words"),
    [
        (lambda nuclei: nuclei[:-1], NucleusError, "frames"),
        (lambda nuclei: nuclei[:, 1:], NucleusError, "shape"),
        (lambda nuclei: nuclei[0], NucleusError, "one frame, the masks 8 frames"),
        (lambda nuclei: 5, NucleusError, "sequence"),
    ],
)
def test_nuclei_that_do_not_go_with_the_masks_are_refused(
    change: Callable[[np.ndarray], Any], error: type[Exception], words: str
) -> None:
    truth = truth_of("bulging")
    with pytest.raises(error, match=words):
        map_movie(truth.masks, nuclei=change(truth.nuclei))


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"interior": "still"}, "--interior area"),
        ({"method": "harmonic"}, "newton"),
        ({"nucleus_radius": 2.0}, "nucleus_radius"),
        ({"missing": "plain"}, "missing"),
    ],
)
def test_what_does_not_go_with_nuclei_is_refused(settings: dict[str, Any], words: str) -> None:
    truth = truth_of("bulging")
    with pytest.raises(ParameterError, match=words):
        map_movie(truth.masks, nuclei=truth.nuclei, **settings)


def test_alignment_by_the_nucleus_needs_one() -> None:
    truth = truth_of("bulging")
    with pytest.raises(ParameterError, match="--nuclei"):
        map_movie(truth.masks, align="nucleus")
    movie = map_movie(truth.masks[:2], nuclei=truth.nuclei[:2], align="nucleus")
    assert movie.mapped.all()


def mapped_frames(truth: MovieWithNuclei, **settings: Any) -> list[MappedFrame]:
    frames = CellsWithNuclei(truth.masks, truth.nuclei)
    found = [result.mapped for result in map_frames(frames, MovieSettings(**settings))]
    assert all(found)
    return found  # type: ignore[return-value]


def test_frames_come_back_from_their_files_and_go_on_as_before(tmp_path: Path) -> None:
    frames = mapped_frames(truth_of("migrating"))
    paths = {frame.frame: tmp_path / f"frame_{frame.frame}.npz" for frame in frames}
    for frame in frames:
        save_frame(paths[frame.frame], frame)
    read = load_frame(paths[6], paths)
    live = frames[6]
    assert read.nucleus is not None
    assert live.nucleus is not None
    np.testing.assert_array_equal(read.nucleus.boundary.s, live.nucleus.boundary.s)
    np.testing.assert_array_equal(read.nucleus.boundary.points_yx, live.nucleus.boundary.points_yx)
    np.testing.assert_array_equal(read.nucleus.reference.points_yx, live.nucleus.reference.points_yx)
    assert read.nucleus.boundary.transform == live.nucleus.boundary.transform
    assert (read.nucleus.twist, read.nucleus.held) == (live.nucleus.twist, live.nucleus.held)


def test_a_nucleus_that_turns_on_and_on_does_not_wind_the_cytoplasm_up() -> None:
    truth = simulate.movie_with_nuclei(
        "bulging", frames=24, radius_px=24.0, nucleus_turn_deg=20.0, nucleus_elongation=1.8
    )
    frames = mapped_frames(truth)
    twists = np.degrees([frame.nucleus.twist for frame in frames if frame.nucleus])
    assert np.abs(twists).max() < 270.0
    assert sum(frame.nucleus.unwound for frame in frames if frame.nucleus) == 1
    assert all(frame.disk.certificate.valid for frame in frames)


def test_a_drawn_nucleus_has_the_area_that_is_asked_for() -> None:
    angles = np.linspace(0.0, 2 * np.pi, 80, endpoint=False)
    outline = 20.3 + 8.0 * np.column_stack([np.sin(angles), np.cos(angles)])
    assert drawn(outline, 200, (40, 40)).box.sum() == 200
    cut = drawn(outline - [20.3, 0.0], 200, (40, 40))
    assert 90 < cut.box.sum() < 130
    assert cut.whole.shape == (40, 40)
    assert not drawn(outline - [60.0, 0.0], 200, (40, 40)).box.any()
