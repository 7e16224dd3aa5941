from fractions import Fraction

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from cytodisk.geometry.exact import orientations


def exact_sign(corners: np.ndarray) -> int:
    (ay, ax), (by, bx), (cy, cx) = ((Fraction(y), Fraction(x)) for y, x in corners.tolist())
    determinant = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return (determinant > 0) - (determinant < 0)


def test_signs_of_plain_triangles() -> None:
    points = np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [0.0, 2.0]])
    sign, n_exact = orientations(points, np.array([[0, 1, 2], [0, 2, 1], [0, 1, 3]]))
    np.testing.assert_array_equal(sign, [1, -1, 0])
    assert n_exact == 1


def test_a_coordinate_that_is_not_finite_gives_zero() -> None:
    points = np.array([[0.0, 0.0], [0.0, 1.0], [np.nan, 0.0], [np.inf, 0.0]])
    np.testing.assert_array_equal(orientations(points, np.array([[0, 1, 2], [0, 1, 3]]))[0], [0, 0])


def test_points_a_few_units_in_the_last_place_off_a_line_are_decided_exactly() -> None:
    # The grid around (0.5, 0.5) against the line through (12, 12) and (24, 24), Kettner et al. 2008,
    # doi:10.1016/j.comgeo.2007.06.003: plain floating point gets many of these signs wrong.
    step = 2.0**-53
    grid = np.array([(0.5 + i * step, 0.5 + j * step) for i in range(40) for j in range(40)])
    points = np.concatenate([grid, [(12.0, 12.0), (24.0, 24.0)]])
    triangles = np.column_stack(
        [np.arange(len(grid)), np.full(len(grid), len(grid)), np.full(len(grid), len(grid) + 1)]
    )
    sign, n_exact = orientations(points, triangles)
    expected = [exact_sign(points[triangle]) for triangle in triangles]
    np.testing.assert_array_equal(sign, expected)
    assert n_exact > 0
    a, b, c = (points[triangles[:, k]] for k in range(3))
    plain = np.sign((b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0]) - (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]))
    assert (plain != expected).any()  # the case is hard enough to tell


coordinate = st.floats(-1e3, 1e3, allow_nan=False, allow_subnormal=False)
ulps = st.integers(-3, 3)


@given(st.tuples(coordinate, coordinate, coordinate, coordinate), st.floats(0, 1), ulps, ulps)
def test_near_degenerate_triples_agree_with_fractions(
    ends: tuple[float, float, float, float], share: float, up: int, right: int
) -> None:
    start, stop = np.array(ends[:2]), np.array(ends[2:])
    middle = start + share * (stop - start)
    middle = middle + np.array([up, right]) * np.spacing(np.abs(middle))
    corners = np.array([start, stop, middle])
    assert orientations(corners, np.array([[0, 1, 2]]))[0][0] == exact_sign(corners)
