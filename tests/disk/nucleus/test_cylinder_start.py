"""The start in the cytoplasm: Tutte's theorem on the cylinder, with weights for any even depth."""

from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from cytodisk.arrays import FloatArray
from cytodisk.disk.blocks import BlockSystem
from cytodisk.disk.cell_mesh import mesh_cell
from cytodisk.disk.circle import boundary_angles
from cytodisk.disk.mapping_parameters import MappingParameters
from cytodisk.disk.nucleus import cylinder_start as module
from cytodisk.disk.nucleus.cone import TURN
from cytodisk.disk.nucleus.cylinder_start import cylinder_areas, cylinder_start
from cytodisk.disk.nucleus.even_depth import reweighted, reweighted_at_both_ends
from cytodisk.disk.nucleus.outline_angles import LARGEST_GAP, SMALLEST_GAP, is_well_spaced, wound_like
from cytodisk.geometry.nucleus_mesh import NucleusMesh
from cytodisk.simulate import random_pair


class Ring(NamedTuple):
    mesh: NucleusMesh
    system: BlockSystem
    membrane: FloatArray
    centre: FloatArray

    def areas(self, angles: FloatArray, depth: FloatArray, lifts: FloatArray) -> FloatArray:
        return cylinder_areas(angles, depth, lifts, self.mesh.triangles)[~self.mesh.inside]


def ring(seed: int) -> Ring:
    mask, nucleus = random_pair(seed)
    cell = mesh_cell(mask, MappingParameters(edge_length=1.5), nucleus=nucleus)
    assert isinstance(cell.mesh, NucleusMesh)
    assert cell.nucleus is not None
    return Ring(cell.mesh, cell.system, boundary_angles(cell.outline), cell.nucleus.centre)


@pytest.fixture(scope="module", params=[0, 1, 4])
def cytoplasm(request: pytest.FixtureRequest) -> Ring:
    return ring(request.param)


@given(seed=st.integers(0, 10_000), power=st.floats(0.05, 1.0))
@pytest.mark.parametrize("bend", ["power", "random"])
def test_any_increasing_function_of_g_is_harmonic_with_new_weights(
    bend: str, seed: int, power: float, cytoplasm: Ring
) -> None:
    mesh, random = cytoplasm.mesh, np.random.default_rng(seed)
    g = random.random(len(mesh.vertices_yx))
    g[mesh.boundary], g[mesh.nucleus_boundary] = 0.0, 1.0
    order = np.sort(random.random(20))
    depth = g**power if bend == "power" else np.interp(g, np.linspace(0.0, 1.0, 20), order)
    weights = random.uniform(0.1, 2.0, 3 * len(mesh.triangles))
    found = reweighted(mesh, weights, g, depth)
    assert (found > 0.0).all()
    start, end = mesh.triangles.T.ravel(), np.roll(mesh.triangles, -1, axis=1).T.ravel()
    apart = g[start] != g[end]
    flow, new_flow = weights * (g[end] - g[start]), found * (depth[end] - depth[start])
    assert_allclose(new_flow[apart], flow[apart], rtol=1e-9, atol=1e-12)


@given(power=st.floats(0.05, 1.0))
def test_the_start_is_valid_for_any_power(power: float, cytoplasm: Ring) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "POWERS", (power,))
        found = cylinder_start(cytoplasm.mesh, cytoplasm.membrane, cytoplasm.centre, cytoplasm.system)
    assert (cytoplasm.areas(found.angles, found.depth, found.lifts) > 0.0).all()
    assert_allclose(found.angles[cytoplasm.mesh.boundary] % TURN, cytoplasm.membrane % TURN, atol=1e-9)
    assert found.depth[cytoplasm.mesh.boundary].max() == 0.0
    assert found.depth[cytoplasm.mesh.nucleus_boundary].min() == 1.0
    inner = found.depth[cytoplasm.mesh.n_boundary + cytoplasm.mesh.n_nucleus :]
    assert inner.min() > 0.0
    assert found.twist == 0.0


