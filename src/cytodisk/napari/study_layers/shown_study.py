"""Show the results of a study in a viewer, and find what is shown."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from cytodisk.napari.given.layer_kinds import MARK
from cytodisk.napari.study_layers.activity_layers import activity_layers
from cytodisk.napari.study_layers.layers_of_study import LayerData, layer_data
from cytodisk.napari.study_layers.study_in_viewer import ShownStudy as ShownStudy
from cytodisk.napari.study_layers.study_place import place_of
from cytodisk.napari.viewer_parts import Layer, show_error, show_warning
from cytodisk.store.study import Study
from cytodisk.store.study_kind import ACTIVITY

_ASIDE = 1.05  # times as far right as what is open


def show_study(viewer: Any, study: Study, *, source: str | None = None) -> ShownStudy:
    """Add a study's results to a viewer; of a movie without maps its activity over time.

    Parameters
    ----------
    viewer : Viewer
    study : Study
    source : str, optional
        The file of masks whose cells are shown, of a study of many; by default the first.

    Returns
    -------
    ShownStudy

    Raises
    ------
    ParameterError
        The study has no such source.
    """
    shown = ShownStudy(study, source)
    shown.tell = show_error
    for data in layers_of(shown, viewer.layers):
        layer = Layer.create(*data)
        viewer.add_layer(layer)
        shown.bind(viewer, layer)
    say_missing(shown)
    return shown


def layers_of(shown: ShownStudy, beside: Iterable[Any] = ()) -> list[LayerData]:
    """Layers of a study: windows and values, or for a movie without maps its activity over time.

    Parameters
    ----------
    shown : ShownStudy
    beside : iterable of Layer
        That are open.

    Returns
    -------
    list of (data, settings, kind)
        Empty for single cells without maps.
    """
    layers = layer_data(shown, place_of(shown.cells, beside))
    if layers or not shown.study.is_movie:
        return layers
    return activity_layers(shown.study.path / ACTIVITY, shown=shown, left=right_of(beside))


def right_of(layers: Iterable[Any]) -> float:
    """Where there is room to the right of some layers, in the viewer.

    Parameters
    ----------
    layers : iterable of Layer
    """
    edges = [float(layer.extent.world[1][-1]) for layer in layers if layer.ndim > 1]
    return _ASIDE * max(edges, default=0.0)


def attach(viewer: Any, shown: ShownStudy, n_layers: int) -> None:
    """Let layers that a reader returns follow the slider, once they are in the viewer.

    Parameters
    ----------
    viewer : Viewer
    shown : ShownStudy
    n_layers : int
        How many there will be.
    """

    shown.tell = show_error

    def bind(event: Any) -> None:
        if event.value.metadata.get(MARK, {}).get("shown") is shown:
            shown.bind(viewer, event.value)
            if len(shown.layers) == n_layers:
                viewer.layers.events.inserted.disconnect(bind)

    viewer.layers.events.inserted.connect(bind)


def say_missing(shown: ShownStudy) -> None:
    """Say what of a study has no map."""
    if words := shown.cells.missing_words:
        show_warning(words)


def shown_studies(viewer: Any) -> list[ShownStudy]:
    """Studies whose layers are open in a viewer, in the order of the layers.

    Parameters
    ----------
    viewer : Viewer

    Returns
    -------
    list of ShownStudy
    """
    found: dict[int, ShownStudy] = {}
    for layer in viewer.layers:
        shown = layer.metadata.get(MARK, {}).get("shown")
        if shown is not None and shown.viewer is viewer:
            found[id(shown)] = shown
    return list(found.values())
