import numpy as np
import pytest
import shapely
from numpy.testing import assert_allclose, assert_array_equal
from scipy import ndimage

from cytodisk.errors import ParameterError
from cytodisk.geometry.outline import has_one_outline
from cytodisk.geometry.polygon import centroid, signed_area
from cytodisk.simulate import MOVIE_KINDS, movie, movie_with_nuclei
from cytodisk.simulate.movie_kinds import HABITS
from cytodisk.simulate.movie_plans import plan_movie
from cytodisk.simulate.paths import carried_from_start, paths

EIGHT = np.ones((3, 3), dtype=bool)


@pytest.mark.parametrize("kind", MOVIE_KINDS)
def test_the_nucleus_stays_in_one_piece_inside_the_cell(kind: str) -> None:
    truth = movie_with_nuclei(kind, 1, frames=16, signals=False, nucleus_turn_deg=5.0)  # type: ignore[arg-type]
    for cell, nucleus, cell_yx, nucleus_yx in zip(
        truth.masks, truth.nuclei, truth.cell.boundary_yx, truth.nucleus_yx, strict=True
    ):
        assert shapely.Polygon(cell_yx).contains(shapely.Polygon(nucleus_yx))
        if not nucleus.any():
            assert kind == "dropping"
            continue
        assert has_one_outline(nucleus)
        assert not (ndimage.binary_dilation(nucleus, EIGHT) & ~cell).any()
        if kind != "still":  # there masks jitter
            assert nucleus.sum() == pytest.approx(signed_area(nucleus_yx), rel=0.02)
            assert_allclose(np.argwhere(nucleus).mean(axis=0), centroid(nucleus_yx), atol=0.3)


def test_the_cell_is_that_of_the_movie_without_a_nucleus() -> None:
    settings = {"frames": 4, "radius_px": 15.0, "turn_deg": 2.0}
    alone, truth = movie("migrating", 3, **settings), movie_with_nuclei("migrating", 3, **settings)
    assert_array_equal(truth.masks, alone.masks)
    assert_array_equal(truth.cell.signal, alone.signal)


@pytest.mark.parametrize("kind", ["neutrophil", "fluctuating", "growing"])
def test_the_nucleus_stays_an_oval_of_its_area(kind: str) -> None:
    truth = movie_with_nuclei(kind, 1, frames=16, signals=False)  # type: ignore[arg-type]
    areas = [signed_area(outline) for outline in truth.nucleus_yx]
    assert_allclose(areas, areas[0], rtol=1e-9)
    for outline in truth.nucleus_yx:
        polygon = shapely.Polygon(outline)
        assert polygon.area > 0.999 * polygon.convex_hull.area


@pytest.mark.parametrize("kind", ["migrating", "necking", "fluctuating", "filopodium", "lamellipodium"])
def test_points_inside_move_with_the_matter_around_them(kind: str) -> None:
    plan = plan_movie(kind, np.random.default_rng([2, 0]), 30.0, HABITS[kind])  # type: ignore[arg-type, index]
    interior = paths(plan, 0, 6).interior_yx[:, ::50]
    starts = np.broadcast_to(interior[0], interior.shape)
    assert_allclose(carried_from_start(plan, starts), interior, atol=1e-6)


@pytest.mark.parametrize(("kind", "cell_turn"), [("translating", 0.0), ("turning", 2.0)])
def test_the_nucleus_turns_within_the_cell(kind: str, cell_turn: float) -> None:
    truth = movie_with_nuclei(kind, 2, frames=5, signals=False, nucleus_turn_deg=-6.0)  # type: ignore[arg-type]
    assert truth.turn_deg == -6.0
    middles = np.array([centroid(outline) for outline in truth.nucleus_yx])
    first = truth.nucleus_yx[:, 0] - middles
    angle = np.unwrap(np.arctan2(first[:, 0], first[:, 1]))
    assert_allclose(np.degrees(np.diff(angle)), cell_turn - 6.0, atol=1e-3)
    step = np.hypot(*np.diff(middles, axis=0).T)
    if kind == "translating":
        assert_allclose(step, HABITS["translating"].speed_px, atol=1e-6)


def test_size_and_elongation_are_those_asked_for() -> None:
    truth = movie_with_nuclei(
        "translating", frames=2, signals=False, nucleus_share=0.1, nucleus_elongation=2.0
    )
    outline = truth.nucleus_yx[0] - centroid(truth.nucleus_yx[0])
    assert signed_area(outline) == pytest.approx(0.1 * signed_area(truth.cell.boundary_yx[0]))
    away = np.hypot(*outline.T)
    assert away.max() / away.min() == pytest.approx(2.0, rel=1e-3)
    large = movie_with_nuclei("spiky", frames=2, signals=False, nucleus_share=0.5, nucleus_elongation=3.0)
    assert large.nuclei[0].sum() < 0.45 * large.masks[0].sum()  # there is not room for more


def test_frames_without_a_nucleus() -> None:
    truth = movie_with_nuclei("dropping", 1, frames=20, signals=False, nucleus_missing=0.3, radius_px=20.0)
    assert_array_equal(truth.nuclei.any(axis=(1, 2)), truth.nucleus_present)
    assert truth.nucleus_present[0]
    assert truth.nucleus_present[-1]
    assert (truth.cell.present & ~truth.nucleus_present).sum() >= 3
    assert not (truth.nucleus_present & ~truth.cell.present).any()
    assert np.isfinite(truth.nucleus_yx).all()


def test_jitter_moves_the_drawn_outlines_and_not_the_true_ones() -> None:
    still = movie_with_nuclei("still", 1, frames=3, signals=False)
    assert_allclose(still.nucleus_yx[1], still.nucleus_yx[0], atol=1e-9)
    assert (still.nuclei[1] != still.nuclei[0]).any()


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"kind": "jumping"}, "kind must be one of"),
        ({"nucleus_share": 0.0}, "nucleus_share"),
        ({"nucleus_missing": 1.0}, "nucleus_missing"),
        ({"nucleus_colour": 1.0}, "nucleus_colour"),
    ],
)
def test_wrong_arguments(wrong: dict[str, object], said: str) -> None:
    with pytest.raises(ParameterError, match=said):
        movie_with_nuclei(**wrong)  # type: ignore[arg-type]
