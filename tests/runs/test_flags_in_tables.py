"""Names of QC flags stand in the rows of the frames and cells that they name, and in no other."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import tifffile
from movie_files import SMALL, Stopped, stop_after, write_masks, write_movie

import cytodisk as cd
from cytodisk.images.frames import open_frames
from cytodisk.runs.channel_names import channels_words
from cytodisk.runs.correlate.correlate_study import correlate_study
from cytodisk.runs.flagged_cells import names_by_row
from cytodisk.runs.movie.movie_inputs import MovieInputs, open_movie
from cytodisk.runs.movie.movie_study import movie_study
from cytodisk.runs.qc_flags.qc_flag import Place, QCFlag
from cytodisk.simulate import disk, movie

JUMPS = [4, 9]


@pytest.fixture(scope="module")
def leaping(tmp_path_factory: pytest.TempPathFactory) -> MovieInputs:
    """A disk that is larger from frame 4 on, and smaller again from frame 9 on."""
    masks = np.zeros((14, 70, 70), np.uint8)
    for frame in range(14):
        cell = disk(22.0 if 4 <= frame < 9 else 20.0)
        low = 35 - cell.shape[0] // 2
        masks[frame, low : low + cell.shape[0], low : low + cell.shape[1]] = cell
    return open_movie(write_masks(tmp_path_factory.mktemp("leaping") / "m.tif", masks), None, SMALL)


def flagged(study: cd.Study, name: str) -> list[int]:
    names = study.cells["qc_flags"].str.split("; ")
    return study.cells["frame"][[name in row for row in names]].tolist()


def test_area_jumps_stand_in_the_rows_of_these_frames_alone(leaping: MovieInputs, tmp_path: Path) -> None:
    study = movie_study(leaping, tmp_path / "out")
    assert flagged(study, "area jumps") == JUMPS
    assert "flagged masks" not in {flag.name for flag in cd.qc_flags(study)}
    for flag in cd.qc_flags(study):
        assert flagged(study, flag.name) == [place.frame for place in flag.places]
    assert (study.cells["mask_remarks"] == "").all()


def test_a_run_that_was_resumed_has_the_same(leaping: MovieInputs, tmp_path: Path) -> None:
    whole = movie_study(leaping, tmp_path / "whole")
    with pytest.raises(Stopped):
        movie_study(leaping, tmp_path / "out", progress=stop_after(6))
    resumed = movie_study(leaping, tmp_path / "out", resume=True)
    pd.testing.assert_series_equal(resumed.cells["qc_flags"], whole.cells["qc_flags"])
    assert flagged(resumed, "area jumps") == JUMPS
    assert resumed.cells.attrs == whole.cells.attrs


def disks_in_a_row(*radii: int) -> np.ndarray:
    """A label image of disks; the first one touches the border."""
    labels = np.zeros((40, 45 * len(radii)), np.uint8)
    for number, radius in enumerate(radii):
        y, x = np.mgrid[:40, : labels.shape[1]]
        labels[np.hypot(y - 19.0, x - 45 * number - (15 if number else radius - 1)) <= radius] = number + 1
    return labels


LABELS = disks_in_a_row(9, 17, 7)
MASKS = {
    "one mask": {"m.tif": (LABELS == 1).astype(np.uint8)},
    "stack": {"m.tif": np.stack([k == LABELS for k in (2, 1, 3)]).astype(np.uint8)},
    "label image": {"m.tif": LABELS},
    "stack of label images": {"m.tif": np.stack([LABELS, LABELS[:, ::-1]])},
    "folder": {"m/a.tif": LABELS, "m/b.tif": np.zeros_like(LABELS), "m/c.tif": LABELS[::-1]},
}


@pytest.mark.parametrize("masks", list(MASKS))
def test_rows_of_a_map_have_the_names_of_the_flags_of_their_cell(masks: str, tmp_path: Path) -> None:
    for name, values in MASKS[masks].items():
        axes = {"axes": "TYX" if values.ndim == 3 else "YX"}
        (tmp_path / name).parent.mkdir(exist_ok=True)
        tifffile.imwrite(tmp_path / name, values, photometric="minisblack", metadata=axes)
    path = tmp_path / Path(next(iter(MASKS[masks]))).parts[0]
    study = cd.run_map(path, tmp_path / "out", layers=4, sectors=12)
    cells = study.cells.set_index("cell")
    named = {cell: set(filter(None, words.split("; "))) for cell, words in cells["qc_flags"].items()}
    flags = cd.qc_flags(study)
    assert {flag.name for flag in flags} >= {"small windows", "image border"}
    assert named == {
        cell: {flag.name for flag in flags if cell in [place.cell for place in flag.places]} for cell in named
    }
    small = [cell for cell, names in named.items() if "small windows" in names]
    assert small == cells.index[cells["median_window_px"] < 10.0].tolist()
    assert 0 < len(small) < len(cells) or masks == "one mask"


def test_a_flag_of_a_cell_stands_in_each_of_its_rows() -> None:
    one = QCFlag("signal drift", "", "", "", (Place(1, None, "a"), Place(1, None, "b")))
    other = QCFlag("area jumps", "", "", "", (Place(1, 3), Place(0, 2)))
    rows = [(0, 2), (0, 3), (1, 2), (1, 3)]
    assert names_by_row([one, other], rows) == ["area jumps", "", "signal drift", "signal drift; area jumps"]
    assert names_by_row([one], [(0, None), (1, None)]) == ["", "signal drift"]


def test_flags_of_a_correlation_stand_in_its_table_of_cells(tmp_path: Path) -> None:
    truth = movie("fluctuating", 3, frames=24, radius_px=14)
    growing = truth.signal * np.linspace(1.0, 4.0, 24)[:, None, None, None]
    truth = replace(truth, signal=growing.astype(truth.signal.dtype))
    study = movie_study(open_movie(*write_movie(tmp_path, truth), SMALL), tmp_path / "out")
    found = correlate_study(study, "edge", max_lag=3, surrogates=19, geometry=False)
    own = {flag.name for flag in cd.qc_flags(study) if any("edge with" in p.note for p in flag.places)}
    assert "drifting series" in own
    assert set(found.cells["qc_flags"].iloc[0].split("; ")) == own
    detrended = correlate_study(
        study, "edge", max_lag=3, surrogates=19, geometry=False, detrend="linear", name="x"
    )
    assert "drifting series" not in detrended.cells["qc_flags"].iloc[0].split("; ")


def test_channels_without_a_name_say_how_to_name_them(tmp_path: Path) -> None:
    named = {"axes": "CYX", "Channel": {"Name": ["Rac1", "RhoA"]}}
    tifffile.imwrite(tmp_path / "a.ome.tif", np.zeros((2, 5, 6), dtype=np.uint8), metadata=named)
    assert channels_words(open_frames(tmp_path / "a.ome.tif")) == "channels Rac1, RhoA"
    tifffile.imwrite(tmp_path / "cell.tif", np.zeros((5, 6), dtype=np.uint8))
    words = channels_words(open_frames(tmp_path / "cell.tif"))
    assert words == "1 channel without a name: it is called cell (name it: --channels Rac1)"
    tifffile.imwrite(tmp_path / "c.ome.tif", np.zeros((2, 5, 6), dtype=np.uint8), metadata={"axes": "CYX"})
    words = channels_words(open_frames(tmp_path / "c.ome.tif"))
    assert "they are called c 1, c 2 (name them: --channels Rac1,RhoA)" in words
