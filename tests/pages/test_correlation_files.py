"""The pages of a correlation of a small study, as files."""

import re
import struct
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import tifffile
from matplotlib.figure import Figure

import cytodisk as cd
from cytodisk.errors import ParameterError, ReadError, StudyError
from cytodisk.pages.correlation_files import write_correlation_figures
from cytodisk.runs.channel_names import shortened
from cytodisk.runs.correlate.correlate_study import correlate_study
from cytodisk.runs.movie.movie_inputs import open_movie
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.movie.movie_study import movie_study
from cytodisk.simulate import movie
from cytodisk.store.correlation_store import Correlation

SMALL = MovieParameters(layers=3, sectors=8)
SHORT, LONG = "Rac1", "a very long name of a channel, much too long"
FEW: Any = {"max_lag": 5, "surrogates": 19}


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> cd.Study:
    folder = tmp_path_factory.mktemp("correlation_pages")
    truth = movie("fluctuating", 1, frames=24, radius_px=20, lag_frames=2)
    assert truth.signal is not None
    masks, signal = folder / "masks.tif", folder / "signal.ome.tif"
    tifffile.imwrite(masks, truth.masks.astype(np.uint8), metadata={"axes": "TYX"}, photometric="minisblack")
    metadata = {
        "axes": "TCYX",
        "Channel": {"Name": [SHORT, LONG]},
        "PhysicalSizeX": 0.2,
        "PhysicalSizeY": 0.2,
    }
    metadata |= {"TimeIncrement": 5.0, "TimeIncrementUnit": "s"}
    values = truth.signal.transpose("time", "channel", "y", "x").to_numpy()[:, :2]
    tifffile.imwrite(signal, values, metadata=metadata, photometric="minisblack", ome=True)
    return movie_study(open_movie(masks, signal, SMALL), folder / "out")


@pytest.fixture(scope="module")
def with_velocity(study: cd.Study) -> Correlation:
    return correlate_study(study, LONG, **FEW, detrend="linear", skip_lags=(-1, 0))


def _pixels_across(path: Path) -> int:
    return int(struct.unpack(">I", path.read_bytes()[16:20])[0])


def names(paths: list[Path]) -> list[str]:
    return [path.name for path in paths]


def test_pages_of_a_signal_with_velocity(
    study: cd.Study, with_velocity: Correlation, saved: list[Figure]
) -> None:
    steps: list[tuple[int, int]] = []
    paths = write_correlation_figures(study, with_velocity, progress=lambda *step: steps.append(step))
    assert names(paths) == [f"cell_00000_{what}.png" for what in ("curves", "maps", "peaks", "events")]
    assert {path.parent for path in paths} == {with_velocity.path / "figures"}
    assert sorted(path.name for path in paths[0].parent.iterdir()) == sorted(names(paths))
    assert steps == [(done, 5) for done in range(6)]
    for path, wide in zip(paths, (85, 119, 85, 119), strict=True):
        assert _pixels_across(path) == pytest.approx(wide / 25.4 * 300, abs=1.0)
    for figure in saved:
        words = " ".join(text.get_text() for text in figure.texts)
        assert "linear detrending" in words
        assert "without lags −1, 0" in words
        assert "grey: not used" not in words
    curves = saved[0]
    assert curves.axes[-1].get_xlabel().startswith("lag (s)\n← velocity first")


@pytest.mark.slow
def test_pages_of_two_signals(study: cd.Study, saved: list[Figure]) -> None:
    found = correlate_study(study, SHORT, LONG, **FEW, pairs=True)
    paths = write_correlation_figures(study, found)
    assert names(paths) == [f"cell_00000_{what}.png" for what in ("curves", "maps", "peaks", "pairs")]
    assert len(saved[-1].axes) >= 6  # two for each kind of distance
    edge = correlate_study(study, LONG, LONG, **FEW, against="edge")
    write_correlation_figures(study, edge)
    assert any("at the edge" in text.get_text() for text in saved[4].texts)


@pytest.mark.slow
def test_notes_of_pairs_say_which_way_is_up(study: cd.Study, saved: list[Figure]) -> None:
    write_correlation_figures(study, correlate_study(study, SHORT, LONG, **FEW, pairs=True))
    words = [text.get_text() for text in saved[-1].texts]
    assert f"lag: ↓ {shortened(LONG, 18)} first  ·  ↑ Rac1 first" in words
    assert sum("left out" in line for line in words) == 1


