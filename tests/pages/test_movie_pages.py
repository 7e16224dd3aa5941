import struct
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import tifffile
from matplotlib.figure import Figure
from PIL import Image

from cytodisk.arrays import FloatArray
from cytodisk.errors import ReadError, SignalError
from cytodisk.pages import movie_pages as pages
from cytodisk.pages.edge_page import fastest_frame
from cytodisk.pages.movie_pages import write_movie_figures
from cytodisk.runs.movie.movie_inputs import open_movie
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.movie.movie_study import movie_study
from cytodisk.store.study import Study

FRAMES, GAP, SHAPE = 8, 3, (50, 150)
WHOLE, LATE, ONCE = range(3)  # cells: with a gap, from frame 5 to 6, in frame 6 alone


def _masks() -> FloatArray:
    """A disk that grows by 0.5 px a frame and moves, and cells that are seen for a short time."""
    y, x = np.mgrid[: SHAPE[0], : SHAPE[1]]
    masks = np.zeros((FRAMES, *SHAPE), dtype=np.uint8)
    for time in range(FRAMES):
        if time != GAP:
            masks[time][np.hypot(y - 25, x - 25 - time) < 12 + 0.5 * time] = 1
        if time in (5, 6):
            masks[time][np.hypot(y - 25, x - 80) < 10 + time - 5] = 2
        if time == 6:
            masks[time][np.hypot(y - 25, x - 120) < 10] = 3
    return masks


def _signal() -> FloatArray:
    y, x = np.mgrid[: SHAPE[0], : SHAPE[1]]
    frame = np.stack([100.0 + x, 100.0 + 3 * y + (x % 7)])
    return np.stack([frame + time for time in range(FRAMES)]).astype(np.float32)


@pytest.fixture(scope="module")
def images() -> FloatArray:
    return _signal()


def _study(folder: Path, signal: FloatArray | None, **scale: float) -> Study:
    tifffile.imwrite(folder / "masks.tif", _masks(), metadata={"axes": "TYX"})
    path = None
    if signal is not None:
        path = folder / "signal.ome.tif"
        names = {"Channel": {"Name": ["Rac/1 $a$", "rac 1 $a$"]}}
        tifffile.imwrite(path, signal, metadata={"axes": "TCYX"} | names)
    parameters = MovieParameters(kind="labels", layers=3, sectors=12, **scale)
    return movie_study(open_movie(folder / "masks.tif", path, parameters), folder / "study")


@pytest.fixture(scope="module")
def scaled(tmp_path_factory: pytest.TempPathFactory, images: FloatArray) -> Study:
    """With a signal and a known scale."""
    return _study(tmp_path_factory.mktemp("scaled"), images, pixel_size_um=0.2, frame_interval_s=5.0)


@pytest.fixture(scope="module")
def bare(tmp_path_factory: pytest.TempPathFactory) -> Study:
    """Without a signal or a scale."""
    return _study(tmp_path_factory.mktemp("bare"), None)


def _names(paths: list[Path]) -> list[str]:
    return [path.name for path in paths]


def _labels(figure: Figure) -> set[str]:
    axes = [inner for ax in figure.axes for inner in (ax, *ax.child_axes)]
    return {label for ax in axes for label in (ax.get_xlabel(), ax.get_ylabel()) if label}


def _count(path: Path) -> int:
    with Image.open(path) as movie:
        return int(getattr(movie, "n_frames", 1))


def test_pages_with_signal(scaled: Study, images: FloatArray, saved: list[Figure]) -> None:
    asked: list[int] = []
    done: list[tuple[int, int]] = []

    def signal(time: int) -> FloatArray:
        asked.append(time)
        return np.asarray(images[time])

    paths = write_movie_figures(scaled, WHOLE, signal, progress=lambda *state: done.append(state))
    endings = ["activity_Rac_1_a", "activity_rac_1_a_1", "edge", "strip", "consistency"]
    assert _names(paths) == [*(f"cell_00000_{ending}.png" for ending in endings), "cell_00000.gif"]
    assert {path.parent for path in paths} == {scaled.path / "figures"}
    assert not list((scaled.path / "figures").glob(".*"))
    widths = {struct.unpack(">I", path.read_bytes()[16:20])[0] for path in paths[:-1]}
    assert widths == {int(119 / 25.4 * 300)}
    assert GAP not in asked
    assert _count(paths[-1]) == FRAMES - 1
    assert done[0] == (0, 12)
    assert done[-1] == (12, 12)
    activity, _, edge, strip, consistency = map(_labels, saved)
    assert {"time (s)", "edge velocity (nm/s)", "mean Rac/1 $a$ (a.u.)"} <= activity
    assert {"time (s)", "area per frame (µm²)", "edge velocity (nm/s)"} <= edge
    assert strip == {"Rac/1 $a$ (a.u.)"}
    assert {"time (s)", "displacement (µm)", "correlation with next frame"} <= consistency


