"""`cytodisk batch`: what it prints, with runs that nothing computes."""

import csv
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import tifffile
from command_line import Run, assert_refused

from cytodisk.runs.batch import batch_study as module
from cytodisk.runs.batch.batch_study import BatchSummary
from cytodisk.runs.batch.input_row import InputRow


@pytest.fixture
def study(tmp_path: Path) -> Path:
    for name in ("a.tif", "b.tif"):
        tifffile.imwrite(
            tmp_path / name, np.zeros((3, 8, 8), np.uint8), photometric="minisblack", metadata={"axes": "TYX"}
        )
    text = '[study]\ncolumns = ["dose"]\n[[inputs]]\nmasks = "*.tif"\ncondition = "one, two"\ndose = 2\n'
    (tmp_path / "study.toml").write_text(text, encoding="utf-8")
    return tmp_path / "study.toml"


def row(name: str, status: str, reason: str) -> InputRow:
    return InputRow(name, "movie", status, reason, "", "")


def test_a_dry_run_lists_the_inputs(run: Run, study: Path) -> None:
    code, said, _ = run("batch", study, "-o", study.parent / "out", "--dry-run", "-q")
    masks = [study.parent / name for name in ("a.tif", "b.tif")]
    assert code == 0
    assert said.splitlines() == [
        "name,kind,masks,signal,condition,experiment,dose,"
        "frames,pixel_size_um,frame_interval_s,channels,layers,sectors,parameters,fault",
        f'a,movie,{masks[0]},,"one, two",,2,3,,,,10,60,,',
        f'b,movie,{masks[1]},,"one, two",,2,3,,,,10,60,,',
    ]
    assert not (study.parent / "out").exists()


def test_a_dry_run_says_what_the_files_say_and_which_do_not_fit(run: Run, study: Path) -> None:
    image = np.zeros((2, 8, 8), np.uint16)
    scale = {"axes": "CYX", "PhysicalSizeX": 0.2, "PhysicalSizeY": 0.2}
    tifffile.imwrite(
        study.parent / "image.ome.tif", image, metadata=scale | {"Channel": {"Name": ["A", "B"]}}
    )
    tifffile.imwrite(study.parent / "labels.tif", image[0] + 1)
    text = """
[parameters]
sectors = 12
nan = "omit"
[[inputs]]
masks = "labels.tif"
kind = "map"
signal = "image.ome.tif"
[[inputs]]
masks = "[ab].tif"
frame_interval_s = 5
parameters = {depth_um = 2.0}
channels = ["C"]
"""
    study.write_text(text, encoding="utf-8")
    code, said, errors = run("batch", study, "-o", study.parent / "out", "--dry-run", "-q")
    first, second, _ = csv.DictReader(said.splitlines())
    assert (first["pixel_size_um"], first["channels"], first["sectors"]) == ("0.2", "A; B", "12")
    assert (first["layers"], first["parameters"], first["fault"]) == ("10", 'nan = "omit"', "")
    assert (second["frame_interval_s"], second["layers"], second["channels"]) == ("5.0", "2", "C")
    assert second["parameters"] == 'nan = "omit"; depth_um = [2.0]'
    assert "there is no signal" in second["fault"]
    assert code == 2
    assert "2 of 3 inputs cannot be used" in errors


def test_a_file_that_cannot_be_used_is_refused(run: Run, study: Path) -> None:
    study.write_text('[[inputs]]\nmask = "*.tif"\n', encoding="utf-8")
    assert_refused(run("batch", study, "-o", study.parent / "out"), "did you mean 'masks'?", str(study))
    assert_refused(run("batch", study.parent / "none.toml", "-o", "out"), "cannot be read")


@pytest.mark.parametrize(("ok", "code"), [(3, 0), (0, 2)])
def test_what_failed_is_said(
    run: Run, study: Path, monkeypatch: pytest.MonkeyPatch, ok: int, code: int
) -> None:
    failed = [row("a", "refused", "mask is empty"), row("b", "timed out", "took longer")]
    statuses = Counter({"ok": ok, "refused": 1, "timed out": 30})
    summary = BatchSummary("out", statuses, failed, ["a remark"])
    monkeypatch.setattr(module, "batch_study", lambda *args, **options: summary)
    exit_code, said, errors = run("batch", study, "-o", "out", "--no-report")
    assert exit_code == code
    assert said.splitlines()[:4] == [
        "inputs: 2 (movies 2)",
        f"{ok} of {ok + 31} inputs done; 1 refused, 30 timed out",
        "note: a remark",
        "mend what failed and run the same command with --resume: only that is done again",
    ]
    assert "a refused: mask is empty\nb timed out: took longer\n… and 29 more" in errors
    assert ("no input went well" in errors) == (not ok)


def test_qc_flags_of_the_inputs_are_counted(run: Run, study: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    summary = BatchSummary("out")
    for flags in ("area jumps; image border", "area jumps", ""):
        summary.count(replace(row("c", "ok", ""), flags=flags))
    monkeypatch.setattr(module, "batch_study", lambda *args, **options: summary)
    said = run("batch", study, "-o", "out")[1]
    words = "QC flags, by number of inputs: area jumps (2), image border (1); column 'flags' of inputs.csv"
    assert words in said.splitlines()
