import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose

import cytodisk as cd

GRID = cd.polar_windows(8, 24, nucleus_layers=3)


def pair(
    radius: int = 50, nucleus: int = 18, shift: tuple[int, int] = (0, 0)
) -> tuple[np.ndarray, np.ndarray]:
    """Masks of a round cell and its round nucleus, shifted by (rows, columns) out of the middle."""
    half = radius + 4
    y, x = np.mgrid[-half : half + 1, -half : half + 1]
    return np.hypot(y, x) <= radius, np.hypot(y - shift[0], x - shift[1]) <= nucleus


def summary_of(mask: np.ndarray, nucleus: np.ndarray, signal: np.ndarray, **settings: object) -> xr.Dataset:
    disk = cd.map_to_disk(mask, nucleus=nucleus, **settings)
    return cd.nucleus_summary(disk, cd.sample(GRID.on(disk), signal))


def number(summary: xr.Dataset, name: str) -> float:
    return float(summary[name])


@pytest.mark.parametrize("seed", range(6))
def test_even_compartments_give_their_ratio_thirds_and_no_polarity(seed: int) -> None:
    mask, nucleus = cd.simulate.random_pair(seed)
    signal = np.where(nucleus, 30.0, 10.0)
    found = summary_of(mask, nucleus, signal)
    assert number(found, "nucleus_mean") == pytest.approx(30.0, rel=1e-12)
    assert number(found, "cytoplasm_mean") == pytest.approx(10.0, rel=1e-12)
    assert number(found, "nucleus_to_cytoplasm") == pytest.approx(3.0, rel=1e-12)
    wanted = 3.0 * nucleus.sum() / (mask & ~nucleus).sum()
    assert number(found, "ratio_of_totals") == pytest.approx(wanted, rel=1e-9)
    for name in ("perinuclear_share", "peripheral_share"):
        assert number(found, name) == pytest.approx(1 / 3, rel=1e-9)
    assert number(found, "signal_polarity") == pytest.approx(0.0, abs=1e-9)
    assert np.isnan(number(found, "signal_direction"))
    assert "no direction" in str(found["reason"].item())


def test_means_are_those_of_the_pixels() -> None:
    mask, nucleus = cd.simulate.random_pair(7)
    signal = np.random.default_rng(1).gamma(2.0, 5.0, mask.shape)
    found = summary_of(mask, nucleus, signal)
    assert number(found, "nucleus_mean") == pytest.approx(signal[nucleus].mean(), rel=1e-9)
    assert number(found, "cytoplasm_mean") == pytest.approx(signal[mask & ~nucleus].mean(), rel=1e-9)


def test_background_draws_the_ratio_to_one() -> None:
    mask, nucleus = pair()
    signal = np.where(nucleus, 40.0, 10.0)
    assert number(summary_of(mask, nucleus, signal + 20.0), "nucleus_to_cytoplasm") == pytest.approx(2.0)


@pytest.mark.parametrize(
    ("profile", "perinuclear", "peripheral"),
    [
        (lambda share: share, 5 / 9, 1 / 9),
        (lambda share: 1.0 - share, 1 / 9, 5 / 9),
        (lambda share: np.where(share > 2 / 3, 1.0, 0.0), 1.0, 0.0),
        (lambda share: 1.0 + 0.0 * share, 1 / 3, 1 / 3),
    ],
)
def test_shares_of_known_profiles_in_layers_by_thirds(
    profile: object, perinuclear: float, peripheral: float
) -> None:
    mask, nucleus = pair()
    signal = cd.simulate.profile_signal(mask, nucleus, profile, along="share")
    disk = cd.map_to_disk(mask, nucleus=nucleus)
    for layers in (3, 6, 9, 21):  # with others the border of a third cuts through a layer
        data = cd.sample(cd.polar_windows(layers, 12, nucleus_layers=1).on(disk), signal)
        found = cd.nucleus_summary(disk, data)
        assert number(found, "perinuclear_share") == pytest.approx(perinuclear, abs=0.02), layers
        assert number(found, "peripheral_share") == pytest.approx(peripheral, abs=0.02), layers


@pytest.mark.parametrize("layers", [4, 5, 8, 10])
def test_shares_of_a_smooth_profile_hardly_depend_on_the_layers(layers: int) -> None:
    mask, nucleus = pair()
    signal = cd.simulate.profile_signal(mask, nucleus, lambda share: share, along="share")
    disk = cd.map_to_disk(mask, nucleus=nucleus)
    found = cd.nucleus_summary(
        disk, cd.sample(cd.polar_windows(layers, 12, nucleus_layers=1).on(disk), signal)
    )
    assert number(found, "perinuclear_share") == pytest.approx(5 / 9, abs=0.02)


