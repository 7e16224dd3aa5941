"""Each way in which a map with a nucleus can be no bijection is told."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from cytodisk.disk.certificate import Certificate
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.mapping import map_to_disk
from cytodisk.disk.nucleus.nucleus import Nucleus
from cytodisk.disk.nucleus.nucleus_certificate import certify_compartments
from cytodisk.simulate import cell_with_nucleus


@pytest.fixture(scope="module")
def disk() -> DiskMap:
    cell = cell_with_nucleus("off centre", 1, shape="spread", radius_px=20.0)
    return map_to_disk(cell.mask, nucleus=cell.nucleus, edge_length=1.5)


def nucleus_of(disk: DiskMap) -> Nucleus:
    assert disk.nucleus is not None
    return disk.nucleus


def certified(disk: DiskMap, **changed: Any) -> Certificate:
    names = ("vertices_yx", "vertices_uv", "triangles", "boundary", "nucleus")
    return certify_compartments(**{name: getattr(disk, name) for name in names} | changed)


def told(certificate: Certificate, words: str) -> bool:
    return not certificate.valid and any(words in fault for fault in certificate.faults)


def changed(array: Any, at: Any, value: Any) -> Any:
    new = array.copy()
    new[at] = value
    return new


def of_cytoplasm(disk: DiskMap) -> int:
    """A vertex between the outlines."""
    ring = np.unique(disk.triangles[~nucleus_of(disk).inside])
    outlines = np.concatenate([disk.boundary, nucleus_of(disk).boundary])
    return int(np.setdiff1d(ring, outlines)[5])


def of_nucleus(disk: DiskMap) -> int:
    """A vertex inside the nuclear outline."""
    held = np.unique(disk.triangles[nucleus_of(disk).inside])
    return int(np.setdiff1d(held, nucleus_of(disk).boundary)[3])


def test_a_map_that_was_made_has_no_fault(disk: DiskMap) -> None:
    found = certified(disk)
    assert found == disk.certificate
    assert found.valid
    assert (found.n_triangles, found.euler_characteristic) == (len(disk.triangles), 1)


def test_whole_turns_of_all_corners_of_a_triangle_are_the_same_map(disk: DiskMap) -> None:
    nucleus = nucleus_of(disk)
    one = int(np.flatnonzero(~nucleus.inside)[4])
    assert certified(
        disk, nucleus=replace(nucleus, lifts=changed(nucleus.lifts, one, nucleus.lifts[one] - 1))
    ).valid


def test_a_triangle_that_is_turned_over(disk: DiskMap) -> None:
    nucleus, turned = nucleus_of(disk), disk.triangles[7, ::-1]
    lifts = changed(nucleus.lifts, 7, nucleus.lifts[7, ::-1])
    found = certified(
        disk, triangles=changed(disk.triangles, 7, turned), nucleus=replace(nucleus, lifts=lifts)
    )
    assert told(found, "1 triangle is not positive in the cell")
    assert found.flipped_in_cell == found.flipped_in_disk == (7,)


def test_a_vertex_elsewhere_in_the_cell(disk: DiskMap) -> None:
    for vertex in (of_cytoplasm(disk), of_nucleus(disk), nucleus_of(disk).boundary[4]):
        found = certified(disk, vertices_yx=changed(disk.vertices_yx, vertex, disk.vertices_yx[vertex] + 9.0))
        assert told(found, "not positive in the cell")


def test_a_vertex_elsewhere_in_the_disk(disk: DiskMap) -> None:
    nucleus = nucleus_of(disk)
    for vertex, away in ((of_cytoplasm(disk), (0.3, 0.2)), (of_nucleus(disk), (0.9, 0.7))):
        moved = replace(nucleus, places=changed(nucleus.places, vertex, nucleus.places[vertex] + away))
        found = certified(disk, nucleus=moved)
        assert told(found, "not positive in the disk")
        assert told(found, "not where their places in the compartments put them")
        found = certified(
            disk, vertices_uv=changed(disk.vertices_uv, vertex, disk.vertices_uv[vertex] + 1e-9)
        )
        assert told(found, "not where their places in the compartments put them")


def test_a_vertex_that_is_turned_by_a_whole_turn(disk: DiskMap) -> None:
    nucleus, vertex = nucleus_of(disk), of_cytoplasm(disk)
    wound = replace(nucleus, places=changed(nucleus.places, (vertex, 1), nucleus.places[vertex, 1] + 1.0))
    assert told(certified(disk, nucleus=wound), "not positive in the disk")


def test_a_corner_that_is_lifted_by_a_turn_too_many(disk: DiskMap) -> None:
    nucleus = nucleus_of(disk)
    for one in np.flatnonzero(~nucleus.inside)[::40]:
        for corner in range(3):
            lifted = changed(nucleus.lifts, (one, corner), nucleus.lifts[one, corner] + 1)
            found = certified(disk, nucleus=replace(nucleus, lifts=lifted))
            assert not found.valid
            assert told(found, "do not agree along an edge") or told(found, "through one turn")


BROKEN: dict[str, tuple[Callable[[Nucleus], Nucleus], str]] = {
    "two vertices of the outline swapped": (
        lambda n: replace(n, boundary=changed(n.boundary, [2, 3], n.boundary[[3, 2]])),
        "not the one border of the nucleus",
    ),
    "their places swapped": (
        lambda n: replace(n, places=changed(n.places, n.boundary[[2, 3]], n.places[n.boundary[[3, 2]]])),
        "turns of the nuclear outline do not increase",
    ),
    "a vertex of the outline missing": (
        lambda n: replace(n, boundary=n.boundary[:-1]),
        "not the one border of the nucleus",
    ),
    "twice around": (
        lambda n: replace(n, boundary=np.tile(n.boundary, 2)),
        "not the one border of the nucleus",
    ),
    "nucleus outside": (lambda n: replace(n, inside=~n.inside), "Euler characteristic of the nucleus is 0"),
    "no triangle": (lambda n: replace(n, inside=np.zeros_like(n.inside)), "a compartment has no triangle"),
    "all triangles": (lambda n: replace(n, inside=np.ones_like(n.inside)), "a compartment has no triangle"),
    "outline not at its circle": (
        lambda n: replace(n, places=changed(n.places, (n.boundary, 0), 0.99)),
        "the nuclear outline is not at share 1",
    ),
    "turned the other way": (
        lambda n: replace(n, places=n.places * [1.0, -1.0], lifts=-n.lifts),
        "not positive in the disk",
    ),
    "all at one angle": (
        lambda n: replace(n, places=n.places * [1.0, 0.0]),
        "do not increase strictly through one turn",
    ),
    "no radius": (lambda n: replace(n, radius=0.0), "not between 0 and 1"),
    "radius not a number": (lambda n: replace(n, radius=np.nan), "not between 0 and 1"),
    "a place not finite": (
        lambda n: replace(n, places=changed(n.places, (9, 0), np.nan)),
        "missing or not finite",
    ),
    "a place missing": (lambda n: replace(n, places=n.places[:-1]), "missing or not finite"),
    "a lift missing": (lambda n: replace(n, lifts=n.lifts[:-1]), "whole turns"),
    "lifts not whole": (lambda n: replace(n, lifts=n.lifts.astype(float)), "whole turns"),
    "inside as numbers": (
        lambda n: replace(n, inside=n.inside.astype(int)),
        "whether they lie in the nucleus",
    ),
    "no outline": (lambda n: replace(n, boundary=n.boundary[:0]), "does not exist, or has less than three"),
    "a vertex below 0": (lambda n: replace(n, boundary=changed(n.boundary, 0, -1)), "does not exist"),
    "a vertex too many": (lambda n: replace(n, boundary=changed(n.boundary, 0, 10**6)), "does not exist"),
    "outline not whole": (lambda n: replace(n, boundary=n.boundary.astype(float)), "not whole numbers"),
}


@pytest.mark.parametrize("what", BROKEN)
def test_it_tells(what: str, disk: DiskMap) -> None:
    breaking, words = BROKEN[what]
    found = certified(disk, nucleus=breaking(nucleus_of(disk)))
    assert told(found, words), found.faults


def test_the_nuclear_outline_of_half_a_turn_between_neighbours(disk: DiskMap) -> None:
    nucleus = nucleus_of(disk)
    turns = np.append(np.linspace(0.0, 0.3, len(nucleus.boundary) - 1), 0.4)
    wide = replace(nucleus, places=changed(nucleus.places, (nucleus.boundary, 1), turns))
    assert told(certified(disk, nucleus=wide), "in steps of less than half")
