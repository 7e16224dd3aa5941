"""Nuclei of which narrow bays of cytoplasm reach far in: 1 - g is below the last digit of 1 there."""

import numpy as np
import pytest

import cytodisk as cd
from cytodisk.arrays import BoolArray


def halves(slit_px: int, radius: int = 18, cell_radius: int = 30) -> tuple[BoolArray, BoolArray]:
    """A round cell, and its nucleus cut in two by a slit."""
    y, x = np.mgrid[:66, :66] - 33
    return y**2 + x**2 < cell_radius**2, (y**2 + x**2 < radius**2) & ((y < 0) | (y >= slit_px))


@pytest.mark.parametrize("slit_px", [2, 3])
def test_joined_halves_of_a_nucleus_are_mapped_one_to_one(slit_px: int) -> None:
    cell, nucleus = halves(slit_px)
    disk = cd.map_to_disk(cell, nucleus, several="join")
    assert disk.certificate.valid
    points = np.argwhere(cell & ~nucleus) + 0.0
    np.testing.assert_allclose(disk.to_cell(disk.to_disk(points)), points, atol=1e-6)
    windows = cd.polar_windows(6, 24, nucleus_layers=2).on(disk)
    assert (windows.areas > 0).all()
    assert windows.areas.sum() == pytest.approx(cell.sum())
