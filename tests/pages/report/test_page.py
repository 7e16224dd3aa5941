import builtins
import html
import json
import re
import shlex
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile
from report_study import FRAMES, GAP, NAMES

from cytodisk.errors import MissingPartError, ParameterError, SignalError, StudyError
from cytodisk.images.frames import open_frames
from cytodisk.pages.report import encoded_cells as page
from cytodisk.pages.report.movie_page import page_flags
from cytodisk.pages.report.page import write_report
from cytodisk.pages.report.shown_cell import ShownCell
from cytodisk.runs.movie.movie_inputs import open_movie
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.movie.movie_study import movie_study
from cytodisk.runs.qc_flags.study_flags import qc_flags
from cytodisk.simulate.moving_cells import SimulatedMovie
from cytodisk.store.inputs.study_signal import find_signal
from cytodisk.store.study import Study, open_study


def test_page_is_one_file_within_its_size(written: Path) -> None:
    text = written.read_text(encoding="utf-8")
    assert len(text) < 5_000_000
    outside = re.findall(r"""(?:src|href)=["']?(?!data:)([^"'> ]+)""", text.split("<script>")[0])
    assert outside == []
    assert NAMES[0] not in text
    assert text.count("</script>") == text.count("<script")


@pytest.mark.slow
def test_default_path_and_progress_and_the_same_page_again(study: Study, tmp_path: Path) -> None:
    done: list[tuple[int, int]] = []
    path = write_report(study, progress=lambda *step: done.append(step))
    assert path == study.path / "report.html"
    assert done == [(number + 1, FRAMES) for number in range(FRAMES)]
    assert not list(study.path.glob(".report*"))
    again = write_report(study, str(tmp_path / "b.html"))
    pages = [page.read_text(encoding="utf-8") for page in (path, again)]
    path.unlink()
    assert pages[0] == pages[1]


def test_study_without_a_map_is_refused(study: Study) -> None:
    nothing = Study(study.path, study.cells.assign(status="refused"), study.provenance)
    with pytest.raises(StudyError, match="has no mapped frame"):
        write_report(nothing)


def test_unknown_cell_is_refused(study: Study) -> None:
    with pytest.raises(ParameterError, match=r"cell.*4"):
        write_report(study, cell=4)


def test_folder_that_is_not_there(study: Study, tmp_path: Path) -> None:
    with pytest.raises(StudyError, match="cannot write"):
        write_report(study, tmp_path / "missing" / "report.html")


def test_signal_that_does_not_fit(study: Study, masks: Path) -> None:
    with pytest.raises(SignalError, match=r"8 frames of 1 channels.*2 channels"):
        write_report(study, signal=open_frames(masks))


def test_signal_of_another_size(study: Study, signal: Path, tmp_path: Path) -> None:
    """Refused if it was given; a QC flag and plain masks if it was found."""
    height, width = study.provenance["image_shape"]
    words = f"has images of {height} × {width} pixels, the study's masks have {height + 2} × {width}"
    other = Study(study.path, study.cells, study.provenance | {"image_shape": [height + 2, width]})
    with pytest.raises(SignalError, match=f"signal {words}"):
        write_report(other, tmp_path / "report.html", signal=open_frames(signal))
    assert not (tmp_path / "report.html").exists()
    found = find_signal(other)
    assert found.source is None
    assert words in found.fault
    assert "signal.ome.tif is not the movie that was measured" in page_flags(other)[0].what


@pytest.mark.slow
def test_flags_of_the_page_in_one_list(study: Study, tmp_path: Path) -> None:
    gone = dict(study.provenance["inputs"]["signal"], path=str(tmp_path / "gone.tif"))
    moved = Study(study.path, study.cells, study.provenance | {"inputs": {"signal": gone}})
    flags = page_flags(moved)
    assert [flag.name for flag in flags] == ["signal not shown", *(flag.name for flag in qc_flags(study))]
    assert "cytodisk report study --signal FILE" in flags[0].advice
    assert page_flags(study) == qc_flags(study)
    text = html.unescape(write_report(moved, tmp_path / "report.html").read_text(encoding="utf-8"))
    assert f"QC flags: {len(flags)}" in text
    for flag in flags:
        assert flag.what in text


def test_page_tells_no_folder_and_no_computer(study: Study, tmp_path: Path) -> None:
    gone = dict(study.provenance["inputs"]["signal"], path=str(tmp_path / "gone.tif"))
    inputs = study.provenance["inputs"] | {"signal": gone}
    warnings = [f"{study.provenance['inputs']['masks']['path']} is odd"]
    moved = Study(study.path, study.cells, study.provenance | {"inputs": inputs, "warnings": warnings})
    text = write_report(moved, tmp_path / "report.html").read_text(encoding="utf-8")
    assert "masks.tif is odd" in text
    assert "gone.tif" in text
    assert str(study.path.parent) not in text
    assert str(tmp_path) not in text
    assert study.provenance["platform"] not in text


def test_settings_say_what_was_used(written: Path) -> None:
    """The scale stands in the file, not among the parameters."""
    text = written.read_text(encoding="utf-8")
    assert '<th scope="row">pixel_size_um</th><td>0.16 (not given; this was found and used)</td>' in text
    assert '<th scope="row">frame_interval_s</th><td>5 (not given; this was found and used)</td>' in text


