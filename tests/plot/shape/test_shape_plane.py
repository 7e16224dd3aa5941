import numpy as np
import pandas as pd
import pytest
from matplotlib.axes import Axes

import cytodisk as cd
from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import ParameterError
from cytodisk.plot.shape.shape_plane import principal_direction, spread_cells, unit_outline
from cytodisk.plot.shape.shape_rows import cells_along, least_median_most

AXIS = np.array([0.8, -0.6])


@pytest.fixture(scope="module")
def score() -> pd.DataFrame:
    """30 cells along an axis of a plane, in a mixed order, and one without a score."""
    random = np.random.default_rng(0)
    along = random.permutation(np.linspace(-5, 5, 30))
    across = 0.2 * np.cos(along)
    plane = np.outer(along, AXIS) + np.outer(across - across.mean(), [0.6, 0.8])
    table = pd.DataFrame({"cell": np.arange(100, 130), "status": "ok", "complexity": plane @ AXIS})
    table[["umap_1", "umap_2"]] = plane
    refused = pd.DataFrame({"cell": [130], "status": ["refused"], "complexity": [np.nan]})
    return pd.concat([table, refused], ignore_index=True)


@pytest.fixture(scope="module")
def masks() -> dict[int, BoolArray]:
    return {100 + n: cd.simulate.random_smooth(n, radius=8 + n) for n in range(30)}


def span(points: FloatArray) -> FloatArray:
    return np.asarray(np.ptp(points, axis=0))


def test_a_landscape_shows_each_cell_once_at_its_place(
    ax: Axes, score: pd.DataFrame, masks: dict[int, BoolArray]
) -> None:
    dots, outlines = cd.plot.draw_shape_landscape(ax, score, masks, places=10)
    shown = spread_cells(score, 10)
    assert 5 < len(shown) < 30
    assert len(outlines.get_paths()) == len(shown)
    assert len(dots.get_offsets()) == 30 - len(shown)
    drawn = score[score["cell"].isin(shown)]
    np.testing.assert_allclose(outlines.get_array(), drawn["complexity"])
    for path, place in zip(outlines.get_paths(), drawn[["umap_1", "umap_2"]].to_numpy(), strict=True):
        box = path.get_extents()
        np.testing.assert_allclose([box.x0 + box.x1, box.y0 + box.y1], 2 * place, atol=1e-6)
    sizes = [span(path.vertices).max() for path in outlines.get_paths()]
    np.testing.assert_allclose(sizes, sizes[0])
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("UMAP 1", "UMAP 2")


def test_outlines_keep_their_distance_and_look_as_in_the_image(score: pd.DataFrame) -> None:
    plane = score.set_index("cell").loc[spread_cells(score, 10), ["umap_1", "umap_2"]].to_numpy()
    distance = np.hypot(*(plane[:, None] - plane).T) + 99 * np.eye(len(plane))
    assert distance.min() >= span(score[["umap_1", "umap_2"]].dropna().to_numpy()).max() / 10
    corner = np.zeros((30, 30), dtype=bool)
    corner[2:28, 2:8] = corner[22:28, 2:28] = True  # an L: its arm points right, at the bottom
    outline = unit_outline(corner)
    assert span(outline).max() == pytest.approx(1)
    assert outline[outline[:, 0] > 0.3, 1].max() > outline[outline[:, 0] < 0, 1].max() + 0.3


def test_the_arrow_runs_along_the_axis_to_complex_cells(ax: Axes, score: pd.DataFrame) -> None:
    np.testing.assert_allclose(principal_direction(score.dropna()), AXIS, atol=1e-9)
    cd.plot.draw_shape_landscape(ax, score)
    (arrow,) = [text for text in ax.texts if text.get_gid() == "principal axis"]
    np.testing.assert_allclose(arrow.xy, score["complexity"].max() * AXIS)
    np.testing.assert_allclose(arrow.xyann, score["complexity"].min() * AXIS)


def test_without_masks_all_cells_are_dots(ax: Axes, score: pd.DataFrame) -> None:
    dots, outlines = cd.plot.draw_shape_landscape(ax, score)
    assert len(dots.get_offsets()) == 30
    assert not outlines.get_paths()


def test_examples_stand_in_rows_at_one_scale(
    ax: Axes, score: pd.DataFrame, masks: dict[int, BoolArray]
) -> None:
    rows = [[100, 104], [129, 110]]
    drawn = cd.plot.draw_shape_examples(ax, score, masks, rows, scale=cd.Scale(0.5))
    boxes = [path.get_extents() for path in drawn.get_paths()]
    for cell, box in zip([100, 104, 129, 110], boxes, strict=True):
        assert box.width == pytest.approx(span(np.argwhere(masks[cell]))[1] + 1, abs=0.01)
        assert box.height == pytest.approx(span(np.argwhere(masks[cell]))[0] + 1, abs=0.01)
    assert boxes[0].x1 < boxes[1].x0
    assert max(boxes[0].y1, boxes[1].y1) < min(boxes[2].y0, boxes[3].y0)
    assert ax.get_ylim()[0] > ax.get_ylim()[1]  # rows from the top, cells as in the image
    np.testing.assert_allclose(drawn.get_array(), score.set_index("cell")["complexity"][[100, 104, 129, 110]])
    assert any("µm" in text.get_text() for text in ax.texts)


def test_examples_of_one_size_have_no_scale_bar(
    ax: Axes, score: pd.DataFrame, masks: dict[int, BoolArray]
) -> None:
    drawn = cd.plot.draw_shape_examples(ax, score, masks, [[100], [129]], one_scale=False)
    assert [span(path.vertices).max() for path in drawn.get_paths()] == pytest.approx([1, 1])
    assert not ax.texts


def test_cells_are_chosen_by_rank(score: pd.DataFrame) -> None:
    ranked = score.dropna().sort_values("complexity")["cell"].tolist()
    assert cells_along(score, 4) == [ranked[0], ranked[10], ranked[19], ranked[29]]
    assert cells_along(score, 99) == ranked
    assert least_median_most(score, 5) == [ranked[:5], ranked[12:17], ranked[-5:]]
    assert [len(row) for row in least_median_most(score.iloc[:10])] == [3, 3, 3]


@pytest.mark.parametrize(
    ("rows", "words"), [([], "no cell"), ([[]], "no cell"), ([[130]], "cell 130"), ([[7]], "cell 7")]
)
def test_rows_must_name_cells_with_a_score(
    ax: Axes, score: pd.DataFrame, masks: dict[int, BoolArray], rows: list[list[int]], words: str
) -> None:
    with pytest.raises(ParameterError, match=words):
        cd.plot.draw_shape_examples(ax, score, masks, rows)


def test_a_table_without_scores_is_an_error(ax: Axes, score: pd.DataFrame) -> None:
    with pytest.raises(ParameterError, match="'umap_1'"):
        cd.plot.draw_shape_landscape(ax, score.drop(columns="umap_1"))
    with pytest.raises(ParameterError, match="at least 10"):
        cd.plot.draw_shape_landscape(ax, score.iloc[30:])
