"""A list of layers follows the viewer."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

pytestmark = pytest.mark.slow


def test_choices_follow_the_viewer(make_viewer: Callable[..., Any]) -> None:
    from cytodisk.napari.given.layer_choice import LayerChoice
    from cytodisk.napari.given.layer_kinds import MASKS, SIGNALS

    viewer = make_viewer()
    masks, signals = LayerChoice(viewer, MASKS), LayerChoice(viewer, SIGNALS, several=True)
    heard: list[Any] = []
    masks.changed.connect(lambda: heard.append(masks.layer))
    assert (masks.layer, signals.layers) == (None, ())

    image = viewer.add_image(np.ones((8, 8)), name="Rac1")
    assert masks.layer is image
    labels = viewer.add_labels(np.ones((8, 8), int), name="cells")
    viewer.add_points(np.ones((2, 2)))
    viewer.add_labels(np.ones((8, 8), int), metadata={"cytodisk": {"study": "x"}})
    assert masks.fitting() == [labels, image]
    assert masks.layer is labels  # what looks like a signal gives way
    masks.choose(image)
    viewer.add_labels(np.ones((8, 8), int), metadata={"cytodisk": {"study": "y"}})
    assert masks.layer is image  # what was chosen stays

    masks.choose(labels)
    labels.name = "other"
    signals.choose(image)
    assert masks._list.currentText() == "other  (labels)"
    assert (masks.layer, signals.layers) == (labels, (image,))

    viewer.layers.remove(image)
    assert signals.layers == ()
    viewer.layers.remove(labels)
    assert masks.layer is None
    assert heard == [image, labels, image, labels, None]

    nuclei, late = viewer.add_labels(np.ones((8, 8), int), name="DAPI_nuclei"), LayerChoice(viewer, MASKS)
    assert late.layer is nuclei  # there is nothing else
    cells = viewer.add_labels(np.ones((8, 8), int), name="a")
    assert late.layer is cells
    late.close_down()
    viewer.layers.remove(cells)
    viewer.layers.remove(nuclei)
    masks.close_down()
    viewer.add_labels(np.ones((8, 8), int))
    assert masks.layer is None


def test_an_array_is_looked_at_once(make_viewer: Callable[..., Any]) -> None:
    import dask.array as da

    from cytodisk.napari.given.layer_choice import LayerChoice
    from cytodisk.napari.given.layer_kinds import MASKS

    reads: list[int] = []

    def plane(block_info: Any = None) -> Any:
        reads.append(1)
        return np.eye(8)

    viewer = make_viewer()
    viewer.add_image(da.map_blocks(plane, chunks=((8,), (8,)), dtype=float), contrast_limits=(0, 1))
    choice = LayerChoice(viewer, MASKS)
    looked = len(reads)
    for layer in (viewer.add_labels(np.ones((8, 8), int)), viewer.layers[0]):
        layer.name = "other"

    assert len(choice.fitting()) == 2
    assert looked - len(reads) == 0
