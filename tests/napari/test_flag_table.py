"""A click on a flag leads to its frame."""

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from cytodisk.napari.camera import camera_of
from cytodisk.napari.check.flag_points import FlagGround
from cytodisk.napari.check.found_flags import FlagPlace, FoundFlag

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
