"""Compiled kernels are kept, so that only the first start compiles them."""

import os
import pkgutil
import subprocess
import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

import numba
import pytest
from numba.core.dispatcher import Dispatcher

import cytodisk
from cytodisk.kernel_cache import keep_kernels

LAYERS = ("geometry", "disk", "windows", "motion")
LOCATE = """
import numpy as np
from numba.core.dispatcher import Dispatcher
from cytodisk.geometry import locate
square = np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]])
locate.TriangleLocator(square, np.array([[0, 1, 2], [0, 2, 3]]))(np.full((1, 2), 0.4))
stats = [kernel.stats for kernel in vars(locate).values() if isinstance(kernel, Dispatcher)]
print(*(sum(sum(getattr(one, name).values()) for one in stats) for name in ("cache_misses", "cache_hits")))
"""


def kernels() -> list[Dispatcher]:
    found = {}
    for layer in LAYERS:
        package = import_module(f"cytodisk.{layer}")
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            for value in vars(import_module(module.name)).values():
                if isinstance(value, Dispatcher):
                    found[f"{value.py_func.__module__}.{value.py_func.__name__}"] = value
    return list(found.values())


def refuse(place: Path) -> Callable[..., None]:
    """`Path.mkdir` where nothing can be written below a folder."""
    mkdir = Path.mkdir

    def refusing(path: Path, *args: Any, **options: Any) -> None:
        if path.is_relative_to(place):
            raise PermissionError(13, "Permission denied", str(path))
        mkdir(path, *args, **options)

    return refusing


def test_every_kernel_is_kept() -> None:
    assert len(kernels()) > 20
    assert not [kernel for kernel in kernels() if kernel.stats.cache_path is None]


def test_a_second_process_compiles_nothing(tmp_path: Path) -> None:
    def misses_and_hits() -> list[int]:
        environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
        done = subprocess.run(
            [sys.executable, "-c", LOCATE], env=environment, capture_output=True, text=True, check=True
        )
        return [int(number) for number in done.stdout.split()]

    compiled, found = misses_and_hits()
    assert compiled >= 2
    assert found == 0
    compiled, found = misses_and_hits()
    assert compiled == 0
    assert found >= 2


def test_kernels_without_a_folder_last_for_a_run(monkeypatch: pytest.MonkeyPatch) -> None:
    """Numba would refuse to compile them."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", "")
    monkeypatch.setattr(numba.config, "CACHE_DIR", "")
    monkeypatch.setattr(Path, "mkdir", refuse(Path("/")))
    with pytest.warns(UserWarning, match="NUMBA_CACHE_DIR"):
        keep_kernels(Path(cytodisk.__file__).parent)
    assert os.environ["NUMBA_CACHE_DIR"] == numba.config.CACHE_DIR
    assert Path(numba.config.CACHE_DIR).is_dir()
    keep_kernels(Path("elsewhere"))  # as in the processes that it starts: silent


def test_kernels_beside_the_code_or_of_the_user_are_left_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", "")
    keep_kernels(tmp_path / "package")
    monkeypatch.setattr(Path, "mkdir", refuse(tmp_path / "package"))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "home"))
    keep_kernels(tmp_path / "package")
    assert os.environ["NUMBA_CACHE_DIR"] == ""
