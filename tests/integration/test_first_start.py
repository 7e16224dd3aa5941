"""The first start, which compiles, says so."""

import os
import subprocess
import sys
from itertools import chain
from pathlib import Path

import numba
import pytest

from cytodisk.cli.first_start import say_compiling
from cytodisk.geometry import lower_envelope
from cytodisk.runs.told.compiling_words import LATE

COMPILE = """
import numpy as np
from cytodisk.geometry import lower_envelope
lower_envelope.outside_in_column(np.eye(4, dtype=bool))
"""
ASK = """
from cytodisk.kernel_cache import has_kernels
from cytodisk.geometry import lower_envelope
print(has_kernels(lower_envelope))
"""


def run(code: str, cache: Path) -> str:
    environment = os.environ | {"NUMBA_CACHE_DIR": str(cache)}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_kernels_are_seen_once_they_are_compiled(tmp_path: Path) -> None:
    assert run(ASK, tmp_path) == "False"
    run(COMPILE, tmp_path)
    assert run(ASK, tmp_path) == "True"
    (index,) = tmp_path.rglob("*.nbi")
    written = Path(lower_envelope.__file__).stat().st_mtime
    os.utime(index, (written - 5, written - 5))
    assert run(ASK, tmp_path) == "False"  # the code is newer
    os.utime(index)
    here = numba.__version__.encode()
    index.write_bytes(index.read_bytes().replace(here, b"0" * len(here)))
    assert run(ASK, tmp_path) == "False"  # of another Numba


@pytest.mark.parametrize("work", LATE)
def test_a_line_says_what_takes_long(
    work: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("cytodisk.kernel_cache.has_kernels", lambda module: False)
    say_compiling(False, work)
    said = capsys.readouterr()
    assert said.err.startswith("First start: compiling numerical code, once. ")
    assert "about 20 s on an idle computer, longer on a busy one" in said.err
    assert said.err.count("\n") == 1
    assert said.out == ""
    say_compiling(True, work)
    with monkeypatch.context() as unkept:
        unkept.setenv("NUMBA_CACHE_DIR", "/tmp/cytodisk-kernels-abc")
        assert say_compiling(False, work)  # a warning has said that each start compiles
    monkeypatch.setattr("cytodisk.kernel_cache.has_kernels", lambda module: True)
    assert not say_compiling(False, work)
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("module", sorted(set(chain(*LATE.values()))))
def test_the_modules_that_are_asked_have_kernels(module: str, tmp_path: Path) -> None:
    ask = f"from cytodisk.kernel_cache import has_kernels as has; import {module} as m; print(has(m))"
    assert run(ask, tmp_path) == "False"  # a module without kernels has none to miss


def test_without_compiling_nothing_is_missing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NUMBA_DISABLE_JIT", "1")
    assert run(ASK, tmp_path) == "True"
