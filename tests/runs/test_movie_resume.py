import shutil
from pathlib import Path

import pytest
from movie_files import SMALL, Stopped, assert_same_movie, stop_after, write_movie

import cytodisk as cd
from cytodisk.errors import ReadError, StudyError
from cytodisk.runs.movie.movie_inputs import MovieInputs, open_movie
from cytodisk.runs.movie.movie_study import movie_study

FRAMES, GAP = 8, 6


@pytest.fixture(scope="module")
def inputs(tmp_path_factory: pytest.TempPathFactory) -> MovieInputs:
    truth = cd.simulate.movie("dropping", 0, frames=FRAMES, radius_px=16.0)
    assert truth.present.tolist().index(False) == GAP
    folder = tmp_path_factory.mktemp("movie")
    return open_movie(*write_movie(folder, truth), SMALL.model_copy(update={"renew_every": 3}))


@pytest.fixture(scope="module")
def whole(inputs: MovieInputs, tmp_path_factory: pytest.TempPathFactory) -> cd.Study:
    return movie_study(inputs, tmp_path_factory.mktemp("study") / "whole")


@pytest.mark.parametrize("done", [0, 1, 2, 4, GAP, GAP + 1, FRAMES])
def test_a_stopped_run_goes_on_to_the_same_results(
    inputs: MovieInputs, whole: cd.Study, tmp_path: Path, done: int
) -> None:
    """Stopped at the start, within a stretch, where the registration's reference changes, around the gap."""
    with pytest.raises(Stopped):
        movie_study(inputs, tmp_path / "out", progress=stop_after(done))
    with pytest.raises(ReadError, match="is not complete"):
        cd.open_study(tmp_path / "out")
    calls: list[tuple[int, int]] = []
    resumed = movie_study(inputs, tmp_path / "out", resume=True, progress=lambda *call: calls.append(call))
    assert calls == [(count, FRAMES) for count in range(done, FRAMES + 1)]
    assert_same_movie(whole, resumed)


@pytest.mark.slow
def test_a_run_with_the_other_tracker_goes_on_too(inputs: MovieInputs, tmp_path: Path) -> None:
    parameters = inputs.parameters.model_copy(update={"tracker": "demons"})
    demons = open_movie(inputs.masks.path, None, parameters)
    with pytest.raises(Stopped):
        movie_study(demons, tmp_path / "out", progress=stop_after(4))
    resumed = movie_study(demons, tmp_path / "out", resume=True)
    assert_same_movie(movie_study(demons, tmp_path / "whole"), resumed)


def test_a_run_may_be_stopped_again_and_again(inputs: MovieInputs, whole: cd.Study, tmp_path: Path) -> None:
    for done in (2, 3, 5):
        with pytest.raises(Stopped):
            movie_study(inputs, tmp_path / "out", resume=True, progress=stop_after(done))
    assert_same_movie(whole, movie_study(inputs, tmp_path / "out", resume=True))


def test_a_map_without_its_row_is_made_anew(inputs: MovieInputs, whole: cd.Study, tmp_path: Path) -> None:
    """A kill between the writing of a frame's map and of its row."""
    with pytest.raises(Stopped):
        movie_study(inputs, tmp_path / "out", progress=stop_after(4))
    (tmp_path / "out" / ".parts" / "00000_t00003.json").unlink()
    assert (tmp_path / "out" / "maps" / "cell_00000_t00003.npz").exists()
    assert_same_movie(whole, movie_study(inputs, tmp_path / "out", resume=True))


@pytest.fixture(scope="module")
def frames_done(inputs: MovieInputs, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run that was stopped when all frames were done, before its tables."""
    out = tmp_path_factory.mktemp("frames_done") / "out"
    with pytest.raises(Stopped):
        movie_study(inputs, out, progress=stop_after(FRAMES))
    return out


def _stop(*_: object, **__: object) -> None:
    raise Stopped


@pytest.mark.parametrize(
    "where",
    [
        "cytodisk.runs.movie.movie_study.finish_tables",
        "cytodisk.runs.movie.movie_tables.edge_columns",
        "cytodisk.runs.movie.movie_tables.displacement_between",
        "cytodisk.store.activity_store.CellActivity.close",
        "cytodisk.store.study_folder.merge_tables",
        "cytodisk.store.merging.pq.ParquetWriter",
    ],
)
def test_a_run_stopped_while_it_writes_its_tables_goes_on(
    inputs: MovieInputs,
    whole: cd.Study,
    frames_done: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    where: str,
) -> None:
    shutil.copytree(frames_done, tmp_path / "out")
    with monkeypatch.context() as patch:
        patch.setattr(where, _stop)
        with pytest.raises(Stopped):
            movie_study(inputs, tmp_path / "out", resume=True)
    with pytest.raises(ReadError, match="is not complete"):
        cd.open_study(tmp_path / "out")
    calls: list[tuple[int, int]] = []
    resumed = movie_study(inputs, tmp_path / "out", resume=True, progress=lambda *call: calls.append(call))
    assert calls == [(FRAMES, FRAMES)]
    assert_same_movie(whole, resumed)
    files = [
        sorted(str(path.relative_to(folder)) for path in folder.iterdir())
        for folder in (whole.path, resumed.path)
    ]
    assert files[0] == files[1]


def test_a_complete_study_is_returned_at_once(inputs: MovieInputs, whole: cd.Study) -> None:
    before = {path: path.stat().st_mtime_ns for path in whole.path.rglob("*")}
    again = movie_study(inputs, whole.path, resume=True, progress=_stop)
    assert {path: path.stat().st_mtime_ns for path in whole.path.rglob("*")} == before
    assert_same_movie(whole, again)


def test_a_study_is_replaced_when_asked_for_alone(
    inputs: MovieInputs, whole: cd.Study, tmp_path: Path
) -> None:
    changed = open_movie(inputs.masks.path, None, SMALL)
    first = movie_study(changed, tmp_path / "out")
    for options, words in (({}, "holds a study: pass --resume"), ({"resume": True}, "holds another run")):
        with pytest.raises(StudyError, match=words):
            movie_study(inputs, first.path, **options)
    assert_same_movie(first, cd.open_study(first.path))
    assert_same_movie(whole, movie_study(inputs, first.path, overwrite=True))


def test_a_folder_with_something_else_is_left_alone(inputs: MovieInputs, tmp_path: Path) -> None:
    (tmp_path / "thesis.txt").write_text("years of work")
    for options in ({}, {"resume": True}, {"overwrite": True}):
        with pytest.raises(StudyError, match="not empty and holds no study"):
            movie_study(inputs, tmp_path, **options)
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.txt"]