@pytest.mark.parametrize(
    ("shift", "direction"),
    [((0, 15), 180.0), ((0, -15), 0.0), ((15, 0), 270.0), ((-15, 0), 90.0), ((9, 12), 216.87)],
)
def test_place_of_the_nucleus(shift: tuple[int, int], direction: float) -> None:
    mask, nucleus = pair(shift=shift)
    found = cd.nucleus_summary(cd.map_to_disk(mask, nucleus=nucleus, pixel_size_um=0.2))
    assert set(found) == {"nucleus_area", "nucleus_offset", "nucleus_polarity", "nucleus_direction"}
    assert number(found, "nucleus_area") == pytest.approx(0.04 * nucleus.sum())
    assert found["nucleus_area"].attrs["units"] == "µm²"
    assert number(found, "nucleus_offset") == pytest.approx(3.0, abs=1e-6)
    assert number(found, "nucleus_polarity") == pytest.approx(15 / np.sqrt(mask.sum() / np.pi), rel=1e-6)
    assert number(found, "nucleus_direction") == pytest.approx(direction, abs=0.01)


def test_a_nucleus_in_the_middle_has_no_direction() -> None:
    found = cd.nucleus_summary(cd.map_to_disk(pair()[0], nucleus=pair()[1]))
    assert number(found, "nucleus_offset") < 1.0
    assert np.isnan(number(found, "nucleus_direction"))


