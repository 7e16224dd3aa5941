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


@pytest.mark.parametrize("name", ["Check masks", "Map cells", "Follow cells", "Correlate", "Disk"])
def test_widgets_of_the_menu_have_the_viewer_itself(make_viewer: Callable[..., Any], name: str) -> None:
    viewer = make_viewer()

    _, widget = viewer.window.add_plugin_dock_widget("cytodisk", name)

    assert widget.viewer is viewer
