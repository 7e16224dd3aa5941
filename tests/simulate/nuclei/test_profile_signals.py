import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from cytodisk.errors import ParameterError
from cytodisk.simulate import between_nucleus_and_membrane, cell_with_nucleus, profile_signal

CELL = cell_with_nucleus("centred", radius_px=60.0, nucleus_share=0.25)
CYTOPLASM = CELL.mask & ~CELL.nucleus
RADIUS = np.hypot(*(np.indices(CELL.mask.shape) - (np.array(CELL.mask.shape)[:, None, None] - 1) / 2))


def test_places_of_concentric_disks_are_those_on_paper() -> None:
    outer, inner = np.sqrt(CELL.mask.sum() / np.pi), np.sqrt(CELL.nucleus.sum() / np.pi)
    known = {
        "depth": outer - RADIUS,
        "nucleus distance": RADIUS - inner,
        "ratio": (outer - RADIUS) / (outer - inner),
        "share": (outer**2 - RADIUS**2) / (outer**2 - inner**2),
    }
    tolerance = {"depth": 0.8, "nucleus distance": 0.8, "ratio": 0.03, "share": 0.03}
    for along, values in known.items():
        place = between_nucleus_and_membrane(CELL.mask, CELL.nucleus, along)  # type: ignore[arg-type]
        assert_array_equal(np.isfinite(place), CYTOPLASM)
        assert_allclose(place[CYTOPLASM], values[CYTOPLASM], atol=tolerance[along])


def test_shares_are_spread_evenly() -> None:
    cell = cell_with_nucleus("off centre", seed=1, shape="spread")
    place = between_nucleus_and_membrane(cell.mask, cell.nucleus, "share")
    counts, _ = np.histogram(place[np.isfinite(place)], bins=np.linspace(0, 1, 9))
    assert_allclose(counts / counts.sum(), 1 / 8, atol=0.01)


def test_the_nearest_of_two_nuclei_counts_and_the_image_border_is_none() -> None:
    mask, nucleus = np.ones((7, 30), dtype=bool), np.zeros((7, 30), dtype=bool)
    nucleus[3, 2] = nucleus[3, 20] = True
    place = between_nucleus_and_membrane(mask, nucleus, "nucleus distance")
    assert_allclose(place[3, [3, 19, 21, 29]], [0.5, 0.5, 0.5, 8.5])


def test_a_signal_is_its_profile() -> None:
    signal = profile_signal(
        CELL.mask, CELL.nucleus, lambda share: 10.0 * share, along="share", in_nucleus=30.0, background=5.0
    )
    assert set(np.unique(signal[~CELL.mask])) == {5.0}
    assert set(np.unique(signal[CELL.nucleus])) == {35.0}
    share = between_nucleus_and_membrane(CELL.mask, CELL.nucleus, "share")
    assert_allclose(signal[CYTOPLASM], 5.0 + 10.0 * share[CYTOPLASM])
    assert signal[CYTOPLASM].mean() == pytest.approx(10.0)


def test_noise_is_that_of_photons_and_of_its_seed() -> None:
    flat, noisy, again, other = (
        profile_signal(CELL.mask, CELL.nucleus, np.ones_like, background=99.0, noise_seed=seed)
        for seed in (None, 1, 1, 2)
    )
    assert_array_equal(noisy, again)
    assert (noisy != other).any()
    assert noisy[CYTOPLASM].std() == pytest.approx(10.0, rel=0.05)
    assert noisy[CYTOPLASM].mean() == pytest.approx(flat[CYTOPLASM].mean(), rel=0.01)


def test_wrong_inputs() -> None:
    with pytest.raises(ParameterError, match="along must be one of"):
        between_nucleus_and_membrane(CELL.mask, CELL.nucleus, "radius")  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match="of one shape"):
        between_nucleus_and_membrane(CELL.mask, CELL.nucleus[:-1])
    with pytest.raises(ParameterError, match="nucleus and a cytoplasm"):
        between_nucleus_and_membrane(CELL.mask, CELL.mask)
    with pytest.raises(ParameterError, match="profile must return as many values"):
        profile_signal(CELL.mask, CELL.nucleus, lambda place: place[:3])
    with pytest.raises(ParameterError, match="signal must be a number of at least 0"):
        profile_signal(CELL.mask, CELL.nucleus, np.negative, noise_seed=0)
