from collections.abc import Callable

import numpy as np
import pytest
import xarray as xr
from curves import CENTRE, circle, evenly, exact, lobed, masks_of, moved

from cytodisk import DiskMovie, boundary_velocity, edge_changes, edge_velocity, map_movie, simulate
from cytodisk.errors import ParameterError, WindowError
from cytodisk.motion.edge import normal_displacement, sector_of
from cytodisk.motion.registration import RigidTransform
from cytodisk.motion.tracking import TrackedBoundary
from cytodisk.simulate import SimulatedMovie

Mapped = Callable[..., tuple[SimulatedMovie, DiskMovie]]
QUICK = {"method": "harmonic", "edge_length": 4.0}


def translating_disk(step: tuple[float, float], register: bool = True) -> DiskMovie:
    outlines = [circle(45.0, 800) + np.array(step) * time for time in range(21)]
    return map_movie(masks_of(outlines, (131, 141)), registration=register, **QUICK)


@pytest.fixture(scope="module")
def translating() -> DiskMovie:
    """A disk that moves 0.5 px/frame down and 1 px/frame to the right."""
    return translating_disk((0.5, 1.0))


@pytest.fixture(scope="module")
def small() -> np.ndarray:
    """Masks of a small cell that grows and turns."""
    outlines = [moved(lobed(14.0 + 0.7 * time), 2.0 * time, (-30.0, -30.0)) for time in range(5)]
    return masks_of(outlines, (62, 60))


@pytest.fixture(scope="module")
def gappy(small: np.ndarray) -> DiskMovie:
    masks = np.concatenate([small, small[:1]])
    masks[2] = False
    return map_movie(masks, **QUICK)


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def mean_normals(movie: DiskMovie, sectors: int) -> np.ndarray:
    """Mean normal of each sector's points by frame, shape (T - 1, S, 2)."""
    sector = sector_of(movie.point_angles, sectors)
    return np.stack(
        [movie.normals_yx[:-1, sector == number].mean(axis=1) for number in range(sectors)], axis=1
    )


@pytest.mark.parametrize("frame", ["lab", "cell"])
def test_a_disk_that_grows_has_velocity_1_everywhere(mapped: Mapped, frame: str) -> None:
    velocity = edge_velocity(mapped("growing", 41)[1], 60, frame=frame)
    assert velocity.shape == (41, 60)
    np.testing.assert_allclose(velocity.mean("time"), 1.0, atol=0.01)
    assert float(velocity.mean()) == pytest.approx(1.0, abs=0.005)


@pytest.mark.parametrize(
    ("step", "register"),
    [
        ((1.0, 1.0), True),
        ((0.5, 1.0), False),
        ((0.5, 1.0), True),
    ],
)
def test_a_moving_disk_has_the_velocity_along_its_normals(step: tuple[float, float], register: bool) -> None:
    movie = translating_disk(step, register)
    velocity = edge_velocity(movie, 24)[:-1].to_numpy()
    expected = (mean_normals(movie, 24) @ np.array(step)).mean(axis=0)
    np.testing.assert_allclose(velocity.mean(axis=0), expected, atol=0.05)
    assert np.ptp(expected) > 2.0


def test_a_moving_lobed_cell_has_the_velocity_along_its_normals() -> None:
    step = np.array([0.5, 1.0])
    outlines = [moved(lobed(), 0.0, step * time) for time in range(21)]
    movie = map_movie(masks_of(outlines, (131, 141)), **QUICK)
    velocity = edge_velocity(movie, 24)[:-1].to_numpy()
    expected = (mean_normals(movie, 24) @ step).mean(axis=0)
    np.testing.assert_allclose(velocity.mean(axis=0), expected, atol=0.05)


def test_a_moving_disk_stays_as_it_is_in_its_own_frame(translating: DiskMovie) -> None:
    velocity = edge_velocity(translating, 24, frame="cell")[:-1].to_numpy()
    np.testing.assert_allclose(velocity.mean(axis=0), 0.0, atol=0.05)


