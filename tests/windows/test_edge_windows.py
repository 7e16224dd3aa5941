import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

import cytodisk as cd
from cytodisk.errors import WindowError
from cytodisk.simulate import KINDS, random_mask

RECTANGLE = np.pad(np.ones((12, 20), dtype=bool), 4)


def test_layers_of_a_rectangle_are_frames() -> None:
    """Exactly: the outline runs along the pixels' sides, and layers of 2 px end between subpixels. The middle
    is 6 px deep, so the fourth layer and the fifth are empty."""
    windows = cd.edge_windows(RECTANGLE, 5, 1, depth_px=2.0)
    sizes = [(12 - 4 * layer) * (20 - 4 * layer) for layer in range(4)]
    assert_array_equal(windows.areas[:, 0], [*-np.diff(sizes), 0, 0])
    assert windows.n_empty == 2
    assert windows.coverage == 1.0
    assert windows.edge.greatest_depth == 6 - 1 / 8  # in the middle of a subpixel


def test_a_layer_between_subpixels_is_known_too() -> None:
    windows = cd.edge_windows(RECTANGLE, 1, 1, depth_px=0.75)
    assert windows.areas.item() == 12 * 20 - 10.5 * 18.5
    assert windows.coverage == pytest.approx(1 - 10.5 * 18.5 / 240)
    side = [[rows**k * columns ** (4 - k) for k in (1, 3)] for rows, columns in ((12, 20), (10.5, 18.5))]
    small, large = sorted(side[0][k] - side[1][k] for k in (0, 1))  # second moments, times 12
    assert windows.eccentricities.item() == pytest.approx(np.sqrt(1 - small / large), rel=1e-12)


def test_layers_of_a_disk_are_rings_of_equal_depth() -> None:
    """The mask's edge goes in steps of a pixel, so what a layer surrounds has a radius that is off by less
    than half a pixel, of 10 from layer to layer."""
    windows = cd.edge_windows(cd.simulate.disk(60), 6, 8)
    assert windows.depth_px == pytest.approx(10.0, rel=0.015)
    within = np.cumsum(windows.areas.sum(axis=1)[::-1])[::-1]
    assert_allclose(np.sqrt(within[1:] / np.pi), windows.depth_px * np.arange(5, 0, -1), atol=0.5)
    assert_allclose(windows.areas / windows.areas.sum(axis=1, keepdims=True), 1 / 8, rtol=0.03)
    assert windows.n_empty == 0


def test_sectors_of_a_disk_lie_where_those_of_its_map_do() -> None:
    disk = cd.map_to_disk(cd.simulate.disk(30))
    edge, polar = cd.edge_windows(disk, 2, 12), cd.polar_windows(2, 12, "radius").on(disk)
    assert_allclose(edge.centroids_yx, polar.centroids_yx, atol=0.5)


