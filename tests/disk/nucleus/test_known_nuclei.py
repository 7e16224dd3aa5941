"""Maps of cells with nuclei whose answers are known on paper."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.stats import spearmanr

import cytodisk as cd
from cytodisk.arrays import FloatArray
from cytodisk.disk.blocks import BlockSystem
from cytodisk.disk.cell_mesh import mesh_cell
from cytodisk.disk.mapping_parameters import MappingParameters
from cytodisk.disk.nucleus.cylinder_start import cylinder_start
from cytodisk.geometry.nucleus_mesh import NucleusMesh
from cytodisk.geometry.polygon import centroid
from cytodisk.simulate import CellWithNucleus, cell_with_nucleus, profile_signal


@pytest.fixture(scope="module")
def concentric() -> CellWithNucleus:
    return cell_with_nucleus("centred", radius_px=60.0, nucleus_share=0.25)


def in_polar(points_yx: FloatArray, centre_yx: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Distance from a centre, and angle from +x towards +y."""
    away = points_yx - centre_yx
    return np.hypot(*away.T), np.arctan2(away[:, 0], away[:, 1])


def turned(angles: FloatArray) -> FloatArray:
    """Angles from -π to π."""
    return np.asarray(np.angle(np.exp(1j * angles)))


def test_a_concentric_nucleus_of_its_own_radius_leaves_the_disk_as_it_is(concentric: CellWithNucleus) -> None:
    disk = cd.map_to_disk(concentric.mask, nucleus=concentric.nucleus, nucleus_radius="area")
    assert disk.nucleus is not None
    assert disk.nucleus.radius == pytest.approx(0.5, abs=0.005)
    pixels = np.argwhere(disk.mask)
    away = (pixels - concentric.centres_yx[0])[:, ::-1] / np.sqrt(disk.mask.sum() / np.pi)
    found = disk.to_disk(pixels)
    assert np.hypot(*(found - away).T).max() < 0.02
    assert np.sqrt(np.square(found - away).sum(axis=1).mean()) < 0.005


@pytest.mark.parametrize("radius", [0.3, 0.5, 0.7])
def test_shares_of_concentric_disks_are_those_on_paper(concentric: CellWithNucleus, radius: float) -> None:
    disk = cd.map_to_disk(concentric.mask, nucleus=concentric.nucleus, nucleus_radius=radius)
    pixels = np.argwhere(disk.mask)
    away, angle = in_polar(pixels.astype(float), concentric.centres_yx[0])
    outer, inner = np.sqrt(disk.mask.sum() / np.pi), np.sqrt(concentric.nucleus.sum() / np.pi)
    uv = disk.to_disk(pixels)
    reached = np.hypot(*uv.T)
    in_nucleus = concentric.nucleus[tuple(pixels.T)]
    share = (1.0 - reached**2) / (1.0 - radius**2)
    known = (outer**2 - away**2) / (outer**2 - inner**2)
    assert_allclose(share[~in_nucleus], known[~in_nucleus], atol=0.03)
    assert_allclose(reached[in_nucleus] / radius, away[in_nucleus] / inner, atol=0.04)
    turn = turned(np.arctan2(uv[:, 1], uv[:, 0]) - angle)[away > 3.0]
    assert np.abs(turn).max() < 0.05


def test_a_signal_linear_in_the_share_comes_back_linear(concentric: CellWithNucleus) -> None:
    signal = profile_signal(
        concentric.mask, concentric.nucleus, lambda share: 10.0 + 80.0 * share, along="share", in_nucleus=7.0
    )
    disk = cd.map_to_disk(concentric.mask, nucleus=concentric.nucleus)
    found = cd.sample(cd.polar_windows(8, 12, nucleus_layers=3).on(disk), signal)["mean"].to_numpy()
    middle = 10.0 + 80.0 * (np.arange(8) + 0.5) / 8  # each layer has an eighth of the cytoplasm
    assert_allclose(found[:8].mean(axis=1), middle, atol=0.5)
    assert_allclose(found[:8], np.broadcast_to(middle[:, None], (8, 12)), atol=2.5)
    assert_allclose(found[8:], 7.0)


