"""Results on maps of an earlier version are told where they are read."""

import json
from pathlib import Path

import pytest
import tifffile

import cytodisk as cd
from cytodisk.errors import EarlierVersionWarning


def as_earlier(folder: Path) -> Path:
    """Make a finished run one of version 0.1.0, which did not write down the version of its maps."""
    path = folder / "provenance.json"
    found = json.loads(path.read_text())
    del found["fingerprint"]["maps version"]
    found["versions"]["cytodisk"] = "0.1.0"
    path.write_text(json.dumps(found))
    return folder


@pytest.fixture
def labels(tmp_path: Path) -> Path:
    path = tmp_path / "labels.tif"
    tifffile.imwrite(path, cd.simulate.label_image(cells=2))
    return path


def test_a_comparison(labels: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    cd.run_compare_windows(labels, out, layers=2, sectors=4, methods=("edge",))
    cd.open_comparison(out)  # not a word on results of today
    with pytest.warns(EarlierVersionWarning, match=r"comparison .*out: Maps by cytodisk 0\.1\.0"):
        cd.open_comparison(as_earlier(out))


def test_shapes(labels: Path, tmp_path: Path) -> None:
    cd.run_shapes(labels, tmp_path / "out")
    cd.open_shapes(tmp_path / "out")
    with pytest.warns(EarlierVersionWarning, match=r"features of distortion .* by cytodisk 0\.1\.0\. Do not"):
        cd.open_shapes(as_earlier(tmp_path / "out"))