@given(
    seed=st.integers(0, 10_000),
    away=st.floats(-6.0, 6.0),
    before=st.floats(-4.0, 4.0),
)
def test_both_borders_may_be_given(seed: int, away: float, before: float, cytoplasm: Ring) -> None:
    mesh, random = cytoplasm.mesh, np.random.default_rng(seed)
    gaps = random.uniform(0.3, 1.0, mesh.n_nucleus)
    angles = away + TURN * np.append(0.0, np.cumsum(gaps)[:-1]) / gaps.sum()
    found = cylinder_start(mesh, cytoplasm.membrane, cytoplasm.centre, cytoplasm.system, angles, before)
    assert (cytoplasm.areas(found.angles, found.depth, found.lifts) > 0.0).all()
    got = found.angles[mesh.nucleus_boundary]
    assert_allclose(np.exp(1j * got), np.exp(1j * angles), atol=1e-9)
    assert abs(found.twist) < 0.75 * TURN


@given(angle=st.floats(-100.0, 100.0), before=st.floats(-4.7, 4.7))
def test_twists_go_on_from_the_one_before_and_are_never_wound_up(angle: float, before: float) -> None:
    found = wound_like(angle, before)
    assert abs(found) < 0.75 * TURN
    assert (found - angle) / TURN == pytest.approx(round((found - angle) / TURN), abs=1e-9)
    assert abs(found - before) <= 0.5 * TURN + 1e-9 or abs(abs(found - before) - TURN) <= 0.5 * TURN + 1e-9


def test_gaps_of_the_outline_are_neither_half_a_turn_nor_nothing() -> None:
    even = np.linspace(0.0, TURN, 5)[:-1]
    assert is_well_spaced(even)
    assert not is_well_spaced(np.array([0.0, LARGEST_GAP + 0.01, 4.0, 5.0]))
    assert not is_well_spaced(np.array([0.0, 0.5 * SMALLEST_GAP, 2.0, 4.0]))
    assert not is_well_spaced(np.array([0.0, 2.0, 1.9, 4.0]))


@pytest.mark.parametrize("seed", [173, 863, 2674])  # levels with one depth in rounding, and a narrow bay
def test_nearly_singular_cytoplasm_has_a_valid_start(seed: int) -> None:
    cytoplasm = ring(seed)
    found = cylinder_start(cytoplasm.mesh, cytoplasm.membrane, cytoplasm.centre, cytoplasm.system)
    assert (cytoplasm.areas(found.angles, found.depth, found.lifts) > 0.0).all()


@given(seed=st.integers(0, 10_000), power=st.floats(0.05, 1.0))
def test_a_function_that_is_a_power_at_both_ends_is_harmonic_too(
    seed: int, power: float, cytoplasm: Ring
) -> None:
    mesh, random = cytoplasm.mesh, np.random.default_rng(seed)
    g = random.random(len(mesh.vertices_yx))
    rest = 1.0 - g
    few = random.random(len(g)) < 0.3
    rest[few], g[few] = 1e-30 * random.random(few.sum()), 1.0  # told apart by what is left to 1 alone
    weights = random.uniform(0.1, 2.0, 3 * len(mesh.triangles))
    found = reweighted_at_both_ends(mesh, weights, g, rest, power)
    assert (found > 0.0).all()
    start, end = mesh.triangles.T.ravel(), np.roll(mesh.triangles, -1, axis=1).T.ravel()
    left = rest**power / (g**power + rest**power)
    for part, rise, climb, rounding in (
        (few[start] & few[end], rest[end] - rest[start], left[end] - left[start], 1e-36),
        (~few[start] & ~few[end], g[end] - g[start], left[start] - left[end], 1e-12),
    ):
        assert_allclose((found * climb)[part], (weights * rise)[part], rtol=1e-6, atol=rounding)
