"""A click on a flag leads to its frame."""

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from cytodisk.napari.check.flag_points import FlagGround
from cytodisk.napari.check.found_flags import FlagPlace, FoundFlag
from cytodisk.napari.napari_versions import camera_of

pytestmark = pytest.mark.slow


def test_flags_jump_to_their_frame(make_viewer: Callable[..., Any], tmp_path: Path) -> None:
    from cytodisk.napari.check.study_flags import ShownFlags

    viewer = make_viewer(show=True)
    settings = {"scale": (5, 0.2, 0.2), "units": ("s", "um", "um")}
    labels = viewer.add_labels(np.ones((9, 40, 60), int), **settings)
    places = tuple(FlagPlace(k, "0", f"+{k}%", (10.0 + k, 20.0)) for k in (3, 7))
    flags = [
        FoundFlag("area jumps", "the area jumps", "Correct it.", "Wrong.", places),
        FoundFlag("warnings", "1 warning"),
    ]
    study: Any = SimpleNamespace(path=tmp_path / "out")

    shown = ShownFlags(viewer, flags, FlagGround.of(labels), study)
    assert shown.layer is not None
    assert viewer.layers.selection == {labels}
    top = shown.table.tree.topLevelItem(0)
    shown.table.tree.setCurrentItem(top.child(1))

    assert viewer.dims.current_step[0] == 7
    assert shown.layer.size.argmax() == 1
    assert camera_of(viewer).center[-2:] == pytest.approx((17 * 0.2, 20 * 0.2))
    assert "+7%. Area jumps: the area jumps. Wrong. What to do: Correct it." in shown.table.said.text()
    status = shown.layer.get_status((35.0, 3.4, 4.0), world=True)["coordinates"]
    assert all(words in status for words in ("flag: area jumps", "finding: +7%", "remedy: Correct it."))
    assert shown.layer.metadata["cytodisk"] == {"role": "flags", "study": str(study.path), "cell": None}

    shown.table.tree.setCurrentItem(shown.table.tree.topLevelItem(1))
    assert viewer.dims.current_step[0] == 7
    shown.remove()
    assert list(viewer.layers) == [labels]


def test_flags_of_a_study_come_in_the_place_of_the_last(
    make_viewer: Callable[..., Any], tmp_path: Path
) -> None:
    import tifffile

    import cytodisk as cd
    from cytodisk.napari.check.study_flags import show_flags
    from cytodisk.napari.study_layers.shown_study import show_study

    masks = cd.simulate.movie("growing", frames=5, radius_px=12.0).masks
    masks[3, :, : masks.shape[2] // 2] = False
    tifffile.imwrite(tmp_path / "masks.tif", masks.astype(np.uint8), metadata={"axes": "TYX"})
    study = cd.run_movie(tmp_path / "masks.tif", tmp_path / "out", layers=2, sectors=6)
    viewer = make_viewer(show=True)
    shown = show_study(viewer, study)

    first = show_flags(viewer, study, shown)
    second = show_flags(viewer, study, shown)

    assert [flag.name for flag in first.flags] == [flag.name for flag in cd.qc_flags(study)]
    assert first.layer not in viewer.layers
    assert second.layer in viewer.layers
    assert len([layer for layer in viewer.layers if layer.name.startswith("QC flags")]) == 1
    first.remove()  # again, as whoever made it may do
    assert 3 in second.layer.data[:, 0]
