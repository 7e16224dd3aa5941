"""From a cell with its nucleus to the disk and back, at its borders and in rotations of the disk."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.mapping import map_to_disk
from cytodisk.disk.nucleus.nucleus import Nucleus
from cytodisk.errors import ParameterError
from cytodisk.geometry.polygon import centroid
from cytodisk.simulate import cell_with_nucleus, random_pair

CELL = cell_with_nucleus("off centre", 1, shape="spread", radius_px=20.0)


@pytest.fixture(scope="module", params=[0.05, 0.5, 0.95, "area"])
def disk(request: pytest.FixtureRequest) -> DiskMap:
    return map_to_disk(CELL.mask, nucleus=CELL.nucleus, nucleus_radius=request.param)


def nucleus_of(disk: DiskMap) -> Nucleus:
    assert disk.nucleus is not None
    return disk.nucleus


def test_each_place_of_the_disk_is_one_of_the_cell(disk: DiskMap) -> None:
    inner = nucleus_of(disk).radius
    beside = [0.0, 1e-9, np.nextafter(inner, 0), inner, np.nextafter(inner, 1), 1 - 1e-12, 1.0]
    angles = np.concatenate(
        [
            [0.0, -0.0, 1e-17, -1e-17, 0.5 * np.pi, np.pi, -np.pi, 2.0 * np.pi],
            nucleus_of(disk).boundary_angles,
            disk.boundary_angles,
        ]
    )
    for radius in [*beside, *np.random.default_rng(0).random(20)]:
        uv = radius * np.column_stack([np.cos(angles), np.sin(angles)])
        found = disk.to_cell(uv)
        assert np.isfinite(found).all(), radius
        assert_allclose(disk.to_disk(found, outside="nearest"), uv, atol=1e-9)


def test_outlines_go_to_their_circles_with_angles_linear_along_each_edge(disk: DiskMap) -> None:
    nucleus = nucleus_of(disk)
    for loop, angles, radius in (
        (disk.boundary, disk.boundary_angles, 1.0),
        (nucleus.boundary, nucleus.boundary_angles, nucleus.radius),
    ):
        ends = disk.vertices_yx[np.append(loop, loop[0])]
        turns = np.append(angles, angles[0] + 2.0 * np.pi)
        for fraction in (0.0, 0.3, 0.5, 0.8):
            places = ends[:-1] + fraction * np.diff(ends, axis=0)
            angle = turns[:-1] + fraction * np.diff(turns)
            uv = radius * np.column_stack([np.cos(angle), np.sin(angle)])
            assert_allclose(disk.to_disk(places, outside="nearest"), uv, atol=1e-7)
            assert_allclose(disk.to_cell(uv), places, atol=1e-7)


def test_vertices_and_pixels_go_to_their_compartment(disk: DiskMap) -> None:
    assert_allclose(disk.to_disk(disk.vertices_yx, outside="nearest"), disk.vertices_uv, atol=1e-9)
    pixels = np.argwhere(disk.mask)
    uv = disk.to_disk(pixels)
    assert_allclose(disk.to_cell(uv), pixels, atol=1e-9)
    inside = np.hypot(*uv.T) <= nucleus_of(disk).radius
    np.testing.assert_array_equal(inside, nucleus_of(disk).mask[tuple(pixels.T)])


def test_what_is_outside_is_nan_or_the_nearest_place_on_the_rim(disk: DiskMap) -> None:
    points = np.array([[-5.0, 3.0], [np.nan, 4.0], [0.0, 1e6]])
    assert np.isnan(disk.to_disk(points)).all()
    nearest = disk.to_disk(points, outside="nearest")
    assert_allclose(np.hypot(*nearest[[0, 2]].T), 1.0)
    assert np.isnan(nearest[1]).all()
    assert np.isnan(disk.to_cell([[1.01, 0.0], [0.0, np.nan], [np.inf, 0.0]])).all()
    assert disk.to_cell(np.zeros((2, 3, 2))).shape == (2, 3, 2)
    assert disk.to_disk(np.empty((0, 2))).shape == disk.to_cell(np.empty((0, 2))).shape == (0, 2)


@pytest.mark.parametrize("radius", [0.0, 0.049, 0.951, 1.0, -1.0, np.nan, True, "cell", None])
def test_a_radius_out_of_range_is_refused(radius: object) -> None:
    with pytest.raises(ParameterError, match="nucleus_radius"):
        map_to_disk(CELL.mask, nucleus=CELL.nucleus, nucleus_radius=radius)


@pytest.mark.parametrize(("height", "width"), [(1, 1), (1, 2), (2, 2), (1, 9), (9, 1)])
@pytest.mark.parametrize("radius", ["area", 0.5])
def test_the_smallest_nuclei_are_mapped(height: int, width: int, radius: object) -> None:
    nucleus = np.zeros_like(CELL.nucleus)
    row, column = np.argwhere(CELL.nucleus).mean(axis=0).astype(int)
    nucleus[row : row + height, column : column + width] = True
    disk = map_to_disk(CELL.mask, nucleus=nucleus, nucleus_radius=radius)
    assert disk.converged
    assert nucleus_of(disk).report.area_px == height * width
    pixels = np.argwhere(disk.mask)
    uv = disk.to_disk(pixels)
    assert_allclose(disk.to_cell(uv), pixels, atol=1e-9)
    assert ((np.hypot(*uv.T) <= nucleus_of(disk).radius) == nucleus[tuple(pixels.T)]).all()


def turned_by(disk: DiskMap, other: DiskMap) -> float:
    """How far a disk is turned against another, in degrees, as the mean over pixels of both."""
    pixels = np.argwhere(disk.mask & other.mask)
    one, two = (made.to_disk(pixels) @ [1.0, 1j] for made in (disk, other))
    return float(np.degrees(np.angle((two * one.conj()).sum())))


def test_a_number_and_a_point_turn_the_disk_with_its_nucleus() -> None:
    upright = map_to_disk(CELL.mask, nucleus=CELL.nucleus)
    turned = map_to_disk(CELL.mask, nucleus=CELL.nucleus, align=40.0)
    angle = np.radians(40.0)
    rotation = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    pixels = np.argwhere(CELL.mask)
    assert_allclose(turned.to_disk(pixels), upright.to_disk(pixels) @ rotation, atol=1e-6)
    point = upright.outline_yx[10]
    at_zero = map_to_disk(CELL.mask, nucleus=CELL.nucleus, align=tuple(point))
    assert_allclose(at_zero.to_disk([point], outside="nearest"), [[1.0, 0.0]], atol=1e-9)


def test_the_direction_from_the_nucleus_to_the_cell_is_at_angle_0_whichever_way_it_points() -> None:
    for turns in range(4):
        mask, nucleus = (np.rot90(one, turns) for one in (CELL.mask, CELL.nucleus))
        upright = map_to_disk(mask, nucleus=nucleus)
        aligned = map_to_disk(mask, nucleus=nucleus, align="nucleus")
        assert aligned.nucleus_outline_yx is not None
        away = centroid(aligned.outline_yx) - centroid(aligned.nucleus_outline_yx)
        direction = np.degrees(np.arctan2(away[0], away[1]))
        apart = turned_by(upright, aligned) + direction
        assert abs((apart + 180.0) % 360.0 - 180.0) < 1e-6
    with pytest.raises(ParameterError, match=r"needs a nucleus.*--nuclei"):
        map_to_disk(CELL.mask, align="nucleus")


@pytest.mark.parametrize("align", ["upright", "nucleus", 30.0])
@pytest.mark.parametrize("seed", [1, 4])
def test_one_pixel_more_turns_the_disk_by_little(align: object, seed: int) -> None:
    cell = cell_with_nucleus("off centre", seed, shape="spread", radius_px=25.0)
    before = map_to_disk(cell.mask, nucleus=cell.nucleus, align=align)
    random = np.random.default_rng(seed)
    for changed in (0, 1):
        masks = [cell.mask.copy(), cell.nucleus.copy()]
        beside = np.argwhere(grown(masks[changed]) & ~masks[changed])
        masks[changed][tuple(random.choice(beside))] = True
        after = map_to_disk(masks[0] | masks[1], nucleus=masks[1], align=align)
        assert abs(turned_by(before, after)) < 2.0


def grown(mask: np.ndarray) -> np.ndarray:
    padded = np.pad(mask, 1)
    found = padded[2:, 1:-1] | padded[:-2, 1:-1] | padded[1:-1, 2:] | padded[1:-1, :-2]
    return np.asarray(found)


@pytest.mark.parametrize("edge_length", [0.25, 10.0])
@pytest.mark.parametrize("shape_weight", [1e-4, 1.0])
def test_extreme_meshes_and_weights_are_mapped(edge_length: float, shape_weight: float) -> None:
    mask, nucleus = random_pair(3)
    disk = map_to_disk(mask, nucleus=nucleus, edge_length=edge_length, shape_weight=shape_weight)
    assert disk.converged
    pixels = np.argwhere(disk.mask)
    assert_allclose(disk.to_cell(disk.to_disk(pixels)), pixels, atol=1e-9)
    assert np.isfinite(disk.distortion.area)
