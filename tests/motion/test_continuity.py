from collections.abc import Callable

import numpy as np
import pytest

from cytodisk import DiskMovie, polar_windows
from cytodisk.analysis.consistency import displacement_between
from cytodisk.geometry.locate import nearest_on_outline
from cytodisk.simulate import SimulatedMovie

Mapped = Callable[..., tuple[SimulatedMovie, DiskMovie]]


def turned_by(movie: DiskMovie, time: int) -> np.ndarray:
    """Angle on the disk of each tracked point by the map, against the one it is to have, in radians."""
    disk = movie[time]
    boundary = movie.records[time].boundary
    assert boundary is not None
    edge, share = nearest_on_outline(boundary.contour.outline_at(boundary.s), disk.outline_yx)
    angles = disk.boundary_angles
    steps = np.diff(angles, append=angles[0] + 2.0 * np.pi)
    return np.angle(np.exp(1j * (angles[edge] + share * steps[edge] - movie.point_angles)))


@pytest.mark.parametrize("frames", [15])
def test_windows_of_a_still_cell_stay(mapped: Mapped, frames: int) -> None:
    movie = mapped("still", frames)[1]
    grid = polar_windows(10, 60)
    centroids = movie.registered(np.stack([grid.on(disk).centroids_yx for disk in movie]))
    steps = displacement_between(centroids)[:-1]
    assert steps.shape == (frames - 1, 10, 60)
    assert steps.mean() < 1.0
    assert steps.mean(axis=(1, 2)).max() < 1.5


@pytest.mark.parametrize(
    ("kind", "frames"), [("still", 15), ("bulging", 12), ("neutrophil", 12), ("spiky", 12)]
)
def test_no_disk_turns_against_the_one_before(mapped: Mapped, kind: str, frames: int) -> None:
    movie = mapped(kind, frames)[1]
    for time in range(frames):
        off = np.degrees(turned_by(movie, time))
        assert abs(off.mean()) < 0.2
        assert np.abs(off).max() < 2.0


@pytest.mark.parametrize(("kind", "frames"), [("still", 15), ("bulging", 12)])
def test_the_inside_keeps_its_place_in_the_disk(mapped: Mapped, kind: str, frames: int) -> None:
    shown, movie = mapped(kind, frames)
    uv = np.stack([disk.to_disk(shown.interior_yx[time]) for time, disk in enumerate(movie)])
    steps = np.linalg.norm(np.diff(uv, axis=0), axis=-1)
    assert np.nanmean(steps) < 0.04
    angle = np.angle(
        np.nanmean((uv[..., 0] + 1j * uv[..., 1])[1:] * np.conj(uv[..., 0] + 1j * uv[..., 1])[:-1])
    )
    assert abs(np.degrees(angle)) < 1.0
