"""Where tracking starts anew, where cells are cut off, and movies that are read frame by frame."""

from collections.abc import Iterator

import numpy as np
import pytest

import cytodisk as cd
from cytodisk.motion.map_movie import map_movie
from cytodisk.motion.velocity import edge_velocity

QUICK = {"edge_length": 3.0, "method": "harmonic"}


def drop(tip_degrees: float, shape: tuple[int, int] = (120, 120)) -> np.ndarray:
    """A disk with one long tip, so that its direction is seen."""
    y, x = np.indices(shape) - 60.0
    angle = np.arctan2(y, x) - np.radians(tip_degrees)
    return np.hypot(y, x) <= 24.0 + 20.0 * np.exp(-((np.angle(np.exp(1j * angle)) / 0.35) ** 2))


@pytest.fixture
def interrupted() -> list[np.ndarray]:
    """A cell that stays, with a frame in which the mask is a speck elsewhere."""
    speck = np.zeros((120, 120), bool)
    speck[4:9, 4:9] = True
    frames = [drop(40.0) for _ in range(9)]
    frames[4] = speck
    return frames


@pytest.mark.parametrize("align", ["upright", 90.0])
def test_the_disk_keeps_its_rotation_over_a_restart(interrupted: list[np.ndarray], align: object) -> None:
    movie = map_movie(interrupted, align=align, **QUICK)
    restarted = [record.boundary.restarted for record in movie.records if record.boundary]
    assert [bool(why) for why in restarted] == [False] * 4 + [True, True] + [False] * 3
    tip = np.array([[60.0 + 40.0 * np.sin(np.radians(40.0)), 60.0 + 40.0 * np.cos(np.radians(40.0))]])
    angles = [
        float(np.degrees(np.arctan2(*movie[time].to_disk(tip, outside="nearest")[0, ::-1])))
        for time in (0, 3, 5, 8)
    ]
    np.testing.assert_allclose(angles, angles[0], atol=20.0)


def test_after_a_restart_rotation_is_followed_again() -> None:
    frames = [drop(4.0 * time) for time in range(14)]
    frames[5] = np.zeros((120, 120), bool)
    frames[5][4:9, 4:9] = True
    movie = map_movie(frames, **QUICK)
    angles = np.degrees([movie.transforms[time].angle for time in range(14)])
    assert angles[13] - angles[6] == pytest.approx(-28.0, abs=3.0)


def test_windows_before_and_after_a_restart_are_not_compared(interrupted: list[np.ndarray]) -> None:
    movie = map_movie(interrupted, **QUICK)
    activity = cd.sample_movie(movie, cd.polar_windows(2, 8), np.ones((9, 120, 120)))
    moved = cd.centroid_displacement(movie, activity).mean(("layer", "sector"))
    assert np.isnan(moved[[3, 4, 8]]).all()
    assert np.isfinite(np.delete(moved.to_numpy(), [3, 4, 8])).all()


@pytest.mark.parametrize(("row", "cut"), [(0, True), (1, False), (2, False)])
def test_only_what_the_image_cuts_off_has_no_velocity(row: int, cut: bool) -> None:
    masks = np.zeros((3, 60, 60), bool)
    masks[:, row : row + 30, 12:42] = True
    velocity = edge_velocity(map_movie(masks, **QUICK), 24)[:-1]
    assert bool(np.isnan(velocity).any()) is cut
    assert bool(np.isfinite(velocity).any())


def test_a_cell_too_small_for_demons_starts_anew_and_says_why() -> None:
    masks = np.zeros((3, 20, 20), bool)
    masks[:, 8:10, 8:10] = True
    movie = map_movie(masks, tracker="demons")
    assert all(movie.mapped)
    second = movie.records[1].boundary
    assert second is not None
    assert "demons cannot follow" in second.restarted


class Reader:
    """Frames that are read when asked for, by number, without an end of their own."""

    def __init__(self, frames: list[np.ndarray]):
        self._frames = frames

    def __len__(self) -> int:
        return len(self._frames)

    def __getitem__(self, time: int) -> np.ndarray:
        return self._frames[time % len(self._frames)]


def test_a_reader_is_read_to_its_end_and_no_further() -> None:
    assert len(map_movie(Reader([drop(0.0)] * 3), **QUICK)) == 3


def test_an_iterator_is_no_movie() -> None:
    def frames() -> Iterator[np.ndarray]:
        yield drop(0.0)

    with pytest.raises(cd.errors.MaskError, match="masks must be an array"):
        map_movie(frames())


def test_parameters_of_demons_reach_it() -> None:
    frames = [drop(0.0), np.roll(drop(0.0), 2, axis=1)]
    found = [
        map_movie(frames, tracker="demons", registration=False, demons=demons, **QUICK).points_yx[1]
        for demons in (None, cd.DemonsParameters(), cd.DemonsParameters(redistribute=False))
    ]
    np.testing.assert_array_equal(found[0], found[1])
    assert np.abs(found[1] - found[2]).max() > 0.1