def test_pages_without_signal_or_scale(bare: Study, drawn: list[Figure]) -> None:
    paths = write_movie_figures(bare, WHOLE)
    endings = ["_velocity.png", "_edge.png", "_strip.png", "_consistency.png", ".gif"]
    assert _names(paths) == [f"cell_00000{ending}" for ending in endings]
    velocity, edge, strip, consistency = map(_labels, drawn)
    assert velocity == {"frame", "edge velocity (px/frame)", "sector (0 at +x, towards +y)"}
    assert {"frame", "area per frame (px²)", "edge velocity (px/frame)"} <= edge
    assert strip == set()
    assert consistency == {"frame", "displacement (px)"}


def test_a_gap_is_missing_in_the_map(bare: Study, drawn: list[Figure]) -> None:
    write_movie_figures(bare, WHOLE, animation=False)
    velocity = drawn[0].axes[0].images[0].get_array()
    known = ~np.ma.getmaskarray(velocity).all(axis=0)
    assert known.tolist() == [True, True, False, False, True, True, True, False]
    stamps = [ax.get_title() for ax in drawn[2].axes]
    assert stamps == ["frame 0", "frame 1", "frame 2", "frame 5", "frame 6", "frame 7"]


@pytest.mark.slow
def test_a_late_cell_has_the_recordings_times(scaled: Study, images: FloatArray, drawn: list[Figure]) -> None:
    paths = write_movie_figures(scaled, LATE, lambda time: images[time])
    assert _count(paths[-1]) == 2
    activity, _, edge, strip, consistency = drawn
    assert activity.axes[0].get_xlim() == (22.5, 32.5)
    assert [ax.get_title() for ax in strip.axes if ax.get_title()] == ["25 s", "30 s"]
    won = edge.axes[2].lines[1]
    assert won.get_xdata().tolist() == [25.0, 30.0]
    assert consistency.axes[0].lines[0].get_xdata().tolist() == [25.0, 30.0]


def test_a_cell_in_one_frame(scaled: Study, images: FloatArray, drawn: list[Figure]) -> None:
    paths = write_movie_figures(scaled, ONCE, lambda time: images[time])
    assert [path.name[len("cell_00002") :] for path in paths[2:]] == ["_edge.png", "_strip.png", ".gif"]
    words = {text.get_text() for text in drawn[2].texts}
    assert "no two frames in a row to compare" in words
    assert len(drawn[2].axes) == 1


def test_a_cell_without_map(scaled: Study) -> None:
    refused = scaled.cells.assign(status="refused", reason="mask is empty")
    assert write_movie_figures(replace(scaled, cells=refused), LATE) == []


@pytest.mark.slow
def test_images_may_be_missing(scaled: Study, images: FloatArray, drawn: list[Figure]) -> None:
    def signal(time: int) -> FloatArray | None:
        return None if time < 2 else images[time, :1]

    write_movie_figures(scaled, WHOLE, signal, animation=False)
    assert np.ma.getmaskarray(drawn[3].axes[0].images[0].get_array()).all()


def test_a_long_movie_is_thinned(bare: Study, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pages, "MOST_ANIMATED", 1)
    paths = write_movie_figures(bare, LATE)
    assert _count(paths[-1]) == 1


def test_figures_refuse(scaled: Study) -> None:
    with pytest.raises(ReadError, match="has no cell 9"):
        write_movie_figures(scaled, 9)
    with pytest.raises(SignalError, match=r"signal has shape \(3, 3\)"):
        write_movie_figures(scaled, ONCE, lambda _: np.ones((1, 3, 3)))


def test_fastest_frame_is_that_of_the_largest_leap_too() -> None:
    velocity = np.full((5, 20), 0.1)
    velocity[2] = -0.3
    velocity[3, 4] = 100.0
    velocity[4] = np.nan
    assert fastest_frame(velocity) == 3
    velocity[3, 4] = 0.1
    assert fastest_frame(velocity) == 2
    velocity[1, 1:] = np.nan
    velocity[1, 0] = 0.5  # the mean of those that are known
    assert fastest_frame(velocity) == 1
    assert fastest_frame(np.full((3, 4), np.nan)) is None
