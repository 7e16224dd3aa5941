import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose, assert_array_equal

import cytodisk as cd

DUMBBELL = cd.simulate.dumbbell(14, neck_width=3)


def test_measures_are_those_of_the_windows() -> None:
    windows = cd.edge_windows(DUMBBELL, 5, 40, depth_px=2.0)
    measures = cd.window_measures(windows)
    assert measures["area"].dims == ("layer", "sector")
    assert_array_equal(measures["area"], windows.areas)
    assert_array_equal(measures["eccentricity"], windows.eccentricities)
    assert_array_equal(measures["pieces"], windows.pieces)
    assert measures.attrs["coverage"] == windows.coverage < 1.0
    assert measures["area"].attrs["units"] == "px²"


def test_layers_have_a_plain_twin() -> None:
    windows = cd.edge_windows(DUMBBELL, 5, 40)
    found = cd.measures_by_layer(windows)
    xr.testing.assert_identical(found, cd.measures_by_layer(cd.window_measures(windows)))
    for layer in range(5):
        held = windows.areas[layer] > 0
        areas, shapes = windows.areas[layer][held], windows.eccentricities[layer][held]
        pieces = windows.pieces[layer][held]
        expected = {
            "completeness": held.mean(),
            "area": areas.mean(),
            "area_cv": areas.std() / areas.mean(),
            "eccentricity": shapes.mean(),
            "eccentricity_cv": shapes.std() / shapes.mean(),
            "pieces": pieces.mean(),
            "one_piece": (pieces == 1).mean(),
            "layer_pieces": windows.layer_pieces[layer],
        }
        assert set(expected) == set(found.data_vars)
        for name, value in expected.items():
            assert float(found[name][layer]) == pytest.approx(value, rel=1e-9), name


def test_a_layer_of_empty_windows_is_nan() -> None:
    found = cd.measures_by_layer(cd.edge_windows(cd.simulate.disk(10), 4, 6, depth_px=5.0))
    assert_array_equal(found["completeness"], [1.0, 1.0, 0.0, 0.0])
    for name in ("area", "area_cv", "eccentricity", "eccentricity_cv", "pieces", "one_piece"):
        assert_array_equal(np.isfinite(found[name]), [True, True, False, False], err_msg=name)
    assert_array_equal(found["layer_pieces"], [1, 1, 0, 0])


def test_a_single_window_does_not_vary_for_want_of_others() -> None:
    found = cd.measures_by_layer(cd.polar_windows(2, 1).on(cd.map_to_disk(cd.simulate.disk(8))))
    assert np.isnan(found["area_cv"]).all()
    assert_allclose(found["completeness"], 1.0)


def test_polar_windows_of_a_movie_and_edge_windows_are_sampled_alike() -> None:
    """Edge windows keep the sectors of the tracked edge, so the outermost layers see nearly the same."""
    shown = cd.simulate.movie("translating", 2, frames=4, radius_px=15.0)
    movie = cd.map_movie(shown.masks)
    edge = cd.sample_movie(movie, cd.EdgeGrid(6, 12, 3.0), shown.signal)
    polar = cd.sample_movie(movie, cd.polar_windows(5, 12, "radius"), shown.signal)
    assert edge["mean"].dims == polar["mean"].dims
    held = edge["area"] > 0
    assert not held.sel(layer=5).all()
    assert_array_equal(np.isfinite(edge["mean"].isel(channel=0)), held)
    assert_array_equal(np.isfinite(edge["centroid_y"]), held)
    for name in ("centroid_y", "centroid_x"):
        assert float(abs(edge[name].sel(layer=0) - polar[name].sel(layer=0)).max()) < 1.5
    moved = cd.centroid_displacement(movie, edge)
    assert_array_equal(np.isfinite(moved[:-1]), held[:-1].to_numpy() & held[1:].to_numpy())