@pytest.mark.parametrize("align", ["upright", "nucleus", 77.0, (4.0, 30.0)])
@pytest.mark.parametrize(
    ("towards", "relative"), [((0, -1), 0.0), ((0, 1), 180.0), ((1, 0), -90.0), ((-1, 0), 90.0)]
)
def test_polarity_of_a_signal_relative_to_the_nucleus(
    align: object, towards: tuple[int, int], relative: float
) -> None:
    """The nucleus is right of the middle, so the direction from it to the cell's is -x."""
    mask, nucleus = pair(shift=(0, 15))
    y, x = (np.indices(mask.shape) - mask.shape[0] // 2) / 50.0
    found = summary_of(mask, nucleus, 1.0 + 0.5 * (towards[0] * y + towards[1] * x), align=align)
    turned = (number(found, "signal_direction") - relative + 180.0) % 360.0 - 180.0
    assert abs(turned) < 4.0
    assert 0.15 < number(found, "signal_polarity") < 0.25


def test_size_of_a_signals_polarity() -> None:
    mask, nucleus = pair(shift=(0, 3))
    y, x = np.indices(mask.shape) - mask.shape[0] // 2
    found = summary_of(mask, nucleus, 1.0 + 0.6 * np.cos(np.arctan2(y, x) - 1.0))
    assert number(found, "signal_polarity") == pytest.approx(0.3, abs=0.01)


@pytest.mark.parametrize("seed", [4, 10, 15])
def test_mirrored_and_turned_cells_have_the_same_numbers(seed: int) -> None:
    mask, nucleus = cd.simulate.random_pair(seed)
    signal = cd.simulate.profile_signal(mask, nucleus, lambda place: 20 + 30 * place, in_nucleus=80.0)
    signal += 10.0 * np.sin(np.indices(mask.shape)[1] / 9.0)
    straight = summary_of(mask, nucleus, signal)
    sides = {"nucleus_direction": None, "signal_direction": None, "reason": None}
    for mirrored, change in ((True, lambda image: image[:, ::-1]), (False, np.rot90)):
        found = summary_of(*(np.ascontiguousarray(change(image)) for image in (mask, nucleus, signal)))
        for name in set(straight) - set(sides):
            assert number(found, name) == pytest.approx(number(straight, name), rel=0.02, abs=0.01), name
        wanted = (
            180.0 - number(straight, "nucleus_direction")
            if mirrored
            else number(straight, "nucleus_direction") - 90.0
        )
        assert_allclose(np.mod(number(found, "nucleus_direction") - wanted + 1.0, 360.0), 1.0, atol=1e-6)


def test_noise_alone_has_no_direction_but_some_polarity() -> None:
    mask, nucleus = pair(shift=(0, 15))
    disk = cd.map_to_disk(mask, nucleus=nucleus)
    windows = GRID.on(disk)
    random = np.random.default_rng(3)
    images = random.poisson(100.0, (60, *mask.shape)).astype(float)
    found = cd.nucleus_summary(disk, cd.sample(windows, images))
    assert (found["signal_polarity"] > 0.0).all()
    assert np.isnan(found["signal_direction"]).mean() >= 0.9
    assert_allclose(found["nucleus_to_cytoplasm"], 1.0, atol=0.02)


def test_numbers_of_nothing_are_nan_with_a_reason() -> None:
    mask, nucleus = pair()
    for signal, reason in (
        (np.where(nucleus, 5.0, 0.0), "the mean of the cytoplasm is 0 or below"),
        (np.where(nucleus, 5.0, -1.0), "the mean of the cytoplasm is 0 or below"),
    ):
        found = summary_of(mask, nucleus, signal)
        for name in ("nucleus_to_cytoplasm", "ratio_of_totals", "perinuclear_share", "peripheral_share"):
            assert np.isnan(number(found, name)), name
        assert reason in str(found["reason"].item())
        assert number(found, "nucleus_mean") == pytest.approx(5.0)
    found = summary_of(mask, nucleus, np.where(nucleus, -5.0, 1.0))
    assert np.isnan(number(found, "nucleus_to_cytoplasm"))
    assert "the mean of the nucleus is below 0" in str(found["reason"].item())
    assert number(found, "perinuclear_share") == pytest.approx(1 / 3)


def test_a_nucleus_without_signal_has_the_ratio_0() -> None:
    mask, nucleus = pair()
    assert number(summary_of(mask, nucleus, np.where(nucleus, 0.0, 1.0)), "nucleus_to_cytoplasm") == 0.0


def test_too_few_layers_have_no_thirds() -> None:
    mask, nucleus = pair()
    disk = cd.map_to_disk(mask, nucleus=nucleus)
    found = cd.nucleus_summary(
        disk, cd.sample(cd.polar_windows(2, 12, nucleus_layers=1).on(disk), np.ones(mask.shape))
    )
    assert np.isnan(number(found, "perinuclear_share"))
    assert "a layer holds 50% of the cytoplasm" in str(found["reason"].item())
    assert number(found, "nucleus_to_cytoplasm") == pytest.approx(1.0)


def test_channels_have_numbers_of_their_own() -> None:
    mask, nucleus = pair()
    image = xr.DataArray(
        np.stack([np.where(nucleus, 8.0, 1.0), np.where(nucleus, 0.5, 1.0)]),
        {"channel": ["DAPI", "GFP"]},
        ("channel", "y", "x"),
    )
    found = summary_of(mask, nucleus, image)
    assert_allclose(found["nucleus_to_cytoplasm"].sel(channel=["DAPI", "GFP"]), [8.0, 0.5])
    assert found["nucleus_offset"].dims == ()


def test_maps_without_a_nucleus_and_other_data_are_refused() -> None:
    mask, nucleus = pair()
    disk = cd.map_to_disk(mask, nucleus=nucleus)
    plain = cd.sample(cd.polar_windows(3, 8).on(cd.map_to_disk(mask)), np.ones(mask.shape))
    with pytest.raises(cd.errors.WindowError, match="data has no layers of a nucleus"):
        cd.nucleus_summary(disk, plain)
    with pytest.raises(cd.errors.ParameterError, match="disk must be a map"):
        cd.nucleus_summary(mask)
    found = cd.nucleus_summary(cd.map_to_disk(mask))
    assert all(np.isnan(number(found, name)) for name in found)
    frames = cd.sample(GRID.on(disk), np.ones(mask.shape)).expand_dims(time=3)
    with pytest.raises(cd.errors.WindowError, match="data is of 3 frames, disk of one"):
        cd.nucleus_summary(disk, frames)


def test_a_movie_has_the_numbers_of_its_frames() -> None:
    cells, nuclei, frames = [], [], (0, 5, 10, 15)
    for shift in frames:
        mask, nucleus = pair(radius=25, nucleus=9, shift=(0, shift // 2))
        cells.append(mask)
        nuclei.append(nucleus)
    nuclei[2] = np.zeros_like(nuclei[2])  # no nucleus in this frame
    signal = np.array([np.where(nucleus, 4.0 + k, 2.0) for k, nucleus in enumerate(nuclei)])
    movie = cd.map_movie(np.array(cells), nuclei=np.array(nuclei), pixel_size_um=0.5)
    data = cd.sample_movie(movie, cd.polar_windows(4, 12, nucleus_layers=2), signal)
    found = cd.nucleus_summary(movie, data)
    assert found["nucleus_offset"].dims == ("time",)
    assert_allclose(found["nucleus_offset"], [0.0, 1.0, np.nan, 3.5], atol=1e-6)
    assert_allclose(found["nucleus_to_cytoplasm"].squeeze(), [2.0, 2.5, np.nan, 3.5])
    reasons = np.ravel(found["reason"]).tolist()
    assert movie.records[2].reason
    assert reasons[2] == movie.records[2].reason
    profile = cd.nuclear_profile(data)
    assert profile["mean"].dims == ("time", "channel", "layer")
    assert profile["depth"].dims == ("time", "layer")
    assert_allclose(profile["mean"].isel(time=3, channel=0), [2, 2, 2, 2, 7, 7])
    assert np.isnan(profile["mean"].isel(time=2)).all()
    assert profile["depth"].attrs["units"] == "µm"
    with pytest.raises(cd.errors.WindowError, match="data is of 4 frames, disk of one"):
        cd.nucleus_summary(movie[0], data)
    with pytest.raises(cd.errors.WindowError, match="data is of one frame, disk of 4"):
        cd.nucleus_summary(movie, data.isel(time=0))
