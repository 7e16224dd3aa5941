import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

import cytodisk as cd
from cytodisk.errors import WindowError
from cytodisk.simulate import KINDS, random_mask
from cytodisk.windows.springs.closed_springs import relaxed, relaxed_groups
from cytodisk.windows.springs.edge_beads import EdgeBeads
from cytodisk.windows.springs.layer_borders import Border, inner_borders, one_turn


def ellipse(height: int, width: int) -> np.ndarray:
    y, x = np.mgrid[-height - 2 : height + 3, -width - 2 : width + 3]
    return (y / height) ** 2 + (x / width) ** 2 < 1


def test_springs_minimise_their_energy() -> None:
    """By the normal equations of the energy in the docstring, solved as a dense matrix."""
    rng = np.random.default_rng(3)
    n, length, stiffness = 12, 40.0, 2.5
    places = np.sort(rng.uniform(0, length, n))
    step = np.roll(np.eye(n), 1, axis=1) - np.eye(n)
    turn = np.zeros(n)
    turn[-1] = length  # the last gap goes through the start
    rest = np.full(n, length / n)
    expected = np.linalg.solve(
        np.eye(n) + stiffness * step.T @ step, places + stiffness * step.T @ (rest - turn)
    )
    assert_allclose(relaxed(places, length, stiffness), expected, atol=1e-9)
    assert_allclose(relaxed(places, length, 0.0), places, atol=1e-9)
    even = relaxed(places, length, np.inf)
    assert_allclose(np.diff(even), length / n)
    assert even.mean() == pytest.approx(places.mean())


def test_joined_beads_stay_together() -> None:
    joined = np.array([False, True, False, False, True, True])
    found = relaxed_groups(np.array([1.0, 3.0, 4.0, 5.0, 5.0, 8.0]), joined, 30.0, np.inf)
    assert_allclose(np.diff(found), [0.0, 10.0, 10.0, 0.0, 0.0])


def test_steps_back_along_a_curve_are_evened_out() -> None:
    there = one_turn(np.array([8.0, 9.5, 9.0, 1.0, 4.0]), 10.0)
    assert_allclose(there, [8.0, 9.25, 9.25, 11.0, 14.0, 18.0])


def test_borders_of_a_disk_are_circles() -> None:
    mask = cd.simulate.disk(30)
    outline = cd.spring_windows(mask, 3, 8).edge.outline_yx
    (border,) = inner_borders(outline, 10.0)
    middle = 0.5 * (np.array(mask.shape) - 1)
    assert_allclose(np.linalg.norm(border.points_yx - middle, axis=1), 20.0, atol=0.8)
    assert inner_borders(outline, 31.0) == []
    feet = Border(outline).feet_of(border)
    assert (np.diff(feet) >= 0).all()
    assert feet[-1] - feet[0] == pytest.approx(Border(outline).length)


def test_windows_of_a_disk_have_equal_areas_within_a_layer() -> None:
    """Without springs the steps of the mask's edge make them differ by more than 10 %."""
    mask = cd.simulate.disk(40)
    windows = cd.spring_windows(mask, 5, 30)
    spread = cd.measures_by_layer(windows)["area_cv"].to_numpy()
    assert (spread[:4] < 0.06).all()
    assert (cd.measures_by_layer(cd.edge_windows(mask, 5, 30))["area_cv"][:4] > 0.1).all()
    assert windows.n_empty == 0
    assert windows.coverage == 1.0
    layers = cd.edge_windows(mask, 5, 30)
    assert_allclose(windows.areas.sum(axis=1), layers.areas.sum(axis=1))  # layers are the same


