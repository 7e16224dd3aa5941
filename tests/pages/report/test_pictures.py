import numpy as np
import pytest
from report_study import GAP, LAYERS, SECTORS

import cytodisk as cd
from cytodisk.analysis.top_speed import top_speed
from cytodisk.pages.report import boxes
from cytodisk.pages.report.boxes import Box, box_around, boxes_by_frame
from cytodisk.pages.report.pictures import OUTSIDE, Pictures, resampled, window_labels
from cytodisk.pages.report.shown_cell import ShownCell
from cytodisk.store.study import Study


@pytest.fixture(scope="module")
def cell(study: Study) -> ShownCell:
    return ShownCell(study, 0)


def test_box_holds_the_cell_in_every_frame(cell: ShownCell) -> None:
    box = box_around(cell)
    for time in range(len(cell.maps)):
        if time == GAP:
            continue
        rows, columns = np.nonzero(cell.maps[time].mask)
        assert box.top <= rows.min()
        assert rows.max() < box.top + box.height
        assert box.left <= columns.min()
        assert columns.max() < box.left + box.width


def test_labels_are_those_of_the_windows(cell: ShownCell) -> None:
    """At whole pixels a label is the window of the pixel's centre: mostly that of its largest share."""
    box = box_around(cell)
    box = Box(box.top, box.left, box.height, box.width, 1.0)
    found = window_labels(cell.maps[0], cell.grid, box)
    windows = cd.polar_windows(LAYERS, SECTORS).on(cell.maps[0])
    expected = windows.labels[box.top : box.top + box.height, box.left : box.left + box.width]
    inside = expected >= 0
    assert found[~inside].min() == OUTSIDE
    assert (found[inside] == expected[inside]).mean() > 0.97


def test_finer_labels_agree_with_coarse_ones(cell: ShownCell) -> None:
    box, disk = box_around(cell), cell.maps[0]
    coarse = window_labels(disk, cell.grid, Box(box.top, box.left, box.height, box.width, 1.0))
    fine = window_labels(disk, cell.grid, Box(box.top, box.left, box.height, box.width, 3.0))
    np.testing.assert_array_equal(fine[1::3, 1::3], coarse)


def test_reduced_image_keeps_the_mean() -> None:
    image = np.random.default_rng(0).random((40, 60))
    found = resampled(image, Box(0, 0, 40, 60, 0.3))
    assert found.shape == (12, 18)
    assert found.mean() == pytest.approx(image.mean())
    np.testing.assert_allclose(
        resampled(image, Box(10, 20, 20, 30, 0.1)), image[10:30, 20:50].reshape(2, 10, 3, 10).mean((1, 3))
    )


def test_enlarged_image_repeats_pixels() -> None:
    image = np.arange(12.0).reshape(3, 4)
    found = resampled(image, Box(1, 1, 2, 3, 2.0))
    np.testing.assert_array_equal(found, image[1:3, 1:4].repeat(2, axis=0).repeat(2, axis=1))


def test_boxes_go_with_a_cell_that_travels(cell: ShownCell, monkeypatch: pytest.MonkeyPatch) -> None:
    assert boxes_by_frame(cell) == [box_around(cell)] * len(cell.maps)
    monkeypatch.setattr(boxes, "_TRAVELS", 0.1)
    found = boxes_by_frame(cell)
    assert len({(box.height, box.width, box.scale) for box in found}) == 1
    assert found[GAP] == found[GAP - 1]
    for time, box in enumerate(found):
        if time != GAP:
            rows, columns = np.nonzero(cell.maps[time].mask)
            assert box.top <= rows.min() <= rows.max() < box.top + box.height
            assert box.left <= columns.min() <= columns.max() < box.left + box.width


def test_long_movies_are_thinned_out(cell: ShownCell) -> None:
    encoder = Pictures(cell, boxes_by_frame(cell), None)
    assert encoder.every([], 10_000_000) == 1
    sizes = [len(encoder.frame(time, [])["labels"] or "") for time in cell.frames]
    every = encoder.every([], max(sizes) * 3)
    assert every >= 2
    assert cell.every_frames(every).frames == cell.frames[::every]


def test_a_frame_without_a_map_has_no_labels(cell: ShownCell) -> None:
    encoder = Pictures(cell, boxes_by_frame(cell), None)
    assert encoder.frame(GAP, []) == {"labels": None, "channels": None}


@pytest.mark.parametrize(
    ("velocity", "limit"),
    [
        (np.zeros((3, 4)), 1.0),
        (np.full((3, 4), np.nan), 1.0),
        (np.linspace(-1, 1, 2001)[None], 0.99),
        (np.r_[np.full(900, 0.1), np.full(100, 50.0)][None], 0.3),
    ],
)
def test_a_few_faults_do_not_pale_the_velocity(velocity: np.ndarray, limit: float) -> None:
    assert top_speed(velocity) == pytest.approx(limit, rel=1e-2)