@pytest.mark.slow
def test_what_was_not_used_is_grey(study: cd.Study, saved: list[Figure]) -> None:
    some: Any = {"sectors": (6, 1), "frames": (2, 20), "without_frames": (9, 10), "name": "some"}
    write_correlation_figures(study, correlate_study(study, LONG, **FEW | some | {"min_pairs": 5}))
    _, maps, peaks, *events = saved
    for figure in saved:
        words = " ".join(text.get_text() for text in figure.texts)
        assert all(one in words for one in ("some", "only sectors 6–1", "only frames 2–20"))
        assert "without frames 9–10" in words
    left, right = (shown_places(maps, number) for number in (0, 1))
    assert left == ([0, 1, 6, 7], sorted(set(range(2, 21)) - {9, 10}))
    assert right == ([0, 1, 6, 7], sorted(set(range(2, 20)) - {8, 9, 10}))  # a step has two frames
    for figure in events:
        assert shown_places(figure, 0) == right
        assert any("averages not detrended" in text.get_text() for text in figure.texts)
    keys = [text.get_text() for text in peaks.legends[0].get_texts()]
    assert keys[-1] == "none, or not used"


def shown_places(figure: Figure, axes: int) -> tuple[list[int], list[int]]:
    """Sectors and frames of a map that are not all grey."""
    values = np.ma.filled(figure.axes[axes].images[0].get_array().astype(float), np.nan)
    known = np.isfinite(values)
    return np.flatnonzero(known.any(axis=1)).tolist(), np.flatnonzero(known.any(axis=0)).tolist()


@pytest.mark.slow
def test_without_surrogates_nothing_is_called_significant(study: cd.Study, saved: list[Figure]) -> None:
    found = correlate_study(study, LONG, "velocity_cell_frame", max_lag=4, surrogates=0)
    write_correlation_figures(study, found)
    words = [
        text.get_text() for figure in saved for text in figure.findobj(lambda one: hasattr(one, "get_text"))
    ]
    assert not any("significant" in word or "chance" in word for word in words)


def without_numbers(found: Correlation) -> Correlation:
    empty = replace(found)
    for name in ("windows", "layers", "curves", "layer_curves"):
        table = getattr(found, name)
        empty.__dict__[name] = table.assign(correlation=np.nan, **{"q": np.nan} if "q" in table else {})
    empty.__dict__["events"] = empty.__dict__["event_averages"] = None
    return empty


def test_a_cell_without_numbers_has_its_maps_alone(study: cd.Study, with_velocity: Correlation) -> None:
    paths = write_correlation_figures(study, without_numbers(with_velocity))
    assert names(paths) == ["cell_00000_maps.png"]


@pytest.mark.slow
def test_text_stays_text_and_the_same_picture_is_the_same_file(
    study: cd.Study, with_velocity: Correlation
) -> None:
    files: list[dict[Path, bytes]] = []
    for _ in range(2):
        paths = write_correlation_figures(study, with_velocity, formats=("svg",))
        paths += write_correlation_figures(study, without_numbers(with_velocity), formats=["pdf"])
        files.append({path: path.read_bytes() for path in paths})
    assert files[0] == files[1]
    *pages, (printed, content) = files[0].items()
    assert len(pages) == 4
    for path, page in pages:
        assert re.search(rb"<text[^>]*>cell 0", page), path
    assert printed.suffix == ".pdf"
    assert content.startswith(b"%PDF")
    assert b"/FontFile2" in content  # TrueType, not drawn shapes


def test_what_cannot_be_drawn_is_refused(study: cd.Study, with_velocity: Correlation, tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=r"formats.*'jpg'"):
        write_correlation_figures(study, with_velocity, formats=("png", "jpg"))
    with pytest.raises(ParameterError, match=r"cell 4 is not in .*: it has \[0\]"):
        write_correlation_figures(study, with_velocity, cell=4)
    refused = replace(with_velocity)
    refused.__dict__["cells"] = pd.DataFrame({"cell": [0], "status": ["refused"], "reason": ["too short"]})
    with pytest.raises(ParameterError, match="cell 0 has no correlation to draw: too short"):
        write_correlation_figures(study, refused)
    with pytest.raises(ReadError, match="does not exist"):
        write_correlation_figures(study, replace(with_velocity, path=tmp_path))
    blocked = replace(with_velocity, path=tmp_path)
    for name in ("cells", "windows", "layers", "layer_curves"):
        blocked.__dict__[name] = getattr(with_velocity, name)
    (tmp_path / "figures").write_text("")
    with pytest.raises(StudyError, match="cannot write"):
        write_correlation_figures(study, blocked)
