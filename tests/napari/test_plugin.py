"""That napari finds the plugin, and that a viewer opens."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

pytestmark = pytest.mark.slow


def test_napari_finds_the_plugin() -> None:
    npe2 = pytest.importorskip("npe2")

    manifest = npe2.PluginManifest.from_distribution("cytodisk")

    assert manifest.display_name == "cytodisk"


def test_a_viewer_opens(make_viewer: Callable[..., Any]) -> None:
    viewer = make_viewer(show=True)

    viewer.add_labels(np.arange(100).reshape(10, 10))

    assert viewer.screenshot(flash=False).shape[-1] == 4