def test_without_springs_they_are_edge_based_windows() -> None:
    mask = ellipse(18, 30)
    loose, edge = cd.spring_windows(mask, 4, 24, evenness=0.0), cd.edge_windows(mask, 4, 24)
    known = (edge.labels >= 0) & (edge.labels // 24 < 3)
    assert (loose.labels == edge.labels)[known].mean() > 0.85
    assert_allclose(loose.completeness, edge.completeness, atol=0.1)


def test_windows_end_where_their_sides_meet() -> None:
    """Those over the arms of a spiky cell do not reach its middle; those that do share it alike."""
    mask = cd.simulate.random_spiky(3, radius=30)
    windows = cd.spring_windows(mask, 5, 40)
    complete = windows.completeness
    assert complete[0] == 1.0
    assert (np.diff(complete) <= 1e-12).all()
    assert complete[-1] < 0.9
    assert windows.coverage == 1.0
    edge = cd.edge_windows(mask, 5, 40)
    assert complete.mean() > edge.completeness.mean()
    ours, theirs = (cd.measures_by_layer(one)["area_cv"] for one in (windows, edge))
    assert (ours < theirs).all()


def test_a_neck_parts_the_windows() -> None:
    windows = cd.spring_windows(cd.simulate.dumbbell(14, neck_width=3), 5, 40)
    assert_array_equal(windows.layer_pieces, [1, 2, 2, 2, 2])
    assert [len(level) for level in windows.borders] == [1, 2, 2, 2, 2]
    lobes = [set(crossed.sides.windows.tolist()) for crossed in windows.borders[1]]
    assert not lobes[0] & lobes[1]


@settings(max_examples=15)
@given(
    kind=st.sampled_from(KINDS),
    seed=st.integers(0, 10_000),
    layers=st.integers(1, 12),
    sectors=st.integers(1, 70),
    evenness=st.sampled_from([0.0, 1.0, 1000.0]),
    depth=st.sampled_from([None, 0.7, 3.0]),
)
def test_they_hold_their_share_of_any_cell(
    kind: str, seed: int, layers: int, sectors: int, evenness: float, depth: float | None
) -> None:
    """Layers are those of edge-based windows, whatever the springs do along them."""
    mask = random_mask(kind, seed)
    windows = cd.spring_windows(mask, layers, sectors, depth, evenness=evenness)
    edge = cd.edge_windows(mask, layers, sectors, depth)
    assert_allclose(windows.areas.sum(axis=1), edge.areas.sum(axis=1))
    assert windows.coverage == pytest.approx(edge.coverage)
    for level in windows.borders:
        for crossed in level:
            places = crossed.sides.places
            assert (np.diff(places) >= 0).all()
            assert places[-1] - places[0] <= crossed.border.length * (1 + 1e-9)
            assert len(set(crossed.sides.windows.tolist())) == len(crossed.sides.windows)


def test_sectors_are_those_of_a_map() -> None:
    disk = cd.map_to_disk(cd.simulate.disk(30), method="harmonic")
    springs, polar = cd.spring_windows(disk, 2, 12), cd.polar_windows(2, 12, "radius").on(disk)
    assert_allclose(springs.centroids_yx, polar.centroids_yx, atol=0.6)
    grid = cd.SpringGrid(2, 12, springs.depth_px)
    assert_array_equal(grid.on(disk).labels, springs.labels)


@pytest.mark.parametrize("evenness", [-1.0, np.nan, "much"])
def test_a_wrong_evenness_is_refused(evenness: object) -> None:
    with pytest.raises(WindowError, match="evenness"):
        cd.spring_windows(cd.simulate.disk(8), 2, 4, evenness=evenness)
    with pytest.raises(WindowError, match="evenness"):
        cd.SpringGrid(2, 4, 3.0, evenness=evenness)  # type: ignore[arg-type]


def test_beads_follow_a_growing_disk_along_its_normals() -> None:
    angle = 2.0 * np.pi * np.arange(200) / 200
    circle = np.column_stack([np.sin(angle), np.cos(angle)])
    beads = EdgeBeads.along(20.0 * circle, angle, sectors=8)
    assert_allclose(beads.angles, angle, atol=1e-9)
    for radius in (22.0, 25.0, 23.0):
        beads = beads.carried(radius * circle, line_tension=1.0)
    off = np.mod(beads.angles - angle + np.pi, 2.0 * np.pi) - np.pi
    assert_allclose(off, 0.0, atol=0.01)


def test_line_tension_holds_beads_apart() -> None:
    """A lobe grows on one side: without tension its new edge has few beads, with it they even out."""
    angle = 2.0 * np.pi * np.arange(400) / 400
    circle = np.column_stack([np.sin(angle), np.cos(angle)])
    lobe = 20.0 * circle + 40.0 * np.exp(-((angle - np.pi) ** 2) / 0.05)[:, None] * circle
    start = EdgeBeads.along(20.0 * circle, angle, sectors=20)
    widest = {tension: np.diff(start.carried(lobe, tension).places).max() for tension in (0.0, 1.0, 1000.0)}
    assert widest[0.0] > 2.0 * widest[1.0]
    assert widest[1.0] > widest[1000.0]
    even = start.carried(lobe, 1000.0)
    assert widest[1000.0] == pytest.approx(even.border.length / 80, rel=1e-3)
