"""interior="still": what is far from the edge keeps its place in the lab."""

from collections import Counter
from pathlib import Path

import numpy as np
import pytest
import tifffile
from curves import circle, masks_of, polar
from scipy import ndimage

import cytodisk as cd
from cytodisk.disk.cell_mesh import mesh_cell
from cytodisk.disk.mapping_parameters import MappingParameters
from cytodisk.errors import ParameterError
from cytodisk.motion.still_interior import FADE_PX, fade_in_px, origins
from cytodisk.motion.tracking_parameters import MovieSettings
from cytodisk.scale import Scale

STILL = MovieSettings(interior="still")


def inside(mask: np.ndarray, margin: float, n: int = 400) -> np.ndarray:
    """Points of a mask that are deeper than a margin, (row, column)."""
    places = np.argwhere(ndimage.distance_transform_edt(mask) > margin)
    chosen = np.random.default_rng(0).choice(len(places), min(n, len(places)), replace=False)
    return places[chosen].astype(float)


def place_error(movie: cd.DiskMovie, points_yx: np.ndarray) -> np.ndarray:
    """How far points that stand still are from where the last map has them, in pixels."""
    found = movie[-1].to_cell(movie[0].to_disk(points_yx))
    return np.asarray(np.linalg.norm(found - points_yx, axis=1))


def grown(frames: int, speed: float, radius: float = 35.0) -> np.ndarray:
    """Masks of a disk that grows on one side."""
    angle = 2.0 * np.pi * np.arange(1440) / 1440
    away = np.angle(np.exp(1j * (angle - 1.0)))
    directions = np.column_stack([np.sin(angle), np.cos(angle)])
    reach = [radius + speed * time * np.exp(-((away / 0.5) ** 2) / 2.0) for time in range(frames)]
    return masks_of([np.array([60.3, 60.3]) + r[:, None] * directions for r in reach], (150, 150))


def test_under_a_lamellipodium_the_inside_stands_still() -> None:
    masks = grown(21, 1.5)
    points, diameter = inside(masks[0], 1.0), 0.5 * (70.0 + 100.0)
    still = cd.map_movie(masks, interior="still")
    error = place_error(still, points) / diameter
    assert np.median(error) < 0.005
    assert np.percentile(error, 95) < 0.05
    assert all(disk.certificate.valid and disk.start == "previous" for disk in still[1:])
    assert np.median(place_error(cd.map_movie(masks[::4]), points) / diameter) > 0.08


def test_a_leap_of_the_edge_is_done_in_steps() -> None:
    masks = grown(2, 30.0)
    movie = cd.map_movie(masks, interior="still")
    error = place_error(movie, inside(masks[0], 10.0))
    assert np.median(error) < 0.5
    assert movie[1].certificate.valid


def test_a_wider_fade_moves_what_is_deeper() -> None:
    masks = grown(6, 3.0)
    points = inside(masks[0], 8.0)
    errors = [
        np.median(place_error(cd.map_movie(masks, interior="still", fade_um=fade, pixel_size_um=0.5), points))
        for fade in (2.0, 6.0)
    ]
    assert errors[0] < 0.3 * errors[1]


def test_vertices_come_from_where_they_are_but_near_the_edge() -> None:
    cell = mesh_cell(masks_of([circle(30.0)], (121, 121))[0], MappingParameters())
    middle = cell.mesh.vertices_yx[: cell.mesh.n_boundary].mean(axis=0)
    depth = 30.0 - np.linalg.norm(cell.mesh.vertices_yx - middle, axis=1)
    here = cell.mesh.vertices_yx + cell.corner
    smaller = middle + cell.corner + (cell.outline - middle) * 0.8
    came = np.linalg.norm(origins(cell, smaller, 4.0) - here, axis=1)
    np.testing.assert_allclose(came[: cell.mesh.n_boundary], 6.0, atol=0.3)
    assert came[depth > 20.0].max() < 0.3
    # Pushed in by a front that comes 6 px, everything stays in order: no vertex passes the front.
    radius = np.linalg.norm(origins(cell, smaller, 4.0) - middle - cell.corner, axis=1)
    assert radius.max() < 0.8 * 30.9


def test_arms_that_come_where_others_go_are_mapped_and_told(tmp_path: Path) -> None:
    angle = 2.0 * np.pi * np.arange(1440) / 1440
    outlines = [polar(30.0 + sign * 18.0 * np.cos(3.0 * angle)) for sign in (1.0, -1.0)]
    masks = masks_of(outlines, (121, 121))
    tifffile.imwrite(tmp_path / "masks.tif", masks.astype(np.uint8), metadata={"axes": "TYX"})
    study = cd.run_movie(tmp_path / "masks.tif", tmp_path / "out", interior="still", layers=2, sectors=6)
    row = study.cells.iloc[1]
    assert row["certificate_valid"]
    assert row["restarted"] == ""
    assert row["relaxation_start"] != "previous"
    assert "interior relaxed from a harmonic map" in row["notes"]
    assert "of the diameter from where the last map has them" in row["interior_restarted"]
    assert "interior restarts" in {flag.name for flag in cd.qc_flags(study)}
    assert study.cells["interior_restarted"][0] == ""