@pytest.mark.parametrize("degrees", [0.0, 2.5])
@pytest.mark.parametrize("step", [(0.0, 0.0), (0.7, -0.3)])
def test_a_rigidly_moving_cell_has_no_velocity_in_its_own_frame(
    degrees: float, step: tuple[float, float]
) -> None:
    outlines = [moved(lobed(), degrees * time, np.array(step) * time) for time in range(21)]
    movie = map_movie(masks_of(outlines, (141, 121)), **QUICK)
    velocity = edge_velocity(movie, 24, frame="cell")[:-1].to_numpy()
    np.testing.assert_allclose(velocity.mean(axis=0), 0.0, atol=0.05)
    lab = edge_velocity(movie, 24)[:-1].to_numpy()
    moves = degrees != 0.0 or step != (0.0, 0.0)
    assert (np.abs(lab.mean(axis=0)).max() > 0.3) == moves


@pytest.mark.parametrize("kind", ["growing", "translating"])
def test_a_movie_backwards_has_the_opposite_velocity(kind: str) -> None:
    shown = simulate.movie(kind, 1, frames=12, signals=False)
    # The shape is the same in the first and in the last frame, and so is the angle of each of its points.
    there, back = (
        edge_velocity(map_movie(masks, **QUICK), 24)[:-1].to_numpy()
        for masks in (shown.masks, shown.masks[::-1])
    )
    assert rms(there) > 0.5
    assert rms(there + back[::-1]) < 0.1


def test_velocity_by_sector_follows_the_truth_of_a_bulging_cell(mapped: Mapped) -> None:
    shown, movie = mapped("bulging", 12)
    velocity = boundary_velocity(movie)[:-1].to_numpy()
    truth = np.empty_like(velocity)
    for time in range(11):
        away = np.square(movie.points_yx[time][:, None] - shown.boundary_yx[time][None]).sum(axis=2)
        truth[time] = shown.normal_displacement_px[time][away.argmin(axis=1)]
    assert np.corrcoef(velocity.ravel(), truth.ravel())[0, 1] > 0.9


@pytest.mark.parametrize(
    ("pixel", "interval", "factor", "unit"),
    [
        (None, None, 1.0, "px/frame"),
        (0.2, None, 0.2, "µm/frame"),
        (None, 4.0, 0.25, "px/s"),
        (0.2, 4.0, 0.05, "µm/s"),
    ],
)
def test_units_follow_what_is_known(
    small: np.ndarray, pixel: float | None, interval: float | None, factor: float, unit: str
) -> None:
    plain = map_movie(small, **QUICK)
    movie = map_movie(small, pixel_size_um=pixel, frame_interval_s=interval, **QUICK)
    for one, other in (
        (edge_velocity(movie, 8), edge_velocity(plain, 8)),
        (boundary_velocity(movie), boundary_velocity(plain)),
    ):
        assert one.attrs == {"units": unit, "frame": "lab"} | movie.scale.attrs
        np.testing.assert_allclose(one, factor * other)
        assert ("time_s" in one.coords) == (interval is not None)
    if interval is not None:
        np.testing.assert_array_equal(one.time_s, 4.0 * np.arange(5))
    changes, plain_changes = (edge_changes(each, 8) for each in (movie, plain))
    area, length = ("px²", "px") if pixel is None else ("µm²", "µm")
    expected = {
        "velocity": (unit, factor),
        "velocity_fastest": (unit, factor),
        "velocity_error": (unit, factor),
        "protruded_area": (area, (pixel or 1.0) ** 2),
        "retracted_area": (area, (pixel or 1.0) ** 2),
        "edge_length": (length, pixel or 1.0),
    }
    assert set(changes.data_vars) == set(expected)
    for name, (its_unit, its_factor) in expected.items():
        assert changes[name].attrs["units"] == its_unit
        np.testing.assert_allclose(changes[name], its_factor * plain_changes[name])


def test_the_last_frame_and_those_beside_a_gap_are_nan(gappy: DiskMovie) -> None:
    whole = [True, False, False, True, True, False]
    changes = edge_changes(gappy, 12)
    for table in (edge_velocity(gappy, 12), boundary_velocity(gappy), *changes.data_vars.values()):
        np.testing.assert_array_equal(np.isfinite(table).all(axis=1), whole)
        np.testing.assert_array_equal(np.isfinite(table).any(axis=1), whole)


