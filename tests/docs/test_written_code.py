"""What README and docs show: their Python runs, their pages are there, and README stays short."""

import re
import sys
import textwrap
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
import tifffile

import cytodisk as cd
from cytodisk.cli import app
from cytodisk.runs.demo_input import write_demo_input

REPOSITORY = Path(__file__).parents[2]
README = REPOSITORY / "README.md"
SOURCE = REPOSITORY / "docs" / "source"
PAGES = sorted(
    page
    for folder in ("guides", "getting_started")
    for page in (SOURCE / folder).glob("*.rst")
    if page.name != "batch.rst" and ".. code-block:: python" in page.read_text(encoding="utf-8")
)


def blocks(page: Path) -> list[str]:
    """The Python blocks of a page, in order."""
    text = page.read_text(encoding="utf-8")
    if page.suffix == ".md":
        return re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    found = re.findall(r"\.\. code-block:: python\n\n((?:(?: {3}.*)?\n)+)", text)
    return [textwrap.dedent(block) for block in found]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The files that the pages speak of."""
    here = tmp_path_factory.mktemp("written")
    _, masks, signal = write_demo_input(here / "cytodisk_demo" / "input", seed=0)
    tifffile.imwrite(here / "mask.tif", tifffile.imread(masks)[0])
    tifffile.imwrite(here / "image.tif", tifffile.imread(signal)[0, 0])
    (here / "movie.tif").symlink_to(signal)
    cell = cd.simulate.cell_with_nucleus("off centre", seed=5, shape="spread")
    gfp = cd.simulate.profile_signal(cell.mask, cell.nucleus, lambda place: 40 + 160 * place**3)
    tifffile.imwrite(here / "cells.tif", cell.mask.astype("uint8"))
    tifffile.imwrite(here / "nuclei.tif", cell.nucleus.astype("uint8"))
    channels = np.stack([20.0 + 100.0 * cell.nucleus, gfp])
    tifffile.imwrite(here / "cells_image.tif", channels, metadata={"axes": "CYX"})
    (here / "groups.csv").write_text(f"file,condition,experiment\n{masks.name},control,day 1\n")
    for command in (
        f"movie {masks} --signal {signal} --groups groups.csv -o out --figures 0",
        "correlate out --signal edge --with velocity --surrogates 99 --figures 0",
        "predict out --source edge --target velocity --max-order 3 --surrogates 39 --no-geometry --figures 0",
        "waves out --surrogates 19 --no-geometry --figures 0",
        f"shapes {masks} -o shapes",
        "map cells.tif --nuclei nuclei.tif --signal cells_image.tif --channels DAPI,GFP -o nuclei_out "
        "--figures 0",
        "compare-windows mask.tif -o compared --methods newton,edge",
    ):
        with pytest.MonkeyPatch.context() as patch:
            patch.chdir(here)
            assert not app([*command.split(), "--quiet"], standalone_mode=False)
    return here


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("page", [README, *PAGES], ids=lambda page: page.stem)
def test_python_runs_as_it_is_written(page: Path, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)
    names: dict[str, object] = {}
    with mpl.rc_context({"backend": "agg"}):
        for block in blocks(page):
            exec(compile(block, str(page), "exec"), names)  # the names go on from block to block
    assert names


def test_readme_is_one_page() -> None:
    assert len(README.read_text(encoding="utf-8").split()) <= 600


def test_links_of_readme_lead_to_files() -> None:
    targets = re.findall(r"\]\(([^)#]+)\)", README.read_text(encoding="utf-8"))
    missing = [name for name in targets if "://" not in name and not (REPOSITORY / name).exists()]
    assert targets
    assert not missing


def test_the_stub_lists_what_the_package_has() -> None:
    sys.path.insert(0, str(REPOSITORY / "docs" / "extensions"))
    pytest.importorskip("sphinx")
    from public_names import groups

    for package in (cd, cd.plot, cd.pages):
        listed = groups(Path(package.__file__).with_name("__init__.pyi"))
        names = [name for group in listed.values() for name in group]
        assert set(names) == set(package.__all__) - {"errors", "pages", "plot", "simulate"}