def moebius(
    points_yx: FloatArray, membrane_yx: FloatArray, nucleus_yx: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Logarithm of the radius and angle where the eccentric disks are concentric.

    The map (z - a) / (1 - a z) takes the unit disk to itself, and the nucleus to a disk about 0 for the a
    whose mirror image in the nuclear outline is the mirror image in the membrane.
    """
    middle, centre = centroid(membrane_yx), centroid(nucleus_yx)
    outer = np.hypot(*(membrane_yx - middle).T).mean()
    radius = np.hypot(*(nucleus_yx - centre).T).mean() / outer
    towards = complex(*(centre - middle)[::-1]) / outer
    away = abs(towards)
    half = 1.0 + away**2 - radius**2
    a = (half - np.sqrt(half**2 - 4.0 * away**2)) / (2.0 * away)
    z = ((points_yx - middle) @ np.array([1j, 1.0])) / outer / (towards / away)
    w = (z - a) / (1.0 - a * z) * (towards / away)
    return np.log(np.abs(w)), np.angle(w)


@pytest.mark.parametrize("seed", [0, 3])
def test_the_start_of_eccentric_disks_is_the_moebius_map(seed: int) -> None:
    cell = cell_with_nucleus("off centre", seed, radius_px=60.0, nucleus_share=0.1)
    meshed = mesh_cell(cell.mask, MappingParameters(), nucleus=cell.nucleus)
    mesh = meshed.mesh
    assert isinstance(mesh, NucleusMesh)
    membrane, nucleus = mesh.vertices_yx[: mesh.n_boundary], mesh.vertices_yx[mesh.nucleus_boundary]
    log_radius, angle = moebius(mesh.vertices_yx, membrane, nucleus)
    given = np.unwrap(angle[: mesh.n_boundary])
    start = cylinder_start(mesh, given, centroid(nucleus), BlockSystem(mesh))
    ring = ~mesh.vertex_inside
    assert np.abs(turned(start.angles - angle)[ring]).max() < 0.06
    assert np.sqrt(np.mean(turned(start.angles - angle)[ring] ** 2)) < 0.01
    # depth is a function of the logarithm alone, from 0 at the membrane to 1 at the nucleus
    inner = ring.copy()
    inner[: mesh.n_boundary + mesh.n_nucleus] = False
    assert spearmanr(-log_radius[inner], start.depth[inner]).statistic > 0.999
    assert start.depth[: mesh.n_boundary].max() == 0.0
    assert start.depth[mesh.nucleus_boundary].min() == 1.0


def test_a_tiny_nucleus_at_the_middle_of_the_plain_map_changes_next_to_nothing() -> None:
    mask = cd.simulate.random_smooth(3, radius=40.0)
    plain = cd.map_to_disk(mask)
    middle = plain.to_cell(np.zeros((1, 2)))[0]
    nucleus = np.hypot(*(np.indices(mask.shape) - middle[:, None, None])) <= 2.5
    disk = cd.map_to_disk(mask, nucleus=nucleus, nucleus_radius="area")
    pixels = np.argwhere(mask)
    away = np.hypot(*(disk.to_disk(pixels) - plain.to_disk(pixels)).T)
    assert np.median(away) < 0.005
    assert away.max() < 0.04


def test_a_map_with_a_nucleus_turns_and_mirrors_with_the_cell() -> None:
    cell = cell_with_nucleus("bean", 1, shape="spread", radius_px=30.0)
    disk = cd.map_to_disk(cell.mask, nucleus=cell.nucleus)
    pixels = np.argwhere(cell.mask)
    uv = disk.to_disk(pixels)
    last = np.array(cell.mask.shape) - 1
    mirrored = cd.map_to_disk(cell.mask[:, ::-1], nucleus=cell.nucleus[:, ::-1])
    found = mirrored.to_disk(np.column_stack([pixels[:, 0], last[1] - pixels[:, 1]]))
    assert np.hypot(*(found * [-1.0, 1.0] - uv).T).max() < 0.01
    turned_map = cd.map_to_disk(np.rot90(cell.mask, 2), nucleus=np.rot90(cell.nucleus, 2))
    assert np.hypot(*(-turned_map.to_disk(last - pixels) - uv).T).max() < 0.01
