import numpy as np
import pytest

from cytodisk import simulate
from cytodisk.disk.circle import boundary_angles
from cytodisk.errors import ParameterError
from cytodisk.geometry.outline import trace_outline


@pytest.fixture(scope="module")
def outline() -> np.ndarray:
    return trace_outline(simulate.migrating(1))


def difference(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.angle(np.exp(1j * (a - b)))


def test_angles_increase_strictly_within_one_turn(outline: np.ndarray) -> None:
    angles = boundary_angles(outline)
    assert (np.diff(angles) > 0).all()
    assert angles[-1] - angles[0] < 2.0 * np.pi


def test_a_circle_keeps_its_own_angles() -> None:
    true = np.linspace(0.3, 0.3 + 2.0 * np.pi, 200, endpoint=False)
    circle = 40.0 * np.column_stack([np.sin(true), np.cos(true)]) + [50.0, 70.0]
    np.testing.assert_allclose(difference(boundary_angles(circle), true), 0.0, atol=1e-9)


def test_pixel_steps_do_not_make_a_diagonal_side_longer() -> None:
    # A square on its corner and an upright one: a raw pixel outline would be 8 % off between directions.
    mask = np.add.outer(np.abs(np.arange(-40, 41)), np.abs(np.arange(-40, 41))) <= 40
    mask[40:, :] = np.abs(np.arange(-40, 41)) <= 40  # upper half on its corner, lower half a box
    outline = trace_outline(np.pad(mask, 2))
    angles = boundary_angles(outline)
    roof = outline[:, 0] <= 41.0
    share = np.ptp(np.unwrap(angles[roof])) / (2.0 * np.pi)
    slanted = 2.0 * 40.0 * np.sqrt(2.0)
    assert share == pytest.approx(slanted / (slanted + 40.0 * 2 + 80.0), abs=0.01)


def test_upright_is_the_least_squares_rotation(outline: np.ndarray) -> None:
    angles = boundary_angles(outline)
    area_weight = np.hypot(*(np.roll(outline, -1, axis=0) - np.roll(outline, 1, axis=0)).T)
    from_centre = outline - [outline[:, 0].mean(), outline[:, 1].mean()]
    radius = np.hypot(*from_centre.T).mean()

    def misfit(turn: float) -> float:
        circle = radius * np.column_stack([np.sin(angles + turn), np.cos(angles + turn)])
        return float((area_weight[:, None] * (from_centre - circle) ** 2).sum())

    turns = np.radians(np.arange(-180, 180, 1.0))
    best = np.degrees(turns[np.argmin([misfit(turn) for turn in turns])])
    assert abs(best) <= 4.0  # weights and centre differ a little from the package's


def test_a_point_comes_to_angle_zero(outline: np.ndarray) -> None:
    tail = outline[outline[:, 1].argmin()]
    angles = boundary_angles(outline, (float(tail[0]), float(tail[1])))
    assert difference(angles[outline[:, 1].argmin()], 0.0) == pytest.approx(0.0, abs=1e-12)


def test_a_number_turns_the_upright_disk_by_degrees(outline: np.ndarray) -> None:
    turned = difference(boundary_angles(outline, 30.0), boundary_angles(outline))
    np.testing.assert_allclose(turned, np.radians(30.0), atol=1e-12)


@pytest.mark.parametrize("align", ["up", None, (1.0, 2.0, 3.0), np.nan, (np.nan, 1.0)])
def test_other_alignments_are_refused(outline: np.ndarray, align: object) -> None:
    with pytest.raises(ParameterError, match=r"align must be 'upright', 'nucleus', a point .* got"):
        boundary_angles(outline, align)
