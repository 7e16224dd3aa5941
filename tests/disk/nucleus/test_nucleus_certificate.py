"""Conditions of the proof of a map with a nucleus, beside those in `test_broken_maps`."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import cytodisk as cd
from cytodisk.disk.certificate import Certificate
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.nucleus.cone import MOST_LIFT, STEPS_A_TURN
from cytodisk.disk.nucleus.nucleus import Nucleus
from cytodisk.disk.nucleus.nucleus_certificate import certify_compartments

Change = Callable[[DiskMap, Nucleus], Nucleus]


@pytest.fixture(scope="module")
def disk() -> DiskMap:
    found = cd.simulate.cell_with_nucleus("off centre", seed=5, shape="spread", radius_px=20.0)
    return cd.map_to_disk(found.mask, nucleus=found.nucleus)


def certified(disk: DiskMap, change: Change) -> Certificate:
    assert disk.nucleus is not None
    nucleus = change(disk, disk.nucleus)
    return certify_compartments(disk.vertices_yx, disk.vertices_uv, disk.triangles, disk.boundary, nucleus)


def ring_vertex(disk: DiskMap, nucleus: Nucleus) -> int:
    """A vertex of the cytoplasm on no outline."""
    ring = np.setdiff1d(disk.triangles[~nucleus.inside], np.union1d(disk.boundary, nucleus.boundary))
    return int(ring[len(ring) // 2])


def placed(nucleus: Nucleus, vertex: int, axis: int, value: float) -> Nucleus:
    places = nucleus.places.copy()
    places[vertex, axis] = value
    return replace(nucleus, places=places)


def rounded_turn(disk: DiskMap, nucleus: Nucleus) -> Nucleus:
    vertex = ring_vertex(disk, nucleus)
    return placed(nucleus, vertex, 1, nucleus.places[vertex, 1] * (1.0 - 2.0**-52))


def wound_twice(disk: DiskMap, nucleus: Nucleus) -> Nucleus:
    """Continuous in the cytoplasm, whose triangles all are positive; but each place is reached twice."""
    places = nucleus.places.copy()
    outer = np.unique(disk.triangles[~nucleus.inside])
    whole = np.zeros(len(places), dtype=np.int64)
    whole[outer] = np.floor(2.0 * places[outer, 1])
    places[outer, 1] = 2.0 * places[outer, 1] - whole[outer]
    lifts = np.where(nucleus.inside[:, None], 0, 2 * nucleus.lifts + whole[disk.triangles])
    return replace(nucleus, places=places, lifts=lifts)


def all_lifts_more(disk: DiskMap, nucleus: Nucleus) -> Nucleus:
    return replace(nucleus, lifts=nucleus.lifts + (MOST_LIFT + 1) * ~nucleus.inside[:, None])


CASES: dict[str, tuple[Change, str]] = {
    "wound twice": (wound_twice, "nuclear outline do not increase strictly through one turn"),
    "all lifts": (all_lifts_more, "cannot be added exactly"),
    "a turn that is not stepped": (rounded_turn, "cannot be added exactly"),
    "below the membrane": (lambda d, n: placed(n, ring_vertex(d, n), 0, -0.1), "below 0 or above 1"),
    "a membrane in the cytoplasm": (lambda d, n: placed(n, d.boundary[0], 0, 0.1), "not at share 0"),
    "another radius": (lambda d, n: replace(n, radius=0.6), "not where their places"),
}


@pytest.mark.parametrize("case", CASES)
def test_every_condition_is_named(disk: DiskMap, case: str) -> None:
    change, words = CASES[case]
    found = certified(disk, change).faults
    assert any(words in fault for fault in found), found


def test_two_sheets_are_found_though_all_triangles_are_positive(disk: DiskMap) -> None:
    found = certified(disk, wound_twice)
    assert disk.nucleus is not None
    assert disk.nucleus.inside[list(found.flipped_in_disk)].all()
    assert not any("agree" in fault for fault in found.faults)
    assert "turns of the membrane do not increase strictly through one turn" in found.faults


def test_turns_are_steps(disk: DiskMap) -> None:
    assert disk.nucleus is not None
    turns = disk.nucleus.places[np.unique(disk.triangles[~disk.nucleus.inside]), 1] * STEPS_A_TURN
    assert (turns == np.rint(turns)).all()