def test_no_velocity_where_tracking_starts_anew() -> None:
    movie = map_movie(masks_of([circle(6.0), circle(40.0), circle(40.5)], (121, 121)), **QUICK)
    velocity = edge_velocity(movie, 6)
    np.testing.assert_array_equal(np.isfinite(velocity).all("sector"), [False, True, False])


@pytest.mark.parametrize("growth", [-1.0, 1.0])
def test_boundary_on_the_border_is_left_out(growth: float) -> None:
    outlines = [circle(30.0 + growth * time, centre=CENTRE - [20.0, 0.0]) for time in range(4)]
    masks = masks_of(outlines, (121, 121))[:, 40:]
    movie = map_movie(masks, **QUICK)
    border = movie.on_border
    assert 0.2 < border.mean() < 0.6
    velocity = edge_velocity(movie, 24)
    by_point = boundary_velocity(movie)
    np.testing.assert_array_equal(np.isnan(by_point[:-1]), border[:-1] | border[1:])
    sector = sector_of(movie.point_angles, 24)
    for time in range(3):
        free = np.bincount(sector, ~(border[time] | border[time + 1]), 24)
        found = velocity[time].to_numpy()
        np.testing.assert_array_equal(np.isfinite(found), free > 0)
        assert (free == 0).any()
    inner = velocity[:-1].to_numpy()
    # What is off the border moves by a pixel a frame.
    assert float(np.nanmedian(inner)) == pytest.approx(growth, abs=0.1)
    changes = edge_changes(movie, 24)
    np.testing.assert_array_equal(changes.edge_length[:-1] == 0.0, np.isnan(inner))


def test_points_that_come_onto_the_border_are_left_out_already_before() -> None:
    outlines = [circle(20.0, centre=np.array([23.0 - 2.0 * time, 40.0])) for time in range(5)]
    movie = map_movie(masks_of(outlines, (60, 80)), registration=False, **QUICK)
    border = movie.on_border
    assert (border[1:] & ~border[:-1]).any()
    np.testing.assert_array_equal(np.isnan(boundary_velocity(movie)[:-1]), border[:-1] | border[1:])


def test_growth_is_the_same_however_the_cell_turns_meanwhile() -> None:
    velocity = []
    for degrees in (0.0, 1.0):
        shapes = [lobed(30.0 + 0.5 * time) for time in range(21)]
        outlines = [moved(shape, degrees * time, (0.0, 0.0)) for time, shape in enumerate(shapes)]
        movie = map_movie(masks_of(outlines, (121, 121)), **QUICK)
        velocity.append(edge_velocity(movie, 24, frame="cell")[:-1].mean("time").to_numpy())
    np.testing.assert_allclose(velocity[0], velocity[1], atol=0.15)


@pytest.mark.parametrize(("first", "second"), [(0.0, 0.0), (0.3, 0.5), (2.0, -1.0)])
def test_displacement_in_the_cells_frame_is_that_of_registered_points(first: float, second: float) -> None:
    transforms = RigidTransform(first, 20.0, 3.0), RigidTransform(second, -5.0, 9.0)
    here, there = (
        TrackedBoundary(
            time, exact(transform.inverse(circle(radius))), evenly(exact(circle(radius))), transform
        )
        for time, (transform, radius) in enumerate(zip(transforms, (30.0, 33.0), strict=True))
    )
    np.testing.assert_allclose(normal_displacement(here, there, "cell"), 3.0, atol=1e-3)
    # The mean of both frames' normals, by the lengths of edge that they stand for.
    normals = (30.0 * here.normals_yx + 33.0 * there.normals_yx) / 63.0
    lab = ((there.points_yx - here.points_yx) * normals).sum(axis=1)
    np.testing.assert_allclose(normal_displacement(here, there, "lab"), lab, atol=0.05)
    assert np.ptp(lab) > 2.0