def test_missing_jinja_names_what_to_type(study: Study, monkeypatch: pytest.MonkeyPatch) -> None:
    real = builtins.__import__

    def refuse(name: str, *args: Any) -> Any:
        if name.startswith("jinja2"):
            raise ImportError(name)
        return real(name, *args)

    monkeypatch.setattr(builtins, "__import__", refuse)
    with pytest.raises(MissingPartError, match=re.escape("pip install 'cytodisk[report]'")):
        write_report(study)


def test_signal_is_found_from_the_studys_surroundings(
    study: Study, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    told = {"path": "signal.ome.tif", "sha256": study.provenance["inputs"]["signal"]["sha256"]}
    moved = Study(study.path, study.cells, study.provenance | {"inputs": {"signal": told}})
    found = find_signal(moved)
    assert found.fault == ""
    assert found.source is not None
    assert found.source.channels == tuple(NAMES)


@pytest.mark.parametrize("change", ["gone", "changed", "damaged"])
def test_signal_that_is_not_what_was_measured(
    study: Study, signal: Path, tmp_path: Path, change: str
) -> None:
    copy = tmp_path / "signal.ome.tif"
    told = dict(study.provenance["inputs"]["signal"], path=str(copy))
    if change == "changed":
        copy.write_bytes(signal.read_bytes() + b" ")
    if change == "damaged":
        copy.write_bytes(b"no image")
        told["sha256"] = "f22ef4e8ccb7bda65b7a3c5d6d1c5d3d0b9a4a58ccbb46d9cb9b8fdbbfdd2d4b"
    changed = Study(study.path, study.cells, study.provenance | {"inputs": {"signal": told}})
    found = find_signal(changed)
    assert found.source is None
    words = {"gone": "is not there any more", "changed": "sha256 differs", "damaged": "sha256 differs"}
    assert words[change] in found.fault
    text = write_report(changed, tmp_path / "report.html").read_text(encoding="utf-8")
    assert "pixels are not on this page" in text
    assert "no pixels to show" in text


@pytest.mark.slow
def test_other_cells_and_their_page(truth: SimulatedMovie, tmp_path: Path) -> None:
    """A second cell, mirrored, leaves after three frames."""
    first = truth.masks.astype(np.uint8)
    second = 2 * first[:, :, ::-1] * (np.arange(FRAMES) < 3)[:, None, None].astype(np.uint8)
    labels = np.concatenate([first, second], axis=2)
    tifffile.imwrite(tmp_path / "labels.tif", labels, metadata={"axes": "TYX"}, photometric="minisblack")
    parameters = MovieParameters(layers=2, sectors=6, kind="labels")
    study = movie_study(open_movie(tmp_path / "labels.tif", None, parameters), tmp_path / "two")
    assert write_report(study).name == "report.html"
    assert write_report(study, cell=0).name == "report.html"
    other = write_report(study, cell=1)
    assert other.name == "report_cell_00001.html"
    text = re.sub(r"\s+", " ", other.read_text(encoding="utf-8"))
    assert "All cells of the study (2)" in text
    assert f'data-cell="0" data-frame="{GAP}"' in text
    assert [text.count(f'<script type="application/json" id="cell-{cell}">') for cell in (0, 1)] == [1, 1]
    assert json.loads(re.findall(r'id="study">(.*?)</script>', text)[0])["first"] == 1


@pytest.mark.slow
def test_frames_larger_than_expected_are_thinned_out(
    study: Study, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(page, "MOST_BYTES", 60_000)
    monkeypatch.setattr(page.Pictures, "every", lambda *_: 1)
    text = write_report(study, tmp_path / "report.html").read_text(encoding="utf-8")
    every, shown = re.findall(r"One frame in (\d) is shown, (\d) of 8", text)[0]
    assert int(shown) == -(-FRAMES // int(every)) < FRAMES


def test_command_to_type_is_quoted(study: Study, tmp_path: Path) -> None:
    """As the page has it for a study without correlations."""
    fresh = tmp_path / "my study"
    shutil.copytree(study.path, fresh, ignore=shutil.ignore_patterns("correlation"))
    text = html.unescape(write_report(open_study(fresh)).read_text(encoding="utf-8"))
    assert f"cytodisk correlate 'my study' --signal {shlex.quote(NAMES[0])} --with velocity" in text


def test_flags_of_a_run_name_its_gap_first(study: Study) -> None:
    first, *others = qc_flags(study)
    assert first.name in ("refused frames", "missing frames")
    assert [(place.cell, place.frame) for place in first.places] == [(0, GAP)]
    assert all(place.frame is None or place.frame < FRAMES for flag in others for place in flag.places)


def test_study_that_was_made_before_windows_had_a_depth(
    study: Study, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = Study.activity
    depths = ["depth", "depth_p5", "depth_p95"]
    monkeypatch.setattr(Study, "activity", lambda self, cell=0: whole(self, cell).drop_vars(depths))
    assert write_report(study, tmp_path / "old.html").stat().st_size > 100_000
    shown = ShownCell(study, 0).as_json()
    assert set(shown["layer_depths"]) == {""}
    assert shown["units"]["depth"] == study.scale.length_unit
