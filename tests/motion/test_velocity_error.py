"""Error of velocity: what the movie's jitter tells, against errors that are known."""

import numpy as np
import pytest
from curves import CENTRE, lobed, masks_of
from scipy.ndimage import gaussian_filter1d

from cytodisk import edge_changes, map_movie
from cytodisk.arrays import FloatArray
from cytodisk.motion.velocity_error import error_is, velocity_error

QUICK = {"method": "harmonic", "edge_length": 4.0}


def lasting(steps: int, sectors: int, share: float, random: np.random.Generator) -> FloatArray:
    """Velocities of variance 1 that keep a share of themselves from step to step."""
    noise = random.normal(size=(steps, sectors))
    found = noise.copy()
    for step in range(1, steps):
        found[step] = share * found[step - 1] + np.sqrt(1.0 - share**2) * noise[step]
    return found


def jitter(steps: int, sectors: int, random: np.random.Generator) -> FloatArray:
    """Errors of variance 2 that an outline with errors of variance 1 makes."""
    return np.diff(random.normal(size=(steps + 1, sectors)), axis=0)


def root_mean_square(values: FloatArray) -> float:
    return float(np.sqrt(np.nanmean(np.square(values))))


@pytest.mark.parametrize("share", [0.5, 0.8, 0.95])
@pytest.mark.parametrize("size", [0.3, 1.0, 3.0])
def test_jitter_is_told_from_velocities_that_last(share: float, size: float) -> None:
    random = np.random.default_rng(1001)
    error = size * jitter(60, 40, random)
    found = velocity_error(0.5 * lasting(60, 40, share, random) + error, np.full((60, 40), 5.0))
    assert found.mean() == pytest.approx(root_mean_square(error), rel=0.15)


@pytest.mark.parametrize("width", [1.5, 3.0])
@pytest.mark.parametrize("size", [0.1, 0.5])
def test_jitter_is_told_from_an_edge_that_goes_out_and_comes_back(width: float, size: float) -> None:
    random = np.random.default_rng(1008)
    velocity = np.diff(gaussian_filter1d(random.normal(size=(61, 60)), width / np.sqrt(2.0), axis=0), axis=0)
    error = size * jitter(60, 60, random)
    found = velocity_error(0.8 * velocity / velocity.std() + error, np.full((60, 60), 120.0))
    assert found.mean() == pytest.approx(root_mean_square(error), rel=0.25)


def test_velocities_that_last_are_no_error() -> None:
    random = np.random.default_rng(1002)
    velocity = gaussian_filter1d(random.normal(size=(60, 40)), 4.0, axis=0)
    velocity /= velocity.std()
    assert velocity_error(velocity, np.full((60, 40), 5.0)).max() < 0.12


@pytest.mark.parametrize(("reach", "falls"), [(0.0, 2.0), (50.0, 1.0)])
def test_it_falls_with_the_length_of_a_sector_if_noise_averages_out(reach: float, falls: float) -> None:
    random = np.random.default_rng(1003)
    fine = random.normal(size=(61, 60 * 20))
    if reach:
        fine = gaussian_filter1d(fine, reach, axis=1, mode="wrap")
        fine /= fine.std()
    ends = np.cumsum(np.tile([8, 32], 30))[:-1]  # sectors of 8 and of 32 px, in turn
    position = np.stack([part.mean(axis=1) for part in np.split(fine, ends, axis=1)], axis=1)
    error = np.diff(position, axis=0)
    length = np.broadcast_to(np.tile([8.0, 32.0], 30), error.shape)
    found = velocity_error(error, length)
    assert found[:, ::2].mean() == pytest.approx(root_mean_square(error[:, ::2]), rel=0.25)
    assert found[:, 1::2].mean() == pytest.approx(root_mean_square(error[:, 1::2]), rel=0.25)
    assert found[0, 0] / found[0, 1] == pytest.approx(falls, rel=0.25)


def test_in_a_short_movie_all_change_counts() -> None:
    random = np.random.default_rng(1004)
    velocity, error = lasting(14, 60, 0.9, random), 0.5 * jitter(14, 60, random)
    length = np.full((14, 60), 5.0)
    found = velocity_error(velocity + error, length)
    assert root_mean_square(error) < found.mean() < 1.3 * root_mean_square(error)
    changing = velocity_error(random.normal(size=(14, 60)), length)  # may be real, or not
    assert changing.mean() > 0.7


def test_it_is_never_below_that_of_a_mask_that_is_right_to_the_pixel() -> None:
    found = velocity_error(np.zeros((40, 3)), np.tile([0.5, 12.0, 120.0], (40, 1)))
    assert (found > 0.03).all()
    assert found[0, 0] == pytest.approx(0.11, abs=0.005)
    assert (np.diff(found[0]) < 0.0).all()


