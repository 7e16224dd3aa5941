from dataclasses import dataclass

import numpy as np
import pytest

from cytodisk import simulate
from cytodisk.disk.certificate import Certificate, certify
from cytodisk.disk.mapping import map_to_disk


@dataclass
class Arrays:
    """The arrays of a valid map, to be broken."""

    yx: np.ndarray
    uv: np.ndarray
    triangles: np.ndarray
    boundary: np.ndarray

    def certify(self) -> Certificate:
        return certify(self.yx, self.uv, self.triangles, self.boundary)


@pytest.fixture
def valid() -> Arrays:
    disk = map_to_disk(simulate.random_smooth(5, radius=15.0))
    return Arrays(
        disk.vertices_yx.copy(), disk.vertices_uv.copy(), disk.triangles.copy(), disk.boundary.copy()
    )


def says(certificate: Certificate, words: str) -> bool:
    return any(words in fault for fault in certificate.faults)


def test_a_valid_map_has_no_fault(valid: Arrays) -> None:
    certificate = valid.certify()
    assert certificate.valid
    assert certificate.faults == ()
    assert certificate.n_triangles == len(valid.triangles)
    assert certificate.euler_characteristic == 1


def test_it_sees_a_triangle_that_is_turned_over_in_the_disk(valid: Arrays) -> None:
    inner = int(valid.triangles.max())
    valid.uv[inner] = [0.99, 0.0] if valid.uv[inner, 0] < 0 else [-0.99, 0.0]
    certificate = valid.certify()
    assert not certificate.valid
    assert certificate.flipped_in_disk
    assert not certificate.flipped_in_cell
    assert says(certificate, "not positive in the disk")
    around = np.flatnonzero((valid.triangles == inner).any(axis=1))
    assert set(certificate.flipped_in_disk) <= set(around.tolist())


def test_it_sees_a_triangle_that_is_turned_over_in_the_cell(valid: Arrays) -> None:
    valid.yx[int(valid.triangles.max())] += 100.0
    certificate = valid.certify()
    assert says(certificate, "not positive in the cell")


def test_it_sees_a_triangle_without_area(valid: Arrays) -> None:
    a, b, _ = valid.triangles[np.flatnonzero((valid.triangles >= len(valid.boundary)).all(axis=1))[0]]
    valid.uv[a] = valid.uv[b]
    assert says(valid.certify(), "not positive in the disk")


def test_it_sees_nan(valid: Arrays) -> None:
    valid.uv[-1] = np.nan
    assert says(valid.certify(), "a vertex is not finite")


def test_it_sees_a_triangle_with_reversed_corners(valid: Arrays) -> None:
    valid.triangles[7] = valid.triangles[7, ::-1].copy()
    certificate = valid.certify()
    assert certificate.flipped_in_cell == certificate.flipped_in_disk == (7,)


def test_it_sees_boundary_vertices_out_of_order(valid: Arrays) -> None:
    valid.boundary[[3, 4]] = valid.boundary[[4, 3]]
    certificate = valid.certify()
    assert says(certificate, "not the one loop")
    assert says(certificate, "do not increase strictly")


def test_it_sees_a_missing_boundary_vertex(valid: Arrays) -> None:
    valid.boundary = np.delete(valid.boundary, 5)
    assert says(valid.certify(), "not the one loop")


def test_it_sees_a_boundary_vertex_off_the_circle(valid: Arrays) -> None:
    valid.uv[valid.boundary[2]] *= 1.0 - 1e-9
    assert says(valid.certify(), "not on the unit circle")


def test_it_sees_a_boundary_that_runs_round_twice(valid: Arrays) -> None:
    angle = 2.0 * np.unwrap(np.arctan2(*valid.uv[valid.boundary].T[::-1]))
    valid.uv[valid.boundary] = np.column_stack([np.cos(angle), np.sin(angle)])
    assert says(valid.certify(), "do not increase strictly through one turn")


