"""Masks that are open are looked at before anything is mapped."""

import shlex
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile

import cytodisk as cd
from cytodisk.napari.napari_versions import camera_of

pytestmark = pytest.mark.slow


@pytest.fixture
def masks() -> np.ndarray:
    """A movie of one cell, of which frame 5 has half."""
    found = cd.simulate.movie("still", frames=9, radius_px=30.0).masks.astype(int)
    found[5, :, : found.shape[2] // 2] = 0
    found[7, 1:3, 1:3] = 1
    return found


def test_wrong_frames_are_listed_and_shown(
    make_viewer: Callable[..., Any],
    qtbot: Any,
    tmp_path: Path,
    masks: np.ndarray,
    capsys: Any,
    monkeypatch: Any,
) -> None:
    from cytodisk.cli import main
    from cytodisk.napari.check.check_masks import CheckMasks

    path = tmp_path / "masks.tif"
    tifffile.imwrite(path, masks.astype(np.uint8), metadata={"axes": "TYX"})
    viewer = make_viewer(show=True)
    (layer,) = viewer.open(path, layer_type="labels", plugin="napari")
    before = layer.data.copy()
    widget = CheckMasks(viewer)
    qtbot.addWidget(widget)

    widget.button.click()
    qtbot.waitUntil(lambda: widget.found is not None, timeout=60_000)

    names = [flag.name for flag in widget.found.flags]
    assert "area jumps" in names
    monkeypatch.setattr("sys.argv", shlex.split(widget.command.text()))
    with pytest.raises(SystemExit):
        main()
    said = capsys.readouterr().out
    assert '"Follow cells" finds them' in widget.found.lines[-1]
    for line in widget.found.lines:
        assert line.replace('the widget "Follow cells"', "cytodisk movie") in said
    assert widget.command.text() == f"cytodisk check {path}"
    jumps = widget.table.tree.topLevelItem(names.index("area jumps"))
    rows = [jumps.child(k) for k in range(jumps.childCount())]
    (half,) = [row for row in rows if row.text(2).startswith("frames 4 and 5")]
    widget.table.tree.setCurrentItem(half)
    assert viewer.dims.current_step[0] == 5
    widget.table.tree.setCurrentItem(widget.table.tree.topLevelItem(names.index("note")))
    assert viewer.dims.current_step[0] == 7
    assert camera_of(viewer).center[-2:] == pytest.approx((1.5, 1.5))
    assert set(widget.marks.layer.features["flag"]) == set(names)
    assert widget.marks.layer.name == "faults of masks"
    np.testing.assert_array_equal(layer.data, before)

    layer.data[5] = layer.data[4]
    first = widget.found
    widget.button.click()
    qtbot.waitUntil(lambda: widget.found is not first, timeout=60_000)
    assert 5 not in [place.frame for flag in widget.found.flags for place in flag.places]
    assert not widget.command.isVisible()
    assert len(viewer.layers) == 2
    written = widget.found.files.masks
    widget.button.click()
    qtbot.waitUntil(lambda: widget.found.files.masks != written, timeout=60_000)
    assert widget.found.files.masks.exists()
    assert not written.exists()  # a folder a run would fill the disk


def test_what_cannot_be_checked_is_said_in_the_librarys_words(
    make_viewer: Callable[..., Any], qtbot: Any, monkeypatch: pytest.MonkeyPatch, masks: np.ndarray
) -> None:
    from cytodisk.napari.check import check_masks
    from cytodisk.napari.work import background

    said: list[str] = []
    for module in (check_masks, background):
        monkeypatch.setattr(module, "show_error", said.append)
    viewer = make_viewer()
    widget = check_masks.CheckMasks(viewer)
    qtbot.addWidget(widget)
    widget.run()
    viewer.add_labels(masks, name="deep", axis_labels=("z", "y", "x"))
    widget.run()
    qtbot.waitUntil(lambda: len(said) == 2, timeout=60_000)

    assert said[0].startswith("masks: no layer is chosen")
    assert "is a z-stack" in said[1]
    assert "--z max" in said[1]
    assert widget.button.isEnabled()
