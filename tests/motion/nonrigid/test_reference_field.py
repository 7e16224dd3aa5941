"""Registration to the first frame: where places come from is known."""

from itertools import pairwise

import numpy as np
import pytest

import cytodisk as cd
from cytodisk.motion.nonrigid.reference_field import ReferenceField, fields_to_reference
from cytodisk.motion.registration import RigidTransform

pytest.importorskip("SimpleITK")


def blob(shape: tuple[int, int], centre: tuple[float, float], stretch: float = 1.0) -> np.ndarray:
    """A cell without symmetry, stretched along x."""
    y, x = np.mgrid[: shape[0], : shape[1]]
    y, x = (y - centre[0]) / 14.0, (x - centre[1]) / (14.0 * stretch)
    angle = np.arctan2(y, x)
    return np.hypot(y, x) < 1.0 + 0.15 * np.cos(2 * angle + 0.4) + 0.1 * np.cos(3 * angle)


def test_a_cell_that_moves_as_a_whole_comes_from_where_it_was() -> None:
    masks = np.stack([blob((60, 80), (28, 28 + 4 * step)) for step in range(4)])
    fields = list(fields_to_reference(cd.map_movie(masks, method="harmonic")))
    assert [field.frame for field in fields] == [0, 1, 2, 3]
    inside = np.argwhere(masks[0]).astype(float)
    for step, field in enumerate(fields):
        there = field.to_reference(inside + np.array([0, 4 * step]))
        assert np.linalg.norm(there - inside, axis=1).max() < 1.0
        assert field.folded == 0.0
        assert field.outside < 0.02


def test_a_stretched_cell_is_followed_by_the_field() -> None:
    """It grows by a fifth along x: on the long axis places come from 1 / 1.2 of their distance."""
    stretches = (1.0, 1.1, 1.2)
    masks = np.stack([blob((60, 80), (30, 40), stretch) for stretch in stretches])
    movie = cd.map_movie(masks, method="harmonic", registration=False)
    *_, last = fields_to_reference(movie)
    edge = np.array([[30.0, x] for x in (np.argwhere(masks[2, 30]).min(), np.argwhere(masks[2, 30]).max())])
    expected = [[30.0, x] for x in (np.argwhere(masks[0, 30]).min(), np.argwhere(masks[0, 30]).max())]
    np.testing.assert_allclose(last.to_reference(edge), expected, atol=1.0)
    assert last.masks[0].sum() == pytest.approx(masks[2].sum(), rel=0.02)


def test_a_field_that_folds_is_counted_where_it_does() -> None:
    """x goes to x - 2 sin x around a few columns: there neighbours change places."""
    columns = np.arange(40.0)
    shift = np.where(np.abs(columns - 20) < 5, -2.0 * (columns - 20), 0.0)
    displacement = np.stack([np.zeros((30, 40)), np.tile(shift, (30, 1))])
    masks = np.ones((2, 30, 40), dtype=bool)
    still = RigidTransform()
    field = ReferenceField(1, displacement, np.zeros(2), still, still, masks)
    assert field.turned_over[:, 17:24].all()
    assert not field.turned_over[:, :14].any()
    assert field.folded == pytest.approx(field.turned_over[0].mean())
    assert field.outside == 0.0


def test_what_is_carried_out_of_the_cell_is_counted() -> None:
    masks = np.zeros((2, 20, 20), dtype=bool)
    masks[0, :, :10], masks[1] = True, True
    still = RigidTransform()
    field = ReferenceField(1, np.zeros((2, 20, 20)), np.zeros(2), still, still, masks)
    assert field.outside == 0.5


def test_frames_without_a_cell_are_left_out() -> None:
    masks = np.stack([blob((60, 60), (30, 30))] * 3)
    masks[1] = False
    fields = list(fields_to_reference(cd.map_movie(masks, method="harmonic"), iterations=5, warm_start=False))
    assert [field.frame for field in fields] == [0, 2]
    for here, there in pairwise(fields):
        np.testing.assert_allclose(here.displacement, there.displacement, atol=1e-6)