def test_it_sees_a_hole(valid: Arrays) -> None:
    inside = np.flatnonzero((valid.triangles >= len(valid.boundary)).all(axis=1))
    valid.triangles = np.delete(valid.triangles, inside[len(inside) // 2], axis=0)
    certificate = valid.certify()
    assert certificate.euler_characteristic == 0
    assert says(certificate, "Euler characteristic is 0, not 1")
    assert says(certificate, "not the one loop")


def test_it_sees_a_vertex_without_a_triangle(valid: Arrays) -> None:
    valid.yx = np.concatenate([valid.yx, [[3.0, 3.0]]])
    valid.uv = np.concatenate([valid.uv, [[0.0, 0.0]]])
    assert says(valid.certify(), "a vertex belongs to no triangle")


def test_it_sees_a_boundary_that_crosses_itself_though_every_triangle_is_positive() -> None:
    # A band of triangles that winds once and a half around a centre, so that it overlaps itself.
    turns = np.linspace(0.0, 3.0 * np.pi, 40)
    ring = np.concatenate(
        [r * np.column_stack([np.sin(turns), np.cos(turns)]) for r in (2.0, 1.0)]
    )  # outer, then inner
    step = np.arange(39)
    triangles = np.concatenate(
        [np.column_stack([step, step + 1, step + 41]), np.column_stack([step, step + 41, step + 40])]
    )
    boundary = np.concatenate([np.arange(40), np.arange(79, 39, -1)])
    angle = 2.0 * np.pi * np.arange(80) / 80
    uv = np.empty((80, 2))
    uv[boundary] = np.column_stack([np.cos(angle), np.sin(angle)])
    certificate = certify(ring, uv, triangles, boundary)
    assert certificate.faults == ("the boundary crosses itself in the cell",)
    assert certificate.euler_characteristic == 1


def test_two_disks_that_touch_in_a_vertex_are_not_one() -> None:
    yx = np.array([[0.0, 0.0], [-1.0, 2.0], [1.0, 2.0], [1.0, -2.0], [-1.0, -2.0]])
    triangles = np.array([[0, 1, 2], [0, 3, 4]])
    angle = 2.0 * np.pi * np.arange(5) / 5
    uv = np.column_stack([np.cos(angle), np.sin(angle)])
    assert not certify(yx, uv, triangles, np.arange(5)).valid


def test_it_says_what_is_malformed(valid: Arrays) -> None:
    triangles, boundary = valid.triangles.copy(), valid.boundary.copy()
    valid.boundary = boundary[:2]
    assert says(valid.certify(), "2 boundary vertices")
    valid.boundary = boundary
    valid.triangles = triangles.copy()
    valid.triangles[0, 0] = -1
    assert says(valid.certify(), "name a vertex that does not exist")


def test_it_sees_a_ring_that_is_covered_twice_though_every_triangle_is_positive() -> None:
    n = 12
    angle, onwards = 2.0 * np.pi * np.arange(n) / n, np.roll(np.arange(n), -1)
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    rim, outer, inner, centre, second = 0, n, 2 * n, 3 * n, 3 * n + 1  # first vertex of each ring

    def band(a: int, b: int) -> np.ndarray:
        one = np.column_stack([a + np.arange(n), a + onwards, b + np.arange(n)])
        other = np.column_stack([a + onwards, b + onwards, b + np.arange(n)])
        return np.concatenate([one, other])

    fan = np.column_stack([inner + np.arange(n), inner + onwards, np.full(n, centre)])
    once = np.concatenate([band(rim, outer), band(outer, inner), fan])
    uv = np.concatenate([circle, 0.75 * circle, 0.25 * circle, np.zeros((1, 2)), 0.5 * circle])
    boundary = np.arange(n)
    assert certify(uv[:second, ::-1], uv[:second], once, boundary).valid
    twice = np.concatenate([once, band(outer, second), band(second, inner)])
    assert certify(uv[:, ::-1], uv, twice, boundary).faults == (
        "two triangles are on the same side of an edge",
    )
