"""Signals that ask a run to end: one line, the exit code of the signal, and nothing left behind."""

import os
import signal
import subprocess
import sys
from functools import partial
from pathlib import Path

import numpy as np
import pytest
import tifffile
from command_line import content

import cytodisk as cd
from cytodisk import simulate
from cytodisk.runs.batch.batch_target import RUN
from deadlines import wait_until

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not hasattr(os, "killpg"), reason="signals are POSIX"),
]
COMMANDS = {
    "map": ("--workers", "2", "--figures", "0"),
    "movie": ("--figures", "0"),
    "batch": ("--workers", "2"),
}


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("files")
    masks = simulate.movie("growing", frames=60, radius_px=30.0).masks.astype(np.uint8)
    masks = np.concatenate([masks, masks[::-1]] * 8)  # longer than it takes to see that a part is done
    tifffile.imwrite(folder / "masks.tif", masks, metadata={"axes": "TYX"}, photometric="minisblack")
    (folder / "study.toml").write_text("[study]\nkind = 'movie'\n[[inputs]]\nmasks = 'masks.tif'\n")
    return folder


@pytest.mark.parametrize(
    ("command", "number"),
    [("map", signal.SIGINT), ("movie", signal.SIGTERM), ("batch", signal.SIGTERM), ("movie", signal.SIGHUP)],
)
def test_it_ends_in_one_line_and_leaves_no_lock(
    files: Path, tmp_path: Path, command: str, number: signal.Signals
) -> None:
    source = files / ("study.toml" if command == "batch" else "masks.tif")
    given = [command, str(source), "-o", str(tmp_path / "out"), *COMMANDS[command]]
    started = subprocess.Popen(
        [sys.executable, "-m", "cytodisk", *given],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=partial(signal.signal, number, signal.SIG_DFL),  # tests under nohup ignore SIGHUP
    )
    try:
        wait_until(
            lambda: any(tmp_path.rglob(".parts/*.json")) or started.poll() is not None, "a part was done"
        )
        started.send_signal(number)
        _, error = started.communicate(timeout=30)
    finally:
        started.kill()
    assert started.returncode == 128 + number
    told = [line for line in error.splitlines() if not line.startswith("First start")]
    assert len(told) == 1, error
    assert told[0].startswith("Stopped; what was done is kept")
    names = {path.name for path in tmp_path.rglob("*")} - {RUN}  # a batch's record of its run, which stays
    assert [name for name in names if name.startswith(".cytodisk") or ".tmp" in name] == []


@pytest.fixture(scope="module")
def study(files: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Of the first frames: enough to be read while it is seen that one of them is."""
    folder = tmp_path_factory.mktemp("read")
    masks = tifffile.imread(files / "masks.tif")[:90]
    counts = np.random.default_rng(0).poisson(90, masks.shape).astype(np.uint16)
    for name, frames in (("masks.tif", masks), ("signal.tif", counts)):
        tifffile.imwrite(folder / name, frames, metadata={"axes": "TYX"}, photometric="minisblack")
    given = {"signal": folder / "signal.tif", "layers": 3, "sectors": 12}
    return cd.run_movie(folder / "masks.tif", folder / "study", **given).path


# The command line in a process that says when it opens a file of the study with a given ending.
_TOLD = """
import sys
from pathlib import Path
said, ending = Path(sys.argv[1]), sys.argv[2]
def hear(event, arguments):
    if event == "open" and str(arguments[0]).endswith(ending) and not said.exists():
        said.touch()
sys.addaudithook(hear)
sys.argv = ["cytodisk", *sys.argv[3:]]
from cytodisk.cli import main
main()
"""


@pytest.mark.parametrize(
    ("command", "ending"),
    [
        (("correlate", "--surrogates", "100000", "--pairs"), "activity.zarr.zip"),
        (("report",), "00_t00020.npz"),
    ],
)
def test_what_reads_a_study_leaves_it_as_it_was(
    study: Path, tmp_path: Path, command: tuple[str, ...], ending: str
) -> None:
    before, said = content(study), tmp_path / "said"
    given = [sys.executable, "-c", _TOLD, str(said), ending, command[0], str(study), *command[1:]]
    started = subprocess.Popen(given, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        wait_until(lambda: said.exists() or started.poll() is not None, f"{ending} was read")
        started.send_signal(signal.SIGTERM)
        _, error = started.communicate(timeout=30)
    finally:
        started.kill()
    assert started.returncode == 143
    assert error in ("Stopped.\n", "Stopped; nothing was changed.\n")
    assert content(study) == before
