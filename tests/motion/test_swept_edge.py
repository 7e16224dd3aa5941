"""Velocity of outlines whose motion is known: it accounts for the area, and no protrusion is lost."""

from pathlib import Path

import numpy as np
import pytest
import shapely
from curves import CENTRE, circle, evenly, exact, lobed, masks_of, moved, polar
from hypothesis import given, settings
from hypothesis import strategies as st

from cytodisk import DiskMovie, edge_changes, map_movie
from cytodisk.arrays import FloatArray
from cytodisk.motion.edge import sector_of
from cytodisk.motion.following import map_frames
from cytodisk.motion.frame_file import load_boundary, save_frame
from cytodisk.motion.swept_edge import SweptEdge, swept_edge
from cytodisk.motion.tracking import TrackedBoundary
from cytodisk.motion.tracking_parameters import MovieSettings

QUICK = {"method": "harmonic", "edge_length": 4.0}


def with_protrusion(length: float) -> FloatArray:
    """Disk of radius 35 px with a protrusion 5 px wide."""
    tip = CENTRE + np.array([0.3, 35.0 + length])
    body = shapely.Polygon(circle(35.0)).union(shapely.LineString([CENTRE, tip]).buffer(2.5))
    return np.asarray(body.exterior.coords)[:-1]


def growing(frames: int = 15) -> np.ndarray:
    return masks_of([with_protrusion(4.0 * time) for time in range(frames)], (121, 181))


def waving(time: int) -> FloatArray:
    """Three lobes of 6 px that run round by 5 degrees a frame."""
    angle = 2.0 * np.pi * np.arange(1200) / 1200
    return polar(40.0 + 6.0 * np.cos(3.0 * (angle - np.radians(5.0) * time)))


def pieces(movie: DiskMovie, step: int) -> SweptEdge:
    here, there = (movie.records[number].boundary for number in (step, step + 1))
    assert here is not None
    assert there is not None
    return swept_edge(here, there, image_shape=movie.image_shape)


def off(movie: DiskMovie) -> tuple[FloatArray, FloatArray]:
    """By how much velocity times length, and swept area, miss what the change of area allows (at most 1)."""
    table = edge_changes(movie, 60).isel(time=slice(0, -1))
    changes = table.sum("sector")
    net = (table.velocity * table.edge_length).sum("sector")
    won, lost, perimeter = changes.protruded_area, changes.retracted_area, changes.edge_length
    swept = np.array([pieces(movie, step).absolute_px2 for step in range(len(movie) - 1)])
    missed = np.abs(net - (won - lost)) / (0.05 * (won + lost) + 0.02 * perimeter)
    return missed.to_numpy(), swept / (1.25 * (won + lost) + 0.1 * perimeter).to_numpy()


@pytest.mark.parametrize("backwards", [False, True])
def test_a_thin_protrusion_keeps_its_velocity_to_the_end(backwards: bool) -> None:
    movie = map_movie(growing()[::-1] if backwards else growing(), **QUICK)
    fastest = edge_changes(movie, 60).velocity_fastest[:-1]
    assert len(fastest) == 14
    tip = fastest.min("sector") if backwards else fastest.max("sector")
    assert (np.abs(tip) > 3.5).all()
    assert (np.sign(tip) == (-1.0 if backwards else 1.0)).all()
    missed, swept = off(movie)
    assert missed.max() < 1.0
    assert swept.max() < 1.0


@pytest.mark.parametrize("tracker", ["matching", "demons"])
def test_a_protrusion_is_kept_by_either_tracker(tracker: str) -> None:
    movie = map_movie(growing(4), tracker=tracker, **QUICK)
    assert off(movie)[0].max() < 1.0
    assert float(edge_changes(movie, 30).velocity_fastest[:-1].max("sector").min()) > 3.5


@pytest.mark.parametrize("kind", ["waving", "turning 5", "turning 10"])
def test_sliding_along_a_curved_edge_is_no_velocity(kind: str) -> None:
    if kind == "waving":
        outlines = [waving(time) for time in range(10)]
    else:
        outlines = [moved(lobed(40.0), float(kind.split()[1]) * time, (0.0, 0.0)) for time in range(10)]
    movie = map_movie(masks_of(outlines, (121, 121)), **QUICK)
    table = edge_changes(movie, 60).isel(time=slice(0, -1))
    assert float(np.abs(table.velocity).max()) > 1.0
    total = table.edge_length.sum()
    found = float((table.velocity * table.edge_length).sum() / total)
    true = float((table.protruded_area - table.retracted_area).sum() / total)
    assert abs(found - true) < 0.005
    assert abs(found) < 0.01
    missed, swept = off(movie)
    assert missed.max() < 1.0
    assert swept.max() < 1.0


