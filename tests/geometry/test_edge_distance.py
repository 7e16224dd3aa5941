import numpy as np
import pytest
import shapely
from numpy.testing import assert_allclose

import cytodisk as cd
from cytodisk.geometry.edge_distance import EdgeDistance
from cytodisk.geometry.mask import clean_mask
from cytodisk.geometry.outline import trace_outline
from cytodisk.geometry.placed_mask import PlacedMask
from cytodisk.simulate import KINDS, random_mask


def distance_in(mask: np.ndarray) -> EdgeDistance:
    solid, _ = clean_mask(mask)
    return EdgeDistance(PlacedMask.of(solid), trace_outline(solid))


def places_in(mask: np.ndarray, seed: int = 0) -> np.ndarray:
    pixels = np.argwhere(mask)
    return pixels + np.random.default_rng(seed).uniform(-0.5, 0.5, pixels.shape)


@pytest.mark.parametrize("kind", KINDS)
def test_the_distance_is_that_to_the_outline(kind: str) -> None:
    distance = distance_in(np.pad(random_mask(kind, seed=1003), 2))
    places = places_in(distance.placed.whole)
    polygon = shapely.Polygon(distance.outline_yx)
    exact = shapely.distance(polygon.exterior, shapely.points(places))
    exact[~shapely.contains_xy(polygon, *places.T)] = 0.0
    found = distance.at(places)
    assert (found >= exact - 1e-9).all()
    assert (found - exact).mean() < 0.01
    assert (found - exact).max() < 0.4


def test_pixels_have_the_distance_of_their_centres() -> None:
    distance = distance_in(np.pad(cd.simulate.migrating(seed=4, size=0.3), 2))
    pixels = np.argwhere(distance.placed.whole)
    exact = shapely.distance(shapely.LinearRing(distance.outline_yx), shapely.points(pixels))
    assert_allclose(distance.pixels[distance.inside], exact, atol=0.2)


def test_the_border_of_the_image_is_no_edge_of_the_cell() -> None:
    whole = np.pad(cd.simulate.disk(20), 3)
    row = whole.shape[0] // 2
    cut = distance_in(whole[row:])  # a half disk: its edge is the arc
    places = places_in(cut.placed.whole)
    found = cut.at(places)
    arc = distance_in(whole).at(places + np.array([row, 0]))
    near_the_corner = (places[:, 0] < 2) & (arc < 2)  # half a pixel of the edge there counts as border
    assert_allclose(found[~near_the_corner], arc[~near_the_corner], atol=0.35)
    assert found[np.argmin(np.hypot(places[:, 0], places[:, 1] - whole.shape[1] / 2))] > 18


def test_an_image_without_an_edge_of_the_cell() -> None:
    distance = distance_in(np.ones((9, 12), dtype=bool))
    assert np.isinf(distance.at(np.array([[4.0, 4.0]]))).all()
    assert (distance.nearest == -1).all()
