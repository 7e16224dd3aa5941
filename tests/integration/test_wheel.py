"""The wheel alone, in a new environment without extras, does what needs none."""

import os
import re
import subprocess
import sys
import tarfile
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import tifffile

import cytodisk as cd

pytestmark = [pytest.mark.slow, pytest.mark.timeout(900)]
ROOT = Path(__file__).parents[2]
GRID = ("--layers", "3", "--sectors", "8", "--figures", "0")


def ends(*command: str | Path, folder: Path, code: int = 0) -> str:
    """What a command prints that ends with this code and in time."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run(
        [str(word) for word in command],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=600,
    )
    assert done.returncode == code, done.stdout + done.stderr
    return done.stdout + done.stderr


@pytest.fixture(scope="module")
def environment(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The `bin` of an environment that holds the wheel and what it asks for, nothing else."""
    folder = tmp_path_factory.mktemp("wheel")
    ends(sys.executable, "-m", "build", "--outdir", folder, ROOT, folder=folder)
    (wheel,) = folder.glob("*.whl")
    (source,) = folder.glob("*.tar.gz")
    with tarfile.open(source) as archive:
        packed = {name.partition("/")[2] for name in archive.getnames()}
    shown = set(re.findall(r"!\[[^]]*\]\(([^)]+)\)", (ROOT / "README.md").read_text(encoding="utf-8")))
    assert "docs/images/real_cell.png" in shown <= packed
    assert f"-{cd.__version__}-" in wheel.name
    ends(sys.executable, "-m", "venv", folder / "venv", folder=folder)
    programs = folder / "venv" / "bin"
    ends(programs / "pip", "install", "-c", ROOT / "constraints.txt", wheel, folder=folder)
    return programs


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of a movie of a small cell, and of an image with a dozen cells."""
    folder = tmp_path_factory.mktemp("files")
    truth = cd.simulate.movie("fluctuating", frames=24, radius_px=12.0)
    assert truth.signal is not None
    tifffile.imwrite(folder / "masks.tif", truth.masks.astype(np.uint8), metadata={"axes": "TYX"})
    tifffile.imwrite(folder / "signal.ome.tif", truth.signal.to_numpy(), metadata={"axes": "TCYX"})
    tifffile.imwrite(folder / "labels.tif", cd.simulate.label_image(12, 0))
    return folder


def test_demo(environment: Path, tmp_path: Path) -> None:
    said = ends(environment / "cytodisk", "demo", folder=tmp_path)
    assert "each one to one" in said
    assert "pip install" in said  # the report needs an extra
    assert len(cd.open_study(tmp_path / "cytodisk_demo" / "study").cells) == 40


def test_map(environment: Path, files: Path, tmp_path: Path) -> None:
    ends(environment / "cytodisk", "map", files / "labels.tif", "-o", "out", *GRID, folder=tmp_path)
    assert cd.open_study(tmp_path / "out").cells["certificate_valid"].all()


def test_movie_and_correlate(environment: Path, files: Path, tmp_path: Path) -> None:
    masks, signal = files / "masks.tif", files / "signal.ome.tif"
    ends(environment / "cytodisk", "movie", masks, "--signal", signal, "-o", "out", *GRID, folder=tmp_path)
    study = cd.open_study(tmp_path / "out")
    channel = str(study.activity(0)["channel"].to_numpy()[0])
    flags = ("--signal", channel, "--with", "velocity", "--max-lag", "4", "--surrogates", "19")
    ends(environment / "cytodisk", "correlate", "out", *flags, folder=tmp_path)
    assert len(study.correlation(channel, "velocity").windows) == 3 * 8


def test_shapes_without_umap(environment: Path, files: Path, tmp_path: Path) -> None:
    """Features come whole; the score says what to install."""
    said = ends(environment / "cytodisk", "shapes", files / "labels.tif", "-o", "out", folder=tmp_path)
    assert "pip install" in said
    assert "umap" in said
    table = pd.read_parquet(tmp_path / "out" / "shapes.parquet")
    assert table["circularity"].between(0.0, 1.01).all()
    assert len(table) == 12


def test_demons_says_what_to_install(environment: Path, files: Path, tmp_path: Path) -> None:
    tracker = ("--tracker", "demons")
    command = ("movie", files / "masks.tif", "-o", "out", *GRID, *tracker)
    said = ends(environment / "cytodisk", *command, folder=tmp_path, code=2)
    assert "pip install" in said
    assert "demons" in said
    assert "Traceback" not in said
