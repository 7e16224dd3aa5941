import numpy as np
import pytest
from scipy import ndimage

from cytodisk import simulate
from cytodisk.errors import ParameterError


def pieces(mask: np.ndarray) -> int:
    return int(ndimage.label(mask, np.ones((3, 3)))[1])


@pytest.mark.parametrize("radius", [10.0, 30.5, 60.0])
def test_a_disk_has_its_area_and_its_margin(radius: float) -> None:
    mask = simulate.disk(radius, margin=5)
    assert mask.sum() == pytest.approx(np.pi * radius**2, rel=0.02)
    rows = np.flatnonzero(mask.any(axis=1))
    assert (rows[0], mask.shape[0] - 1 - rows[-1]) == (5, 5)
    np.testing.assert_array_equal(mask, mask[::-1, ::-1])


def test_an_ellipse_has_its_axes_and_turns_from_x_towards_y() -> None:
    mask = simulate.ellipse((20.0, 50.0), angle=30.0)
    assert mask.sum() == pytest.approx(np.pi * 1000.0, rel=0.02)
    y, x = np.argwhere(mask).T
    (yy, yx), (_, xx) = np.cov(y, x)
    assert np.degrees(0.5 * np.arctan2(2 * yx, xx - yy)) == pytest.approx(30.0, abs=0.5)


@pytest.mark.parametrize(
    "mask", [simulate.star(), simulate.dumbbell(neck_width=1.0), simulate.branching(1), simulate.migrating(3)]
)
def test_drawn_cells_are_in_one_piece_with_a_margin(mask: np.ndarray) -> None:
    assert pieces(mask) == 1
    assert not mask[:8].any()
    assert not mask[:, -8:].any()


def test_a_dumbbell_has_the_neck_it_was_told() -> None:
    mask = simulate.dumbbell(neck_width=5.0)
    assert mask[:, mask.shape[1] // 2].sum() == 5


@pytest.mark.parametrize("kind", simulate.KINDS)
def test_random_masks_repeat_and_differ_by_seed(kind: str) -> None:
    masks = [simulate.random_mask(kind, seed) for seed in range(12)]
    assert all(mask.dtype == bool and mask.any() for mask in masks)
    np.testing.assert_array_equal(masks[3], simulate.random_mask(kind, 3))
    assert len({(mask.shape, mask.tobytes()) for mask in masks}) > 1


def test_a_linear_signal_has_its_mean_at_the_centroid() -> None:
    signal = simulate.linear_signal((40, 60), (2.0, -3.0), 7.0)
    mask = simulate.random_smooth(1, radius=10.0)[:40, :40]
    y, x = np.argwhere(mask).mean(axis=0)
    assert signal[:, :40][: mask.shape[0]][mask].mean() == pytest.approx(7.0 + 2.0 * y - 3.0 * x)


def test_a_ring_signal_depends_on_depth_alone() -> None:
    mask = np.zeros((30, 60), dtype=bool)
    mask[5:25, 5:55] = True
    signal = simulate.ring_signal(mask, peak=10.0, decay_px=4.0, background=2.0)
    np.testing.assert_allclose(signal[~mask], 2.0)
    np.testing.assert_allclose(signal[5:10, 30], 2.0 + 10.0 * np.exp(-(np.arange(5) + 0.5) / 4.0))


def test_the_simulated_cell_counts_what_its_truth_expects() -> None:
    cell = simulate.cell_with_signal(4)
    assert cell.signal.dims == cell.truth.dims == ("channel", "y", "x")
    assert cell.signal.channel.values.tolist() == ["edge", "perinuclear"]
    assert cell.signal.attrs["pixel_size_um"] == 0.16
    assert 14_000 < cell.mask.sum() < 16_000
    assert pieces(cell.mask) == 1
    expected, seen = cell.truth.values[:, cell.mask], cell.signal.values[:, cell.mask]
    error = (seen - expected).sum(axis=1) / np.sqrt(expected.sum(axis=1))
    assert (np.abs(error) < 4.0).all()  # Poisson: the sum's standard deviations
    np.testing.assert_array_equal(cell.signal, simulate.cell_with_signal(4).signal)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: simulate.disk(0.1), "radius must be a number of at least 0.5, got 0.1"),
        (lambda: simulate.disk(10.0, margin=-1), "margin must be"),
        (lambda: simulate.ellipse((1.0, 2.0, 3.0)), "semi_axes must be two numbers"),
        (lambda: simulate.ellipse((0.0, 2.0)), "semi_axes must be a number of at least 0.5, got 0.0"),
        (lambda: simulate.star(0), "arms must be"),
        (lambda: simulate.dumbbell(neck_width=np.nan), "neck_width must be .* got nan"),
        (lambda: simulate.branching(process_width="4"), "process_width must be .* got '4'"),
        (lambda: simulate.random_mask("cube", 0), "kind must be one of smooth, .* got 'cube'"),
        (lambda: simulate.linear_signal((3,)), "shape must be two positive numbers"),
        (lambda: simulate.linear_signal((3, 3), 1.0), "gradient_yx must be two numbers"),
        (lambda: simulate.ring_signal(np.ones((2, 2), bool), decay_px=0.0), "decay_px must be"),
        (lambda: simulate.ring_signal(np.ones(4, bool)), r"mask must be 2D, got shape \(4,\)"),
        (lambda: simulate.cell_with_signal(-1), "seed must be"),
    ],
)
def test_bad_parameters_are_named(call: object, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        call()
