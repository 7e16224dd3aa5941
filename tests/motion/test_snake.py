import numpy as np
import pytest

from cytodisk import simulate
from cytodisk.motion.demons_parameters import DemonsParameters
from cytodisk.motion.snake import edge_map, gradient_vector_flow, sample_field, settle

DEFAULT = DemonsParameters()
FREE = DemonsParameters(snake_tension=0.0, snake_stiffness=0.0)
CENTRE = 38.0  # of simulate.disk(30.0), whose margin is 8 pixels


def circle(radius: float, n: int = 120) -> np.ndarray:
    angle = np.arange(n) * 2.0 * np.pi / n
    return CENTRE + radius * np.column_stack([np.sin(angle), np.cos(angle)])


def radii(points_yx: np.ndarray) -> np.ndarray:
    return np.hypot(*(points_yx - CENTRE).T)


def flow_by_hand(edges: np.ndarray, mu: float, iterations: int) -> np.ndarray:
    """Plain twin: the explicit steps of Xu and Prince 1998, whose steady state is the same."""
    gradient = np.stack(np.gradient(edges))
    weight = (gradient**2).sum(axis=0)
    flow = gradient.copy()
    for _ in range(iterations):
        padded = np.pad(flow, ((0, 0), (1, 1), (1, 1)), mode="edge")
        around = padded[:, 2:, 1:-1] + padded[:, :-2, 1:-1] + padded[:, 1:-1, 2:] + padded[:, 1:-1, :-2]
        flow = flow + mu * (around - 4.0 * flow) - weight * (flow - gradient)
    return flow


def test_the_edge_map_is_a_level_ridge_on_the_boundary() -> None:
    edges = edge_map(simulate.disk(30.0))
    assert edges.min() >= 0.0
    assert edges.max() <= 1.0
    on, off = (sample_field(edges, circle(radius)) for radius in (30.0, 34.0))
    assert on.min() > 0.75
    assert off.max() < 0.01


def test_the_flow_has_the_steady_state_of_its_source() -> None:
    edges = edge_map(simulate.disk(6.0))
    ours = gradient_vector_flow(edges, DemonsParameters(gvf_mu=0.1, gvf_iterations=4000))
    np.testing.assert_allclose(ours, flow_by_hand(edges, 0.1, 4000), atol=1e-6)


@pytest.mark.parametrize(("radius", "sign"), [(20.0, 1.0), (37.0, -1.0)])
def test_the_flow_points_to_the_edge_from_afar(radius: float, sign: float) -> None:
    flow = gradient_vector_flow(edge_map(simulate.disk(30.0)), DEFAULT)
    points = circle(radius)
    outward = (points - CENTRE) / radius
    push = np.column_stack([sample_field(component, points) for component in flow])
    assert (sign * (push * outward).sum(axis=1) > 0.9 * np.linalg.norm(push, axis=1)).all()


@pytest.mark.parametrize("n", [20, 120, 600])
@pytest.mark.parametrize("radius", [15.0, 29.0, 37.0])
def test_a_snake_settles_on_the_boundary_and_stays(radius: float, n: int) -> None:
    edges = edge_map(simulate.disk(30.0))
    flow = gradient_vector_flow(edges, DEFAULT)
    last = settle(circle(radius, n), edges, flow, DEFAULT)
    assert np.abs(radii(last) - 30.0).max() < 0.5
    after = settle(last, edges, flow, DEFAULT.changed(snake_iterations=1))
    assert np.abs(after - last).max() < 0.05


def test_steps_are_no_longer_than_asked() -> None:
    edges = edge_map(simulate.disk(30.0))
    flow = gradient_vector_flow(edges, DEFAULT)
    start = circle(15.0)
    moved = settle(start, edges, flow, FREE.changed(snake_step=0.5, snake_iterations=4))
    np.testing.assert_allclose(np.linalg.norm(moved - start, axis=1), 2.0, atol=0.05)


def test_a_flow_that_has_not_arrived_moves_nothing() -> None:
    edges = edge_map(simulate.disk(30.0))
    start = circle(10.0)
    moved = settle(start, edges, np.zeros((2, *edges.shape)), FREE)
    np.testing.assert_allclose(moved, start, atol=1e-9)


def test_the_internal_energy_is_that_of_the_circulant_matrix() -> None:
    start = circle(15.0, 30) + np.random.default_rng(0).normal(size=(30, 2))
    spacing = np.linalg.norm(np.roll(start, -1, axis=0) - start, axis=1).mean()
    second = np.roll(np.eye(30), 1, axis=0) + np.roll(np.eye(30), -1, axis=0) - 2.0 * np.eye(30)
    matrix = np.eye(30) - 0.3 / spacing**2 * second + 2.0 / spacing**4 * second @ second
    still = np.zeros((76, 76))
    once = DemonsParameters(snake_iterations=1, snake_tension=0.3, snake_stiffness=2.0)
    moved = settle(start, still, np.stack([still, still]), once)
    np.testing.assert_allclose(moved, np.linalg.solve(matrix, start), atol=1e-9)
