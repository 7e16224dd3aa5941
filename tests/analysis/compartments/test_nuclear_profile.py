import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose, assert_array_equal

import cytodisk as cd

RADIUS, NUCLEUS = 80, 30  # px
NUCLEUS_RADII = ("area", 0.5)


def rings(radius: int = RADIUS, nucleus: int = NUCLEUS, shift: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Masks of a round cell and its round nucleus, so many pixels right of the middle."""
    half = radius + 4
    y, x = np.mgrid[-half : half + 1, -half : half + 1]
    return np.hypot(y, x) <= radius, np.hypot(y, x - shift) <= nucleus


def windows_of(mask: np.ndarray, nucleus: np.ndarray, **settings: object) -> cd.CellWindows:
    return cd.polar_windows(8, 24, nucleus_layers=3).on(cd.map_to_disk(mask, nucleus=nucleus, **settings))


def cytoplasm(profile: xr.Dataset) -> xr.Dataset:
    return profile.isel(layer=profile["compartment"].to_numpy() == "cytoplasm")


@pytest.mark.parametrize("nucleus_radius", NUCLEUS_RADII)
def test_on_the_concentric_disk_a_signal_linear_in_the_share_comes_back_linear(nucleus_radius: str) -> None:
    mask, nucleus = rings()
    y, x = np.indices(mask.shape) - RADIUS - 4
    squared = y**2 + x**2
    signal = 100.0 + 50.0 * (RADIUS**2 - squared) / (RADIUS**2 - NUCLEUS**2)
    windows = windows_of(mask, nucleus, nucleus_radius=nucleus_radius)
    profile = cytoplasm(cd.nuclear_profile(cd.sample(windows, signal)))
    assert_allclose(profile["share"], (np.arange(8) + 0.5) / 8, atol=2e-3)
    slope, level = np.polyfit(profile["share"], profile["mean"], 1)
    assert_allclose(profile["mean"], level + slope * profile["share"], atol=0.15)  # of a rise of 50
    assert (slope, level) == (pytest.approx(50.0, abs=0.5), pytest.approx(100.0, abs=0.5))
    assert float(profile["sd"].max()) < 0.2  # alike all around
    assert_array_equal(profile["n_windows"], 24)


def test_signals_of_the_simulation_come_back_at_their_shares() -> None:
    mask, nucleus = rings()
    signal = cd.simulate.profile_signal(
        mask, nucleus, lambda share: 10 + share**2, along="share", in_nucleus=3
    )
    profile = cd.nuclear_profile(cd.sample(windows_of(mask, nucleus), signal))
    borders = np.arange(9) / 8
    wanted = 10 + np.diff(borders**3) / 3 * 8
    assert_allclose(profile["mean"], [*wanted, 3, 3, 3], atol=2e-3)


def test_layers_have_a_plain_twin() -> None:
    mask, nucleus = cd.simulate.random_pair(4)
    windows = windows_of(mask, nucleus, pixel_size_um=0.5)
    random = np.random.default_rng(0)
    data = cd.sample(windows, random.normal(5.0, 1.0, (2, *mask.shape)))
    profile = cd.nuclear_profile(data)
    assert profile["mean"].dims == ("channel", "layer")
    assert profile["compartment"].to_numpy().tolist() == ["cytoplasm"] * 8 + ["nucleus"] * 3
    for channel in range(2):
        for layer in range(11):
            mean, weight = (
                data["mean"][channel, layer].to_numpy(),
                data["n_pixels"][channel, layer].to_numpy(),
            )
            wanted = np.average(mean, weights=weight)
            sd = np.sqrt(np.average((mean - wanted) ** 2, weights=weight))
            assert float(profile["mean"][channel, layer]) == pytest.approx(wanted, rel=1e-12)
            assert float(profile["sd"][channel, layer]) == pytest.approx(sd, rel=1e-9)
    for name in ("depth", "nucleus_distance"):
        wanted = [np.average(data[name][k], weights=data["area"][k]) for k in range(11)]
        assert_allclose(profile[name], wanted)
        assert profile[name].attrs["units"] == "µm"
    assert_allclose(profile["area"], data["area"].sum("sector"))
    assert np.isnan(profile["sd"]).sum() == 0


def test_layers_run_from_the_membrane_to_the_nucleus_and_into_it() -> None:
    profile = cd.nuclear_profile(cd.sample(windows_of(*rings()), np.ones(rings()[0].shape)))
    outer, inner = cytoplasm(profile), profile.isel(layer=slice(8, None))
    assert (np.diff(outer["depth"]) > 0).all()
    assert (np.diff(outer["nucleus_distance"]) < 0).all()
    assert (np.diff(inner["nucleus_distance"]) > 0).all()
    assert_allclose(outer["depth"] + outer["nucleus_distance"], RADIUS - NUCLEUS, atol=1.0)
    assert_allclose(inner["share"], (np.arange(3) + 0.5) / 3, atol=2e-3)


def test_windows_without_a_number_are_left_out_and_counted() -> None:
    mask, nucleus = rings(30, 12)
    signal = np.ones(mask.shape)
    signal[:, :34] = np.where(mask[:, :34] & ~nucleus[:, :34], np.nan, 1.0)
    profile = cd.nuclear_profile(cd.sample(windows_of(mask, nucleus), signal))
    assert_allclose(profile["mean"], 1.0)
    assert (cytoplasm(profile)["n_windows"] <= 13).all()
    assert_array_equal(profile["n_windows"][8:], 24)
    signal[mask & ~nucleus] = np.nan
    nothing = cytoplasm(cd.nuclear_profile(cd.sample(windows_of(mask, nucleus), signal)))
    assert np.isnan(nothing["mean"]).all()
    assert_array_equal(nothing["n_windows"], 0)


def test_layers_deeper_than_the_cytoplasm_are_nan() -> None:
    mask, nucleus = rings(30, 12)
    grid = cd.polar_windows(sectors=12, depth_um=(2.0, 40.0, 50.0), nucleus_layers=1)
    windows = grid.on(cd.map_to_disk(mask, nucleus=nucleus, pixel_size_um=1.0))
    profile = cd.nuclear_profile(cd.sample(windows, np.ones(mask.shape)))
    assert_array_equal(np.isnan(profile["mean"]), [False, False, True, True, False])
    assert_array_equal(np.isnan(profile["share"]), [False, False, True, True, False])
    assert_array_equal(profile["area"][2:4], 0.0)


def test_a_map_without_a_nucleus_is_refused_with_the_remedy() -> None:
    data = cd.sample(cd.polar_windows(3, 8).on(cd.map_to_disk(cd.simulate.disk(12))), np.ones((41, 41)))
    with pytest.raises(cd.errors.WindowError, match="pass nucleus to map_to_disk and nucleus_layers"):
        cd.nuclear_profile(data)
    with pytest.raises(cd.errors.ParameterError, match="data must be a Dataset"):
        cd.nuclear_profile(np.ones(3))
    nuclear = cd.sample(windows_of(*rings(30, 12)), np.ones((69, 69)))
    with pytest.raises(cd.errors.WindowError, match="data lacks depth"):
        cd.nuclear_profile(nuclear.drop_vars("depth"))
