"""The widget "Open results": cells of several files, some without a map."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import tifffile

import cytodisk as cd
from cytodisk.store.study import Study

pytestmark = pytest.mark.slow
pytest.importorskip("napari.viewer")

from cytodisk.napari.study_layers import open_results  # noqa: E402


@pytest.fixture(scope="module")
def cells(tmp_path_factory: pytest.TempPathFactory) -> Study:
    """Two files: one cell in the first; in the second two, of which one is in two pieces."""
    folder = tmp_path_factory.mktemp("cells")
    one = np.zeros((40, 60), np.uint8)
    one[:25, :25] = cd.simulate.disk(12, margin=0)[:25, :25]
    two = 2 * one
    two[28:38, 5:15] = two[28:38, 30:40] = 1
    (folder / "masks").mkdir()
    for name, labels in (("a.tif", one), ("b.tif", two)):
        tifffile.imwrite(folder / "masks" / name, labels, metadata={"axes": "YX"})
    return cd.run_map(folder / "masks", folder / "out", layers=2, sectors=6, kind="labels")


def test_a_file_is_chosen_and_what_is_missing_is_told(
    cells: Study, make_viewer: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[str] = []
    monkeypatch.setattr(open_results, "show_error", told.append)
    viewer = make_viewer()
    widget = open_results.OpenResults(viewer)
    viewer.window.add_dock_widget(widget)

    widget.choose_folder(str(cells.path.parent))
    assert "no readable provenance.json" in told[0]

    widget.choose_folder(str(cells.path))
    widget.choose_source("b.tif")
    widget.show_results()

    shown = widget.shown
    assert shown is not None
    refused = cells.cells[(cells.cells["source"] == "b.tif") & (cells.cells["status"] != "ok")]
    assert len(refused) == 1
    assert refused["reason"].iloc[0] in widget.words
    assert "no signal" in widget.words
    assert set(shown.layers) == {"outlines", "points", "sector 0", "windows"}
    (cell,) = cells.cells.loc[(cells.cells["source"] == "b.tif") & (cells.cells["status"] == "ok"), "cell"]
    assert shown.cell_at(0, (12, 12)) == cell
    assert shown.layers["windows"].features["cell"].unique().tolist() == [cell]
