"""Signals without biology, stressed series, faulty masks and cells with a cortex: their known statistics."""

import numpy as np
import pytest
from scipy import ndimage

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import MaskError, ParameterError
from cytodisk.simulate import (
    PASSIVE_KINDS,
    STRESS_KINDS,
    cell_with_cortex,
    coupled_series,
    flipped_masks,
    independent_series,
    movie,
    passive_signal,
    scaled_up_masks,
)
from cytodisk.simulate.passive_signals import PassiveKind
from cytodisk.simulate.stress_series import StressKind


@pytest.fixture(scope="module")
def masks() -> BoolArray:
    return movie("fluctuating", 2, frames=12, radius_px=22.0, protrusion_px=7.0, signals=False).masks


def series(kind: StressKind, seed: int, frames: int = 200) -> tuple[FloatArray, FloatArray]:
    activity, velocity = independent_series(kind, seed, frames, 3, 24, correlation_length=0.3)
    return activity.to_numpy(), velocity.to_numpy()


@pytest.mark.parametrize("kind", PASSIVE_KINDS)
def test_a_pattern_stands_still_or_goes_with_the_mask(kind: PassiveKind, masks: BoolArray) -> None:
    clean = passive_signal(kind, masks, 1, noise=0.0).to_numpy()
    assert clean.max() <= (100.0 if kind != "texture" else 130.0)
    changed = np.abs(np.diff(clean, axis=0)).max()
    assert (changed > 5.0) == (kind in ("cortex", "thickness"))
    noisy = passive_signal(kind, masks, 1).to_numpy() - clean
    assert noisy.std() == pytest.approx(3.0, rel=0.03)
    assert abs(np.mean(noisy[1:] * noisy[:-1])) < 0.2


def test_patterns_have_their_form(masks: BoolArray) -> None:
    share = masks.mean(axis=0)
    centre = np.round(ndimage.center_of_mass(share)).astype(int)
    radius = np.sqrt(masks.sum() / len(masks) / np.pi)
    still, ring, cortex = (
        passive_signal(kind, masks, noise=0.0).to_numpy() for kind in ("still", "ring", "cortex")
    )
    assert still[0, *centre] > 90.0
    away = np.hypot(*(np.indices(share.shape) - np.reshape(centre, (2, 1, 1))))
    assert still[0][np.abs(away - radius) < 0.5].mean() == pytest.approx(100.0 * np.exp(-1.0 / 0.55), rel=0.1)
    assert away[ring[0] > 90.0].mean() == pytest.approx(0.95 * radius, abs=0.7)
    depth = ndimage.distance_transform_edt(masks[3]) - 0.5
    inside = masks[3]
    np.testing.assert_allclose(cortex[3][inside], 100.0 * np.exp(-depth[inside] / 5.0), rtol=1e-9)
    assert not cortex[3][~inside].any()


def test_bleaching_takes_its_share_and_the_seed_draws(masks: BoolArray) -> None:
    signal = passive_signal("uniform", masks, noise=0.0, bleaching=0.4).to_numpy()
    assert signal[0].mean() == 100.0
    assert signal[-1].mean() == pytest.approx(60.0)
    first, again, other = (passive_signal("texture", masks, seed) for seed in (1, 1, 2))
    assert first.identical(again)
    assert not np.array_equal(first, other)


def test_a_pulse_comes_once_at_the_same_frames_everywhere() -> None:
    for seed in range(5):
        activity, velocity = series("pulse", seed)
        high = [np.flatnonzero(values > 3.5) for values in (velocity.mean(1), activity.mean((1, 2)))]
        assert len(high[0]) == 3
        assert np.ptp(high[0]) == 2
        np.testing.assert_array_equal(*high)


def test_an_episode_is_restless_and_a_variance_rises_in_both() -> None:
    for kind in ("restless", "rising"):
        size = [
            np.stack([np.abs(series(kind, seed)[k]).reshape(200, -1).mean(1) for seed in range(6)])
            for k in (0, 1)
        ]
        for one, other in zip(*size, strict=True):
            assert np.corrcoef(one, other)[0, 1] > 0.8
        if kind == "rising":
            mean = size[0].mean(axis=0)
            assert mean[-20:].mean() / mean[:20].mean() == pytest.approx(3.7 / 1.15, rel=0.1)
        else:
            loud = size[0] > 1.5
            np.testing.assert_allclose(loud.sum(axis=1), 20, atol=1)
            assert size[0][loud].mean() / size[0][~loud].mean() == pytest.approx(3.0, rel=0.1)


