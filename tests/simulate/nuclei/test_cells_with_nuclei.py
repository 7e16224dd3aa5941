import numpy as np
import pytest
import shapely
from numpy.testing import assert_allclose, assert_array_equal
from scipy import ndimage

from cytodisk.errors import ParameterError
from cytodisk.geometry.outline import has_one_outline
from cytodisk.geometry.polygon import centroid, signed_area
from cytodisk.simulate import CELL_SHAPES, NUCLEUS_KINDS, cell_with_nucleus
from cytodisk.simulate.nuclei.nucleus_shapes import bean, oval

EIGHT = np.ones((3, 3), dtype=bool)


@pytest.mark.parametrize("shape", CELL_SHAPES)
@pytest.mark.parametrize("kind", NUCLEUS_KINDS)
def test_nuclei_lie_where_their_kind_says(kind: str, shape: str) -> None:
    for seed in range(4):
        cell = cell_with_nucleus(kind, seed, shape=shape)  # type: ignore[arg-type]
        assert has_one_outline(cell.mask)
        assert not (cell.nucleus & ~cell.mask).any()
        assert ndimage.label(cell.nucleus, EIGHT)[1] == (2 if kind == "two" else 1)
        beside = ndimage.binary_dilation(cell.nucleus, EIGHT) & ~cell.mask
        assert beside.any() == (kind == "touching"), seed
        assert 0.03 < cell.nucleus.sum() / cell.mask.sum() < 0.16
        drawn = [centroid(outline) for outline in cell.nuclei_yx]
        assert_allclose(cell.centres_yx, drawn, atol=1e-6)
        middle = np.argwhere(cell.nucleus).mean(axis=0)
        assert_allclose(middle, np.mean(drawn, axis=0), atol=0.5)


@pytest.mark.parametrize("kind", NUCLEUS_KINDS)
@pytest.mark.parametrize("share", [0.01, 0.1, 0.25])
def test_nuclei_of_round_cells_have_the_share_that_was_asked_for(kind: str, share: float) -> None:
    cell = cell_with_nucleus(kind, radius_px=50.0, nucleus_share=share)  # type: ignore[arg-type]
    if kind in ("centred", "off centre", "touching") or share < 0.2:
        assert cell.nucleus.sum() == pytest.approx(share * cell.mask.sum(), rel=0.03, abs=12)
    else:
        assert cell.nucleus.sum() < share * cell.mask.sum()


def test_a_nucleus_in_the_middle_of_a_round_cell_is_a_concentric_disk() -> None:
    cell = cell_with_nucleus(radius_px=60.0, nucleus_share=0.25)
    middle = (np.array(cell.mask.shape) - 1) / 2
    assert_array_equal(cell.centres_yx, [middle])
    radius = np.hypot(*(cell.nuclei_yx[0] - middle).T)
    assert_allclose(radius, np.sqrt(0.25 * cell.mask.sum() / np.pi), rtol=1e-4)


def test_a_nucleus_off_centre_is_close_to_the_membrane() -> None:
    cell = cell_with_nucleus("off centre", seed=3, radius_px=60.0)
    away = np.hypot(*(cell.centres_yx[0] - (np.array(cell.mask.shape) - 1) / 2))
    gap = 60.0 - away - np.sqrt(cell.nucleus.sum() / np.pi)
    assert 2.0 <= gap <= 4.5


def test_shapes_have_the_area_and_the_centre_that_they_are_given() -> None:
    for outline in (oval(50.0, 2.0, 0.3), bean(50.0, 0.3)):
        assert signed_area(outline) == pytest.approx(50.0)
        assert_allclose(centroid(outline), 0.0, atol=1e-9)
    long = oval(100.0, 4.0, angle=np.pi / 6)
    far = long[np.hypot(*long.T).argmax()]
    assert abs(np.degrees(np.arctan2(*far))) == pytest.approx(30.0, abs=1.0)


def test_a_bean_is_hollow_on_one_side() -> None:
    cell = cell_with_nucleus("bean", radius_px=60.0)
    hull = shapely.Polygon(cell.nuclei_yx[0]).convex_hull
    assert cell.nucleus.sum() < 0.93 * hull.area
    assert has_one_outline(cell.nucleus)


def test_the_same_seed_gives_the_same_cell() -> None:
    one, again, other = (cell_with_nucleus("bean", seed, shape="spiky") for seed in (1, 1, 2))
    assert_array_equal(one.nucleus, again.nucleus)
    assert one.mask.shape != other.mask.shape or (one.mask != other.mask).any()


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"kind": "three"}, "kind must be one of"),
        ({"shape": "square"}, "shape must be one of"),
        ({"radius_px": 5.0}, "radius_px must be a number of at least 20"),
        ({"nucleus_share": 0.9}, "nucleus_share must be a number from 0.01 to 0.6"),
        ({"seed": -1}, "seed must be a whole number"),
    ],
)
def test_wrong_arguments(wrong: dict[str, object], said: str) -> None:
    with pytest.raises(ParameterError, match=said):
        cell_with_nucleus(**wrong)  # type: ignore[arg-type]