@pytest.mark.parametrize("speed", [2.0, 9.0])
def test_a_cell_that_migrates_stays_valid(speed: float) -> None:
    frames = int(100 / speed)
    outlines = [circle(16.0, centre=np.array([24.0, 24.0 + speed * time])) for time in range(frames)]
    movie = cd.map_movie(masks_of(outlines, (48, 150)), interior="still")
    assert movie.mapped.all()
    assert all(disk.certificate.valid for disk in movie)
    starts = Counter(disk.start for disk in movie[1:])
    assert starts["previous"] > 0
    last = cd.polar_windows(4, 16).on(movie[-1])
    assert last.areas.min() > 0.0
    assert last.areas.min() < 0.1 * last.areas.mean()


def test_the_fade_needs_a_scale_and_a_still_interior() -> None:
    masks = grown(2, 1.0)
    with pytest.raises(ParameterError, match="fade_um needs a pixel size: pass it as --pixel-size"):
        cd.map_movie(masks, interior="still", fade_um=1.0)
    with pytest.raises(ParameterError, match='fade_um is for interior "still"'):
        cd.map_movie(masks, fade_um=1.0, pixel_size_um=0.1)
    with pytest.raises(ParameterError, match=r'needs method "newton" or .*, got .harmonic'):
        cd.map_movie(masks, interior="still", method="harmonic")
    with pytest.raises(
        ParameterError, match=r"fade_um must be at least the side of a pixel, 0.1 µm, got 0.05"
    ):
        cd.map_movie(masks, interior="still", fade_um=0.05, pixel_size_um=0.1)
    assert fade_in_px(STILL.changed(fade_um=0.3), Scale(0.3)) == pytest.approx(1.0)
    assert fade_in_px(STILL, Scale()) == FADE_PX
    assert fade_in_px(STILL.changed(fade_um=1.5), Scale(0.1)) == pytest.approx(15.0)


def test_a_study_of_still_interiors_tells_and_reads_back(tmp_path: Path) -> None:
    outlines = [circle(12.0, centre=np.array([20.0, 18.0 + 2.0 * time])) for time in range(20)]
    masks = masks_of(outlines, (40, 80))
    tifffile.imwrite(tmp_path / "masks.tif", masks.astype(np.uint8), metadata={"axes": "TYX"})
    grid = {"layers": 3, "sectors": 8}
    settings = {"interior": "still", "fade_um": 0.8, "pixel_size_um": 0.2}
    study = cd.run_movie(tmp_path / "masks.tif", tmp_path / "out", **settings, **grid)
    shares = study.cells["smallest_window_share"]
    assert 0.8 < shares[0] <= 1.0
    assert shares.iloc[-1] < 0.1
    flags = {flag.name: flag for flag in cd.qc_flags(study)}
    assert "strong distortion" not in flags
    assert (study.cells["area_distortion"] > 0.15).any()
    squeezed = [place.frame for place in flags["small still windows"].places]
    assert squeezed == study.cells["frame"][shares < 0.1].tolist()
    read = cd.open_study(tmp_path / "out")
    movie = cd.map_movie(masks, **settings)
    np.testing.assert_array_equal(read.map(0, frame=19).vertices_uv, movie[19].vertices_uv)


def test_a_run_refuses_a_fade_without_a_scale_before_it_writes(tmp_path: Path) -> None:
    tifffile.imwrite(tmp_path / "masks.tif", grown(2, 1.0).astype(np.uint8), metadata={"axes": "TYX"})
    with pytest.raises(ParameterError, match="fade_um needs a pixel size: pass it as --pixel-size"):
        cd.run_movie(tmp_path / "masks.tif", tmp_path / "out", interior="still", fade_um=1.0)
    assert not (tmp_path / "out").exists()


def test_a_study_of_equal_areas_has_no_still_windows(tmp_path: Path) -> None:
    masks = grown(2, 2.0, radius=12.0)
    tifffile.imwrite(tmp_path / "masks.tif", masks.astype(np.uint8), metadata={"axes": "TYX"})
    study = cd.run_movie(tmp_path / "masks.tif", tmp_path / "out", layers=2, sectors=6)
    assert study.cells["smallest_window_share"].isna().all()
    assert (study.cells["interior_restarted"] == "").all()