@settings(max_examples=25, deadline=None)
@given(
    growth=st.floats(0.5, 2.0),
    slide=st.floats(0.0, 1.0),
    sectors=st.integers(1, 3000),
    seed=st.integers(0, 1000),
)
def test_sectors_add_up_to_the_change_of_area_whatever_the_match(
    growth: float, slide: float, sectors: int, seed: int
) -> None:
    first, second = exact(lobed(30.0)), exact(lobed(30.0 * growth))
    random = np.random.default_rng(seed)
    gaps = random.uniform(0.1, 1.0, 90)
    places = second.length * (slide + np.cumsum(gaps) / gaps.sum())
    here, there = TrackedBoundary(0, first, evenly(first, 90)), TrackedBoundary(1, second, places)
    area, length, fastest = swept_edge(here, there).by_sector(sectors)
    change = shapely.Polygon(second.points_yx).area - shapely.Polygon(first.points_yx).area
    assert area.sum() == pytest.approx(change, abs=1e-3 * shapely.Polygon(second.points_yx).area)
    assert length.sum() == pytest.approx(0.5 * (first.length + second.length), rel=1e-2)
    assert np.isfinite(fastest).all()


def test_a_match_that_is_wrong_sweeps_more_than_the_cell_won_and_lost() -> None:
    first, second = exact(waving(0)), exact(waving(2))
    found = []
    for slide in (0.0, 0.25):
        here = TrackedBoundary(0, first, evenly(first))
        there = TrackedBoundary(1, second, evenly(second) + slide * second.length)
        found.append(swept_edge(here, there).absolute_px2)
    one, other = (shapely.Polygon(waving(time)) for time in (0, 2))
    changed = one.symmetric_difference(other).area
    assert found[0] < 1.25 * changed + 0.1 * first.length < found[1]


def test_the_match_is_read_back_as_it_was(tmp_path: Path) -> None:
    results = list(map_frames(growing(3), MovieSettings(**QUICK)))
    boundaries = []
    for result in results:
        assert result.mapped is not None
        save_frame(tmp_path / f"{result.frame}.npz", result.mapped)
        boundaries.append((result.mapped.boundary, load_boundary(tmp_path / f"{result.frame}.npz")))
    assert boundaries[0][1].matched_s is None
    for one, again in boundaries[1:]:
        np.testing.assert_array_equal(one.matched_s, again.matched_s)
    (here, here_again), (there, there_again) = boundaries[1:]
    np.testing.assert_array_equal(
        swept_edge(here, there).area_px2, swept_edge(here_again, there_again).area_px2
    )


@pytest.mark.parametrize("sectors", [1, 5, 40, 333])
def test_sectors_hold_what_a_sum_over_finely_cut_pieces_gives(sectors: int) -> None:
    random = np.random.default_rng(1009)
    n, cuts = 60, 400
    gaps = random.uniform(0.05, 1.0, n)
    angles = random.uniform(-7.0, 7.0) + 2.0 * np.pi * (np.cumsum(gaps) - gaps) / gaps.sum()
    edge = SweptEdge(random.normal(size=n), random.uniform(0.2, 0.8, n), angles, random.random(n) > 0.3)
    area, length, fastest = edge.by_sector(sectors)
    parts = angles[:, None] + (np.arange(cuts) + 0.5) / cuts * (2.0 * np.pi * gaps / gaps.sum())[:, None]
    sector = sector_of(parts, sectors)
    weight = np.repeat(edge.free / cuts, cuts)
    for found, values in ((area, edge.area_px2), (length, edge.length_px)):
        known = np.bincount(sector.ravel(), weight * np.repeat(values, cuts), sectors)
        np.testing.assert_allclose(found, known, atol=0.02)
        assert found.sum() == pytest.approx(values[edge.free].sum())
    for number in range(sectors):
        inside = edge.free & (sector == number).any(axis=1)
        # A stretch of half a pixel is one piece, or a few short ones.
        means = [mean_around(edge, piece, 0.25) for piece in np.flatnonzero(inside)]
        assert np.isnan(fastest[number]) == (not means)
        if means:
            assert abs(fastest[number]) == pytest.approx(np.abs(means).max())


def mean_around(edge: SweptEdge, piece: int, reach: float) -> float:
    """Swept area over length of the pieces around one, to either side as far as the reach or the border."""
    n, taken = len(edge.free), [piece]
    for step in (1, -1):
        gone, other = 0.5 * edge.length_px[piece], (piece + step) % n
        while gone < reach and edge.free[other]:
            taken.append(other)
            gone += edge.length_px[other]
            other = (other + step) % n
    return float(edge.area_px2[taken].sum() / edge.length_px[taken].sum())
