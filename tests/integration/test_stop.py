"""Signals that ask a run to end: one line, the exit code of the signal, and nothing left behind."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import tifffile

from cytodisk import simulate
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
        [sys.executable, "-m", "cytodisk", *given], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
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
    left = [
        path.name for path in tmp_path.rglob("*") if path.name.startswith(".cytodisk") or ".tmp" in path.name
    ]
    assert left == []