@pytest.mark.parametrize("kind", ["bulging", "neutrophil"])
def test_areas_won_and_lost_are_those_of_the_masks(mapped: Mapped, kind: str) -> None:
    shown, movie = mapped(kind, 12)
    changes = edge_changes(movie, 17)
    before, after = shown.masks[:-1], shown.masks[1:]
    np.testing.assert_array_equal(changes.protruded_area[:-1].sum("sector"), (after & ~before).sum((1, 2)))
    np.testing.assert_array_equal(changes.retracted_area[:-1].sum("sector"), (before & ~after).sum((1, 2)))
    np.testing.assert_allclose(changes.velocity, edge_velocity(movie, 17))
    lengths = movie.lengths_px.sum(axis=1)
    np.testing.assert_allclose(
        changes.edge_length[:-1].sum("sector"), 0.5 * (lengths[1:] + lengths[:-1]), rtol=0.01
    )


def test_areas_in_the_cells_own_frame_leave_its_motion_out() -> None:
    outlines = [moved(lobed(30.0), 0.0, (0.0, 3.0 * time)) for time in range(3)]
    movie = map_movie(masks_of(outlines, (121, 121)), **QUICK)
    lab, cell = (edge_changes(movie, 8, frame=frame) for frame in ("lab", "cell"))
    assert float(lab.protruded_area[:-1].sum()) > 250.0
    assert float(cell.protruded_area[:-1].sum()) < 30.0
    assert cell.attrs["frame"] == "cell"


def test_area_won_is_velocity_times_length_of_a_growing_disk(mapped: Mapped) -> None:
    changes = edge_changes(mapped("growing", 41)[1], 12).isel(time=slice(0, -1))
    won = (changes.protruded_area - changes.retracted_area).mean("time")
    expected = (changes.velocity * changes.edge_length).mean("time")
    np.testing.assert_allclose(won, expected, rtol=0.03)


def test_points_have_their_angles(gappy: DiskMovie) -> None:
    velocity = boundary_velocity(gappy, frame="cell")
    assert velocity.dims == ("time", "point")
    assert velocity.shape == (6, gappy.n_points)
    assert velocity.attrs == {"units": "px/frame", "frame": "cell"}
    np.testing.assert_array_equal(velocity.angle, gappy.point_angles)


@pytest.mark.parametrize("sectors", [1, 7, 60])
def test_sectors_are_means_of_their_points_by_length(translating: DiskMovie, sectors: int) -> None:
    by_sector = edge_velocity(translating, sectors)[3].to_numpy()
    by_point = boundary_velocity(translating)[3].to_numpy()
    assert np.isfinite(by_sector).all()
    n = translating.n_points
    fine = np.repeat(by_point, 700), np.repeat(translating.lengths_px[3], 700)
    # Each point stands for an even arc of the disk; cut into 700 parts, no part lies in two sectors by much.
    part = np.minimum((np.arange(700 * n) + 0.5) * sectors // (700 * n), sectors - 1).astype(int)
    total = np.bincount(part, fine[0] * fine[1], sectors) / np.bincount(part, fine[1], sectors)
    np.testing.assert_allclose(by_sector, total, atol=0.01)


@pytest.mark.parametrize("sectors", [0, -1, 2.5, True, "many", None, 10**12])
@pytest.mark.parametrize("function", [edge_velocity, edge_changes])
def test_bad_sectors_are_refused(
    gappy: DiskMovie, function: Callable[..., xr.DataArray], sectors: object
) -> None:
    with pytest.raises(WindowError, match="sectors must be a whole number from 1 to 100000"):
        function(gappy, sectors)


@pytest.mark.parametrize("function", [edge_velocity, boundary_velocity, edge_changes])
def test_what_is_no_movie_is_refused(function: Callable[..., xr.DataArray]) -> None:
    with pytest.raises(ParameterError, match=r"movie must be a DiskMovie, as map_movie .*, got ndarray"):
        function(np.zeros((3, 9, 9), bool))


@pytest.mark.parametrize("function", [edge_velocity, boundary_velocity, edge_changes])
def test_an_unknown_frame_is_refused(gappy: DiskMovie, function: Callable[..., xr.DataArray]) -> None:
    with pytest.raises(ParameterError, match=r"frame.*'moon'"):
        function(gappy, frame="moon")