def test_a_given_depth_leaves_the_middle_out() -> None:
    mask = cd.simulate.disk(40)
    windows = cd.edge_windows(mask, 3, 10, depth_px=5.0)
    radius = np.sqrt(mask.sum() / np.pi)
    assert windows.coverage == pytest.approx(1.0 - (radius - 15.0) ** 2 / radius**2, abs=0.01)
    assert_array_equal(windows.completeness, [1.0, 1.0, 1.0])
    middle = tuple(np.array(mask.shape) // 2)
    assert windows.labels[middle] == -1
    assert windows.weights.sum(axis=0).max() <= 1.0


def test_inner_layers_of_a_dumbbell_are_incomplete_and_apart() -> None:
    windows = cd.edge_windows(cd.simulate.dumbbell(14, neck_width=3), 5, 40)
    completeness = windows.completeness
    assert completeness[0] == 1.0
    assert (np.diff(completeness) <= 0).all()
    assert completeness[-1] < 0.85
    assert windows.n_empty == 200 - round(40 * completeness.sum()) > 0
    assert_array_equal(windows.layer_pieces, [1, 2, 2, 2, 2])


def test_layers_of_polar_windows_go_through_a_neck() -> None:
    mask = cd.simulate.dumbbell(14, neck_width=7)
    assert_array_equal(cd.edge_windows(mask, 5, 40).layer_pieces[-2:], [2, 2])
    assert_array_equal(cd.polar_windows(5, 40).on(cd.map_to_disk(mask)).layer_pieces, np.ones(5))


def test_a_window_may_fall_into_pieces() -> None:
    """A single sector takes in both ends of a dumbbell."""
    windows = cd.edge_windows(cd.simulate.dumbbell(14, neck_width=3), 5, 1)
    assert_array_equal(windows.pieces[:, 0], [1, 2, 2, 2, 2])


@settings(max_examples=25)
@given(
    kind=st.sampled_from(KINDS),
    seed=st.integers(0, 10_000),
    layers=st.integers(1, 30),
    sectors=st.integers(1, 90),
    depth=st.sampled_from([None, 0.3, 2.0, 50.0]),
)
def test_windows_hold_their_share_of_the_cell(
    kind: str, seed: int, layers: int, sectors: int, depth: float | None
) -> None:
    windows = cd.edge_windows(random_mask(kind, seed), layers, sectors, depth)
    columns = windows.weights.sum(axis=0)
    assert columns.max() <= 1.0
    subpixels = windows.subpixel_windows
    assert windows.coverage == pytest.approx((subpixels >= 0).mean(), rel=1e-12)
    counts = np.bincount(subpixels[subpixels >= 0], minlength=layers * sectors)
    assert_array_equal(windows.areas.ravel(), counts / 16)
    if depth is None or depth == 50.0:
        assert windows.coverage == 1.0
    signal = np.random.default_rng(seed).uniform(1.0, 9.0, windows.mask.shape)
    data = cd.sample(windows, signal)
    empty = windows.areas == 0
    for name in ("mean", "sd", "min", "max"):
        assert_array_equal(np.isnan(data[name]), empty)
    assert_array_equal(data["n_pixels"] == 0, empty)
    assert float((data["mean"] * data["n_pixels"]).sum()) == pytest.approx(
        float(columns @ signal[windows.mask]), rel=1e-9
    )
    assert_array_equal(windows.pieces == 0, empty)
    assert_array_equal(np.isnan(windows.eccentricities), empty)
    assert_array_equal(np.isnan(windows.centroids_yx).all(axis=-1), empty)


@pytest.mark.parametrize("kind", KINDS)
def test_depth_and_place_have_a_plain_twin(kind: str) -> None:
    """By all edges of the outline at once."""
    windows = cd.edge_windows(random_mask(kind, 3))
    outline = windows.edge.outline_yx
    depth, angle = windows.edge.subpixels_of(np.argwhere(windows.mask))
    places = np.argwhere(windows.mask)[:, None, :] + np.array([[-0.375, -0.375], [0.125, 0.375]])
    for subpixel, column in ((0, 0), (11, 1)):
        start, along = outline, np.roll(outline, -1, axis=0) - outline
        away = places[:, column, None] - start
        share = np.clip((away * along).sum(axis=-1) / (along**2).sum(axis=-1), 0.0, 1.0)
        distance = np.linalg.norm(away - share[..., None] * along, axis=-1)
        inside = depth[:, subpixel] > 0
        assert_allclose(depth[inside, subpixel], distance.min(axis=1)[inside], atol=1e-12)
        assert distance.min(axis=1)[~inside].max(initial=0.0) < 0.75  # corners of pixels cut by the outline
        above = np.column_stack(
            [np.interp(angle[:, subpixel], windows.edge.angles, xs, period=2.0 * np.pi) for xs in outline.T]
        )
        assert_allclose(np.linalg.norm(places[:, column] - above, axis=-1), distance.min(axis=1), atol=1e-9)


@pytest.mark.parametrize("kind", KINDS)
def test_pixels_that_are_left_out_make_no_difference(kind: str) -> None:
    """Depths are only found where they matter: near the deepest point, and within the layers."""
    edge = cd.edge_windows(np.kron(random_mask(kind, 5), np.ones((4, 4), dtype=bool)), 1, 7).edge
    depth, angle = edge.subpixels_of(np.argwhere(edge.mask))
    place, deepest = edge.deepest
    assert deepest == depth.max()
    assert_array_equal(place, np.argwhere(edge.mask)[depth.max(axis=1).argmax()])
    for depth_px in (0.3, 2.0):
        windows = cd.EdgeWindows(cd.EdgeGrid(2, 7, depth_px), edge)
        assert_array_equal(windows.subpixel_windows, windows.grid.window_of(depth, angle))


@pytest.mark.parametrize("depth", [5e-324, 1e-200, 1e-18])
def test_a_tiny_depth_leaves_almost_all_out(depth: float) -> None:
    """But three subpixels at each corner, which the outline cuts off: their depth is 0."""
    windows = cd.edge_windows(RECTANGLE, 3, 1, depth)
    assert_array_equal(windows.areas[:, 0], [12 / 16, 0, 0])


@pytest.mark.parametrize("depth", [1e3, 1e300, np.float64(1.7e308)])
def test_a_huge_depth_takes_all_into_the_first_layer(depth: float) -> None:
    windows = cd.edge_windows(RECTANGLE, 3, 1, depth)
    assert_array_equal(windows.areas[:, 0], [240, 0, 0])


def test_sectors_are_those_of_the_map_they_are_given() -> None:
    """A map that is turned by a quarter has the same windows, a quarter of the sectors on."""
    mask = cd.simulate.migrating(seed=3, size=0.4)
    upright = cd.edge_windows(cd.map_to_disk(mask, method="harmonic"), 3, 20)
    turned = cd.edge_windows(cd.map_to_disk(mask, method="harmonic", align=90.0), 3, 20)
    assert_allclose(np.roll(upright.areas, 5, axis=1), turned.areas, atol=1.0)
    assert_allclose(cd.edge_windows(mask, 3, 20).areas, upright.areas)


def test_a_grid_has_one_depth_for_all_cells() -> None:
    grid = cd.EdgeGrid(4, 12, 3.0)
    small, large = (cd.map_to_disk(cd.simulate.disk(radius), method="harmonic") for radius in (10, 20))
    assert grid.on(small).depth_px == grid.on(large).depth_px == 3.0
    assert_array_equal(grid.on(small).completeness[:3], 1.0)
    assert grid.on(small).coverage == 1.0
    assert grid.on(large).coverage == pytest.approx(1.0 - (8 / 20) ** 2, abs=0.02)


@pytest.mark.parametrize("depth", [0.0, -1.0, np.inf, np.nan, "3", True])
def test_a_depth_that_is_no_number_above_0_is_refused(depth: object) -> None:
    with pytest.raises(WindowError, match=r"depth_px.*above 0"):
        cd.edge_windows(cd.simulate.disk(5), 2, 3, depth)  # type: ignore[arg-type]


@pytest.mark.parametrize("windows", [cd.edge_windows, cd.ring_windows])
def test_a_count_that_is_none_is_refused(windows: object) -> None:
    with pytest.raises(WindowError, match=r"layers.*from 1 to 100000, got 0"):
        windows(cd.simulate.disk(5), 0, 3)  # type: ignore[operator]


@pytest.mark.parametrize("side", [1, 2])
def test_a_tiny_mask_has_windows_too(side: int) -> None:
    windows = cd.edge_windows(np.ones((side, side), dtype=bool), 3, 4)
    assert windows.coverage == 1.0
    assert windows.areas.sum() == side**2


def test_rings_of_a_disk_are_those_on_paper() -> None:
    """d_edge + d_centre is the radius, so rings have equal width; ways go pixel by pixel, in eight
    directions, and are up to 8 % too long, which moves the sides of rings."""
    mask = cd.simulate.disk(60)
    windows = cd.ring_windows(mask, 4, 8)
    expected = np.array([7, 5, 3, 1]) / 16
    assert_allclose(windows.areas.sum(axis=1) / mask.sum(), expected, atol=0.04)
    assert_allclose(windows.areas.sum(axis=0) / mask.sum(), 1 / 8, atol=0.01)
    assert windows.coverage == 1.0


def test_rings_lie_around_the_deepest_point() -> None:
    windows = cd.ring_windows(cd.simulate.star(body_radius=10, arm_length=30, arm_width=2), 5, 40)
    assert windows.coverage == 1.0
    assert_array_equal(windows.layer_pieces[-1:], [1])
    middle = np.argwhere(windows.mask).mean(axis=0)
    assert_allclose(np.nanmean(windows.centroids_yx[-1], axis=0), middle, atol=3.0)


def test_a_wedge_takes_in_whatever_lies_in_its_direction() -> None:
    """A body with an arm that comes back beside it."""
    mask = np.zeros((40, 60), dtype=bool)
    mask[2:32, 2:32] = True
    mask[26:32, 2:52] = True
    mask[2:32, 46:52] = True
    assert cd.ring_windows(mask, 2, 8).pieces[0].max() == 2


def test_ways_go_through_the_cell() -> None:
    """Around the corner of an L, not across: the end of the thin arm is all edge."""
    mask = np.zeros((44, 44), dtype=bool)
    mask[2:22, 2:22] = True
    mask[16:22, 2:42] = True
    mask[16:42, 36:42] = True
    windows = cd.ring_windows(mask, 4, 1)
    assert (windows.labels[30:41, 36:42] == 0).all()