def test_steps_that_do_not_follow_one_another_tell_the_least_error() -> None:
    random = np.random.default_rng(1005)
    length = np.full((40, 12), 5.0)
    least = velocity_error(np.zeros((40, 12)), length)
    one = random.normal(size=(1, 12))
    np.testing.assert_allclose(velocity_error(one, length[:1]), least[:1])
    assert error_is(one) == "at least"
    assert np.isnan(velocity_error(np.full((5, 12), np.nan), length[:5])).all()
    every_other = random.normal(size=(40, 12))
    every_other[1::2] = np.nan
    np.testing.assert_allclose(velocity_error(every_other, length)[::2], least[::2])
    assert error_is(every_other) == "at least"
    assert error_is(random.normal(size=(14, 12))) == "at most"
    assert error_is(random.normal(size=(15, 12))) == ""


def test_gaps_have_no_error() -> None:
    random = np.random.default_rng(1005)
    length = np.full((40, 12), 5.0)
    error = jitter(40, 12, random)
    error[[7, 20]] = np.nan
    error[:, 3] = np.nan
    length[:, 3] = 0.0
    found = velocity_error(error, length)
    np.testing.assert_array_equal(np.isnan(found), np.isnan(error))
    assert np.nanmean(found) == pytest.approx(np.sqrt(2.0), rel=0.15)


def test_a_mask_that_leaps_once_does_not_make_all_velocities_uncertain() -> None:
    random = np.random.default_rng(1006)
    error = 0.2 * jitter(60, 40, random)
    error[30, :10] += 12.0
    error[31, :10] -= 12.0
    found = velocity_error(error, np.full((60, 40), 5.0))
    assert found.mean() < 1.4 * 0.2 * np.sqrt(2.0)


@pytest.mark.parametrize("sectors", [8, 12])
def test_few_sectors_are_no_worse_where_short_stretches_tell_the_error(sectors: int) -> None:
    """With the sectors alone, the error of some of these is less than half of what it should be."""
    for seed in range(1000, 1004):
        random = np.random.default_rng(seed)
        noise = gaussian_filter1d(random.normal(size=(41, 240)), 2.0, axis=1, mode="wrap")
        error = np.diff(0.2 * noise / noise.std(), axis=0)
        edge = gaussian_filter1d(random.normal(size=(41, 240)), 1.2, axis=0)
        velocity = np.diff(gaussian_filter1d(edge, 40.0, axis=1, mode="wrap"), axis=0)
        displacement, length = error + 0.8 * velocity / velocity.std(), np.full((40, 240), 1.2)
        by_sector = (each.reshape(40, sectors, -1) for each in (displacement, length, error))
        away, long, wrong = (each.mean(axis=2) for each in by_sector)
        stretches = np.stack([displacement * length, length], axis=1)
        found = velocity_error(away, long * 240 / sectors, stretches)
        assert 0.75 < found.mean() / root_mean_square(wrong) < 1.35


def test_stretches_without_edge_do_not_count() -> None:
    random = np.random.default_rng(1009)
    swept, length = jitter(40, 240, random), np.ones((40, 240))
    swept[:, 40:80] = length[:, 40:80] = 0.0  # on the image's border
    swept[20] = length[20] = np.nan  # tracking starts anew
    away, long = (each.reshape(40, 12, 20).sum(axis=2) for each in (swept, length))
    with np.errstate(invalid="ignore"):
        away /= long
    found = velocity_error(away, long, np.stack([swept, length], axis=1))
    np.testing.assert_array_equal(np.isnan(found), np.isnan(away))
    assert np.isnan(found).sum() == 40 * 2 + 10
    assert np.nanmean(found) == pytest.approx(root_mean_square(away), rel=0.15)


@pytest.mark.parametrize("noise_px", [0.0, 0.5])
def test_it_is_the_error_of_masks(noise_px: float) -> None:
    random = np.random.default_rng(1007)
    outlines = []
    for time in range(24):
        wobble = gaussian_filter1d(random.normal(size=1200), 25.0, mode="wrap")
        wobble *= noise_px * np.sqrt(2.0 * 25.0 * np.sqrt(np.pi))
        shape = lobed(34.0 + 0.31 * time)
        away = shape - CENTRE
        outlines.append(shape + wobble[:, None] * away / np.linalg.norm(away, axis=1)[:, None])
    movie = map_movie(masks_of(outlines, (121, 121)), **QUICK)
    for sectors in (8, 12, 24, 60, 120):
        changes = edge_changes(movie, sectors).isel(time=slice(-1))
        # The radius grows by 0.31 px times what the shape has in that direction; the mean over time has it.
        missed = changes.velocity - changes.velocity.mean("time")
        assert 0.7 < root_mean_square((missed / changes.velocity_error).to_numpy()) < 1.4
