"""A label movie of three cells: one with a gap, one that comes late and leaves early, one on the border."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from movie_files import SECTORS, SMALL, damage, write_masks
from numpy.testing import assert_array_equal

import cytodisk as cd
from cytodisk.errors import MapError, ReadError
from cytodisk.runs.movie.movie_inputs import MovieInputs, open_movie
from cytodisk.runs.movie.movie_study import movie_study

FRAMES, SHAPE = 7, (70, 110)
LOST, COMES, LEAVES = 3, 2, 4
MOVER, GUEST, BORDER = 0, 1, 2  # numbers of the cells, in the order of their labels 3, 5, 9
MEASURES = ["velocity", "velocity_cell_frame", "velocity_error", "edge_length"]


def labels_at(time: int) -> np.ndarray:
    y, x = np.indices(SHAPE)
    frame = np.zeros(SHAPE, dtype=np.uint16)
    frame[(y - 50) ** 2 + (x - 3) ** 2 < (14 + 0.5 * time) ** 2] = 9
    if time != LOST:
        frame[(y - 18) ** 2 + (x - 30 - 2 * time) ** 2 < 12**2] = 3
    if COMES <= time <= LEAVES:
        frame[((y - 45 - time) / 15) ** 2 + ((x - 80) / 10) ** 2 < 1] = 5
    return frame


LABELS = np.stack([labels_at(time) for time in range(FRAMES)])


def opened(folder: Path, labels: np.ndarray, *, link: bool = False) -> MovieInputs:
    parameters = SMALL.model_copy(update={"link": link})
    return open_movie(write_masks(folder / "labels.tif", labels), None, parameters)


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> cd.Study:
    folder = tmp_path_factory.mktemp("labels")
    inputs = opened(folder, LABELS)
    assert inputs.understood["masks"].startswith("labels of 3 cells, 7 frames of 70 × 110 pixels")
    return movie_study(inputs, folder / "out")


def rows_of(table: pd.DataFrame, cell: int) -> pd.DataFrame:
    return table[table["cell"] == cell].reset_index(drop=True)


def test_each_cell_has_rows_from_its_first_frame_to_its_last(study: cd.Study) -> None:
    times = {cell: rows_of(study.cells, cell)["frame"].tolist() for cell in range(3)}
    assert times == {MOVER: list(range(FRAMES)), GUEST: [2, 3, 4], BORDER: list(range(FRAMES))}
    assert study.cells["label"].tolist() == [3] * FRAMES + [5] * 3 + [9] * FRAMES
    ok = study.cells[study.cells["status"] == "ok"]
    assert ok["certificate_valid"].all()
    assert (ok["empty_windows"] == 0).all()
    assert_array_equal(ok["area_px"], [(LABELS[row.frame] == row.label).sum() for row in ok.itertuples()])
    assert len(study.windows) == len(ok) * 4 * SECTORS


def test_a_missing_label_is_a_gap_with_its_reason(study: cd.Study) -> None:
    rows = rows_of(study.cells, MOVER)
    assert rows["status"].tolist() == ["ok"] * 3 + ["missing"] + ["ok"] * 3
    assert rows["reason"][LOST] == "label 3 is not in frame 3"
    edge = rows_of(study.edge, MOVER)
    assert LOST not in set(edge["frame"])
    before = edge[edge["frame"] == LOST - 1]
    assert set(before["status"]) == {"the next frame has no map: label 3 is not in frame 3"}
    assert before["velocity"].isna().all()
    after = edge[edge["frame"] == LOST + 1]
    assert after["velocity"].notna().all()
    assert study.provenance["warnings"] == ["cell 0, frame 3: label 3 is not in frame 3"]


def test_tracking_goes_on_after_the_gap(study: cd.Study) -> None:
    """A disk that moves by 2 px a frame along the rows: the point ahead stays the point ahead."""
    movie = study.movie(MOVER)
    ahead = [np.nanargmax(movie.points_yx[time][:, 1]) for time in (0, 2, 4, 6)]
    apart = np.diff(ahead) / movie.n_points
    assert np.abs(apart - np.round(apart)).max() < 0.05
    moved = movie.points_yx[4] - movie.points_yx[2]
    assert np.median(moved[:, 1]) == pytest.approx(4.0, abs=0.3)


def test_a_cell_that_leaves_ends_there(study: cd.Study) -> None:
    edge = rows_of(study.edge, GUEST)
    assert set(edge.loc[edge["frame"] == LEAVES, "status"]) == {"last frame"}
    assert edge.loc[edge["frame"] < LEAVES, "velocity"].notna().all()
    assert study.activity(GUEST)["frame"].to_numpy().tolist() == [2, 3, 4]


def test_frames_before_a_cell_came_are_missing_in_its_movie(study: cd.Study) -> None:
    movie = study.movie(GUEST)
    assert movie.status == ["missing", "missing", "ok", "ok", "ok"]
    with pytest.raises(MapError, match=r"frame 1.*cell 1"):
        movie[1]
    assert_array_equal(movie[COMES].mask, LABELS[COMES] == 5)


def test_the_border_is_flagged_and_its_sectors_have_no_velocity(study: cd.Study) -> None:
    assert study.cells.groupby("cell")["touches_border"].sum().tolist() == [0, 0, FRAMES]
    edge = rows_of(study.edge, BORDER)
    edge = edge[edge["frame"] < FRAMES - 1]
    on_border = edge["status"] == "on the image's border"
    for time in range(FRAMES - 1):
        assert 1 <= on_border[edge["frame"] == time].sum() <= SECTORS // 2
    assert set(edge.loc[~on_border, "status"]) == {"ok"}
    assert edge.loc[on_border, "velocity"].isna().all()
    assert edge.loc[~on_border, MEASURES].notna().all(axis=None)
    whole = edge.loc[~on_border].groupby("frame")["velocity"].median()
    assert whole.to_numpy() == pytest.approx(0.5, abs=0.25)  # the disk grows by 0.5 px a frame


def test_the_same_cell_alone_gives_the_same_rows(study: cd.Study, tmp_path: Path) -> None:
    alone = movie_study(opened(tmp_path, np.where(LABELS == 3, LABELS, 0)), tmp_path / "out")
    assert set(alone.cells["cell"]) == {0}
    assert (alone.cells["status"] == "ok").sum() == FRAMES - 1
    for name in ("windows", "edge", "consistency"):
        found, known = (rows_of(getattr(one, name), MOVER) for one in (alone, study))
        pd.testing.assert_frame_equal(
            found.drop(columns="status", errors="ignore"),
            known.drop(columns="status", errors="ignore"),
            check_exact=True,
        )


def test_linked_labels_give_the_same_cells(study: cd.Study, tmp_path: Path) -> None:
    """Every frame has its own numbers; tracks are numbered by appearance, so cells have other numbers."""
    random = np.random.default_rng(0)
    shuffled = np.zeros_like(LABELS)
    for time, frame in enumerate(LABELS):
        for old, new in zip((3, 5, 9), random.permutation([1, 2, 3]), strict=True):
            shuffled[time][frame == old] = new
    assert not (shuffled[1:] == shuffled[:-1]).all()
    linked = movie_study(opened(tmp_path, shuffled, link=True), tmp_path / "out")
    assert linked.cells["cell"].nunique() == 3
    for cell in range(3):
        start = rows_of(study.cells, cell).iloc[0]
        same = linked.cells["centroid_y"].sub(start["centroid_y"]).abs() < 1e-9
        (found,) = linked.cells.loc[same & (linked.cells["frame"] == start["frame"]), "cell"]
        numbers = (study, cell), (linked, found)
        for name in ("windows", "edge", "consistency"):
            own = ["cell", "status"] if name == "edge" else ["cell"]
            pair = [rows_of(getattr(one, name), number) for one, number in numbers]
            pd.testing.assert_frame_equal(*(rows.drop(columns=own) for rows in pair), check_exact=True)
        statuses = [rows_of(one.cells, number)["status"].tolist() for one, number in numbers]
        assert statuses[0] == statuses[1]


def test_a_damaged_frame_is_lost_for_the_cells_that_are_around_it(tmp_path: Path) -> None:
    path = write_masks(tmp_path / "labels.tif", LABELS)
    damage(path, 5)
    cells = movie_study(open_movie(path, None, SMALL), tmp_path / "out").cells
    lost = cells[cells["status"] == "unreadable"]
    assert lost[["cell", "frame"]].to_numpy().tolist() == [[MOVER, 5], [BORDER, 5]]
    assert lost["reason"].str.contains("frame 5 cannot be read as an image").all()
    assert rows_of(cells, GUEST)["status"].tolist() == ["ok"] * 3


@pytest.mark.parametrize("time", [0, FRAMES - 1])
def test_a_damaged_frame_at_the_end_of_the_recording_is_not_passed_over(tmp_path: Path, time: int) -> None:
    path = write_masks(tmp_path / "labels.tif", LABELS)
    damage(path, time)
    study = movie_study(open_movie(path, None, SMALL), tmp_path / "out")
    said = [*study.cells["reason"], *study.provenance["warnings"]]
    assert any(f"frame {time} cannot be read as an image" in words for words in said)


def test_a_cell_that_is_not_there_is_named(study: cd.Study) -> None:
    for read in (study.movie, study.activity, lambda cell: study.map(cell, 0)):
        with pytest.raises(ReadError, match="has no cell 3: it has the cells 0 to 2"):
            read(3)
