"""The first start, which compiles, says so."""

from pathlib import Path

import pytest

from cytodisk.files import has_kernels


def test_kernels_are_seen_once_there_are_any(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    assert not has_kernels(tmp_path)
    (tmp_path / "geometry").mkdir()
    (tmp_path / "geometry" / "mesh.nbi").touch()
    assert has_kernels(tmp_path)
