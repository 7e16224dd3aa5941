from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import cytodisk as cd
from cytodisk.errors import WindowError
from cytodisk.windows.nucleus.nucleus_grid import with_nucleus_of
from cytodisk.windows.polar_windows import PolarGrid
from cytodisk.windows.study_grid import polar_grid_of

SPACINGS = ("area", "radius")


def grid_with(radius: float, *counts: int, spacing: str = "area") -> PolarGrid:
    layers, sectors, nucleus_layers = counts
    grid = cd.polar_windows(layers, sectors, spacing, nucleus_layers=nucleus_layers)
    return replace(grid, nucleus_radius=radius)


def test_layers_of_the_cytoplasm_come_first() -> None:
    grid = cd.polar_windows(layers=8, sectors=60, nucleus_layers=3)
    assert (grid.layers, grid.cytoplasm_layers, grid.nucleus_layers, grid.n_windows) == (11, 8, 3, 660)
    assert grid.compartments.tolist() == ["cytoplasm"] * 8 + ["nucleus"] * 3


def test_a_grid_without_nucleus_has_one_compartment() -> None:
    grid = cd.polar_windows(3, 8)
    assert (grid.nucleus_layers, grid.compartments.tolist()) == (0, ["cell"] * 3)


@given(radius=st.floats(0.05, 0.95), layers=st.integers(1, 100), nucleus_layers=st.integers(1, 50))
def test_windows_of_a_compartment_have_equal_areas(radius: float, layers: int, nucleus_layers: int) -> None:
    grid = grid_with(radius, layers, 7, nucleus_layers)
    areas = -np.diff(grid.radii**2)
    assert (grid.radii[0], grid.radii[layers], grid.radii[-1]) == (1.0, radius, 0.0)
    np.testing.assert_allclose(areas[:layers], (1 - radius**2) / layers, rtol=1e-11)
    np.testing.assert_allclose(areas[layers:], radius**2 / nucleus_layers, rtol=1e-11)
    np.testing.assert_allclose(grid.area_shares[:layers], 1 / (7 * layers), rtol=1e-11)
    np.testing.assert_allclose(grid.area_shares[layers:], 1 / (7 * nucleus_layers), rtol=1e-11)


def test_radius_spacing_has_equal_widths_in_each_compartment() -> None:
    radii = grid_with(0.4, 3, 1, 2, spacing="radius").radii
    np.testing.assert_allclose(radii, [1.0, 0.8, 0.6, 0.4, 0.2, 0.0])


@given(
    radius=st.floats(0.05, 0.95),
    counts=st.tuples(st.integers(1, 60), st.integers(1, 120), st.integers(1, 30)),
    spacing=st.sampled_from(SPACINGS),
)
def test_the_middle_of_every_window_lies_in_it(
    radius: float, counts: tuple[int, int, int], spacing: str
) -> None:
    grid = grid_with(radius, *counts, spacing=spacing)
    np.testing.assert_array_equal(grid.window_of(grid.centres_uv), np.arange(grid.n_windows))


def test_the_nuclear_outline_belongs_to_the_cytoplasm() -> None:
    grid = grid_with(0.5, 2, 1, 1)
    assert grid.window_of(np.array([[0.5, 0.0], [np.nextafter(0.5, 0.0), 0.0]])).tolist() == [1, 2]


def test_layers_deeper_than_the_cytoplasm_are_absent() -> None:
    grid = cd.polar_windows(sectors=4, depth_um=(0.5, 1.0, 2.0), nucleus_layers=2)
    assert grid.layers == 6
    on_cell = replace(grid, borders=(0.8, 0.5, 0.5), nucleus_radius=0.5)
    assert on_cell.present.tolist() == [True, True, False, False, True, True]
    assert on_cell.window_of(np.array([[0.5, 0.1], [0.499, 0.0]])).tolist() == [4, 16]
    np.testing.assert_allclose(on_cell.area_shares.sum() * 4, 2.0)


def test_radii_with_a_nucleus_need_a_cell() -> None:
    with pytest.raises(WindowError, match=r"with nucleus_layers differ.*grid\.on\(disk\)\.grid"):
        _ = cd.polar_windows(3, 4, nucleus_layers=1).radii


@pytest.mark.parametrize("value", [0, -1, 2.5, True, "3"])
def test_a_wrong_number_of_nucleus_layers_is_refused(value: object) -> None:
    with pytest.raises(WindowError, match=r"nucleus_layers.*from 1 to 100000"):
        cd.polar_windows(3, 4, nucleus_layers=value)


def test_too_many_windows_are_refused_with_those_of_the_nucleus() -> None:
    with pytest.raises(WindowError, match=r"\(layers \+ nucleus_layers\) × sectors.*\(99 \+ 2\) × 100000"):
        cd.polar_windows(99, 100_000, nucleus_layers=2)


def test_a_grid_and_a_map_of_which_one_has_a_nucleus_do_not_fit() -> None:
    plain = cd.map_to_disk(cd.simulate.disk(8))
    with pytest.raises(WindowError, match=r"2 nucleus_layers.*no nucleus.*leave nucleus_layers out"):
        cd.polar_windows(3, 4, nucleus_layers=2).on(plain)
    with_nucleus = SimpleNamespace(nucleus=SimpleNamespace(radius=0.3))
    with pytest.raises(WindowError, match=r"the map has a nucleus.*pass nucleus_layers"):
        with_nucleus_of(cd.polar_windows(3, 4), with_nucleus)  # type: ignore[arg-type]
    fitting = cd.polar_windows(3, 4, nucleus_layers=2)
    assert with_nucleus_of(fitting, with_nucleus).nucleus_radius == 0.3  # type: ignore[arg-type]


@pytest.mark.parametrize(("radius", "expected"), [(0.5, 0.5), ("area", None), (None, None)])
def test_the_grid_of_a_study_has_the_radius_of_all_its_nuclei(radius: object, expected: object) -> None:
    parameters = {"layers": 3, "sectors": 8, "nucleus_layers": 2, "nucleus_radius": radius}
    grid = polar_grid_of({"parameters": parameters})
    assert (grid.layers, grid.nucleus_layers, grid.nucleus_radius) == (5, 2, expected)
