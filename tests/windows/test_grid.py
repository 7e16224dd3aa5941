import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cytodisk.errors import WindowError
from cytodisk.windows.polar_windows import PolarGrid, polar_windows
from cytodisk.windows.study_grid import polar_grid_of

SPACINGS = ("area", "radius")
JUST_BELOW_A_TURN = -1e-17  # its remainder modulo one turn rounds to a whole turn


@pytest.mark.parametrize("spacing", SPACINGS)
def test_radii_go_from_the_edge_to_the_centre(spacing: str) -> None:
    radii = polar_windows(7, 5, spacing).radii
    assert (radii[0], radii[-1], len(radii)) == (1.0, 0.0, 8)
    assert (np.diff(radii) < 0).all()


def test_radius_spacing_has_rings_of_equal_width() -> None:
    np.testing.assert_allclose(polar_windows(4, 1, "radius").radii, [1.0, 0.75, 0.5, 0.25, 0.0])


def test_area_spacing_has_rings_of_equal_area() -> None:
    np.testing.assert_allclose(-np.diff(polar_windows(9, 1, "area").radii ** 2), 1 / 9)


def test_angles_divide_one_turn_equally() -> None:
    angles = polar_windows(1, 8).angles
    np.testing.assert_allclose(np.diff(angles), np.pi / 4)
    assert (angles[0], angles[-1]) == (0.0, 2.0 * np.pi)


@pytest.mark.parametrize("spacing", SPACINGS)
def test_rim_is_in_layer_0_and_centre_in_the_last(spacing: str) -> None:
    grid = polar_windows(5, 6, spacing)
    assert grid.window_of(np.array([[1.0, 0.0], [1.0 + 1e-12, 0.0], [0.0, 0.0]])).tolist() == [0, 0, 24]


@pytest.mark.parametrize("spacing", SPACINGS)
@pytest.mark.parametrize("sectors", [1, 2, 60, 199])
def test_an_angle_just_below_a_turn_is_in_the_last_sector(spacing: str, sectors: int) -> None:
    grid = polar_windows(3, sectors, spacing)
    points = np.array([[0.9999, JUST_BELOW_A_TURN], [0.9999, -1e-9]])
    assert grid.window_of(points).tolist() == [sectors - 1, sectors - 1]


def test_sectors_turn_from_u_towards_v() -> None:
    points = 0.9 * np.array([[1.0, 0.1], [-0.1, 1.0], [-1.0, -0.1], [0.1, -1.0]])
    assert polar_windows(1, 4).window_of(points).tolist() == [0, 1, 2, 3]


@given(layers=st.integers(1, 100), sectors=st.integers(1, 200), spacing=st.sampled_from(SPACINGS))
def test_the_middle_of_every_window_lies_in_it(layers: int, sectors: int, spacing: str) -> None:
    grid = polar_windows(layers, sectors, spacing)
    np.testing.assert_array_equal(grid.window_of(grid.centres_uv), np.arange(grid.n_windows))


@given(
    layers=st.integers(1, 100),
    sectors=st.integers(1, 200),
    spacing=st.sampled_from(SPACINGS),
    radius=st.floats(0.0, 1.0),
    angle=st.floats(0.0, 2.0 * np.pi, exclude_max=True),
)
def test_a_point_lies_between_the_sides_of_its_window(
    layers: int, sectors: int, spacing: str, radius: float, angle: float
) -> None:
    grid = polar_windows(layers, sectors, spacing)
    point = np.array([[radius * np.cos(angle), radius * np.sin(angle)]])
    layer, sector = divmod(int(grid.window_of(point)[0]), sectors)
    assert grid.radii[layer + 1] - 1e-12 <= radius <= grid.radii[layer] + 1e-12
    if radius > 1e-6:
        off_middle = angle - 0.5 * (grid.angles[sector] + grid.angles[sector + 1])
        assert abs(np.remainder(off_middle + np.pi, 2.0 * np.pi) - np.pi) <= np.pi / sectors + 1e-9


def test_counts_may_be_numpy_integers() -> None:
    assert polar_windows(np.int64(2), np.uint8(3)) == PolarGrid(2, 3, "area")


@pytest.mark.parametrize("value", [0, -1, 2.5, True, "3", None])
@pytest.mark.parametrize("name", ["layers", "sectors"])
def test_a_count_that_is_no_positive_whole_number_is_refused(name: str, value: object) -> None:
    with pytest.raises(WindowError, match=rf"{name}.*from 1 to 100000.*{value!r}"):
        polar_windows(**{name: value})


def test_an_unknown_spacing_is_refused() -> None:
    with pytest.raises(WindowError, match=r"spacing.*'log'"):
        polar_windows(3, 3, "log")


def first_thickness(layers: int, spacing: str) -> float:
    """Thickness of the first of so many rings, over the radius of the disk."""
    return 1.0 - float(polar_windows(layers, 1, spacing).radii[1])


@pytest.mark.parametrize(
    ("parameters", "expected"),
    [
        ({"layers": 3, "sectors": 8, "spacing": "radius"}, polar_windows(3, 8, "radius")),
        ({"layers": 10, "sectors": 8, "depth_um": [0.5, 1.0]}, polar_windows(sectors=8, depth_um=(0.5, 1.0))),
        ({"layers": 10, "sectors": 8, "depth_um": 0.5}, polar_windows(4, 8)),  # of an earlier version
    ],
)
def test_the_grid_of_a_study_is_that_of_its_provenance(parameters: dict, expected: PolarGrid) -> None:
    assert polar_grid_of({"parameters": {"nan": "omit", **parameters}, "layers": 4}) == expected