def test_steady_oscillators_never_lose_their_phase() -> None:
    for values in series("steady", 1, 400):
        flat = values.reshape(400, -1)
        late = (flat[:-300] * flat[300:]).mean(axis=0)  # thirty periods on
        assert late.mean() == pytest.approx(0.5, abs=0.05)
        assert flat.var() == pytest.approx(1.0, abs=0.05)
        phase = np.angle((flat * np.exp(-2j * np.pi * np.arange(400) / 10.0)[:, None]).mean(axis=0))
        assert np.abs(np.exp(1j * phase).mean()) < 0.5  # each its own


def test_tails_are_heavy() -> None:
    values = series("heavy tails", 1, 2000)[0]
    assert (np.abs(values) > 4.0 * values.std()).mean() > 20.0 * 6.3e-5
    assert np.median(values) == pytest.approx(0.0, abs=0.02)


@pytest.mark.parametrize("kind", STRESS_KINDS)
def test_stressed_series_know_nothing_of_each_other(kind: StressKind) -> None:
    found = []
    for seed in range(40):
        activity, velocity = series(kind, seed, 60)
        # What all windows share is taken out: it is the stress, not the windows, that correlates.
        activity = activity - activity.mean(axis=(1, 2), keepdims=True)
        velocity = velocity - velocity.mean(axis=1, keepdims=True)
        found.append((activity * velocity[:, None]).mean() / activity.std() / velocity.std())
    assert abs(np.mean(found)) < 0.02


def test_stress_is_no_kind_of_coupled_series() -> None:
    with pytest.raises(ParameterError, match="kind"):
        coupled_series("pulse", 0, 30, 2, 4, lag_frames=1, windows=np.ones((2, 4), bool))  # type: ignore[arg-type]


@pytest.mark.parametrize("share", [0.05, 0.5])
def test_pixels_beside_the_edge_flip_with_their_share(share: float, masks: BoolArray) -> None:
    spoilt = flipped_masks(masks, share, 3)
    cross = ndimage.generate_binary_structure(2, 1)
    for mask, other in zip(masks, spoilt, strict=True):
        beside = ndimage.binary_dilation(mask, cross) & ~ndimage.binary_erosion(mask, cross)
        assert not (mask ^ other)[~beside].any()
        assert ndimage.label(other)[1] == 1
    assert (masks ^ spoilt).sum() / len(masks) > 0.6 * share * 260.0
    changed = (masks ^ spoilt)[1:] & (masks ^ spoilt)[:-1]
    assert changed.sum() < 0.8 * (masks ^ spoilt)[1:].sum()  # anew in each frame


@pytest.mark.parametrize("factor", [1, 4, 7])
def test_scaled_up_masks_go_in_steps_and_keep_their_area(factor: int, masks: BoolArray) -> None:
    coarse = scaled_up_masks(masks, factor)
    assert coarse.shape == masks.shape
    rows = np.flatnonzero(np.any(coarse[:, 1:] != coarse[:, :-1], axis=(0, 2))) + 1
    assert not (rows % factor).any()
    assert coarse.sum() == pytest.approx(masks.sum(), rel=0.03)


@pytest.mark.parametrize("radius", [4.0, 8.0, 12.0, 20.0])
def test_one_cortex_in_cells_of_any_size(radius: float) -> None:
    cell = cell_with_cortex(radius)
    assert np.sqrt(cell.mask.sum() / np.pi) * 0.16 == pytest.approx(radius, rel=0.02)
    depth = (ndimage.distance_transform_edt(cell.mask) - 0.5) * 0.16
    expected = cell.truth.to_numpy()[0]
    at = cell.mask & (np.abs(depth - 1.0) < 0.08)
    assert expected[at].mean() == pytest.approx(100.0 / np.e, rel=0.06)  # pixels know depth to 0.2 px
    np.testing.assert_array_equal(cell.signal.to_numpy()[0][~cell.mask], 0)


def test_bad_arguments_are_named(masks: BoolArray) -> None:
    with pytest.raises(ParameterError, match="kind"):
        passive_signal("bright", masks)  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match="noise"):
        passive_signal("still", masks, noise=-1.0)
    with pytest.raises(ParameterError, match="share"):
        flipped_masks(masks, 0.6)
    with pytest.raises(ParameterError, match="factor"):
        scaled_up_masks(masks, 0)
    with pytest.raises(ParameterError, match="radius_um"):
        cell_with_cortex(0.5)
    for wrong in (masks[0], np.zeros_like(masks)):
        with pytest.raises(MaskError, match="masks must be 3D"):
            passive_signal("still", wrong)
    with pytest.raises(MaskError, match="masks must be 3D"):
        flipped_masks(masks[0], 0.1)
