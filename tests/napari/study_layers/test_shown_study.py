"""Results of a study as layers: what they show is what its tables and maps hold."""

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import cytodisk as cd
from cytodisk.errors import ReadError
from cytodisk.store.study import Study

pytestmark = pytest.mark.slow
pytest.importorskip("napari.viewer")

from cytodisk.napari.study_layers import shown_study  # noqa: E402
from cytodisk.napari.study_layers.shown_study import show_study, shown_studies  # noqa: E402

FRAMES, LAYERS, SECTORS = 4, 3, 12


def test_windows_say_at_every_frame_what_the_tables_say(
    movie: Study, make_viewer: Callable[..., Any]
) -> None:
    viewer = make_viewer()
    shown = show_study(viewer, movie)
    layer = shown.layers["windows"]

    for frame in (1, 3, 2):
        viewer.dims.set_current_step(0, frame)
        assert shown.frame == frame
        rows = movie.windows[(movie.windows["frame"] == frame) & (movie.windows["channel"] == "RhoA")]
        features = layer.features
        assert len(features) == len(rows)
        assert features["sector"].tolist() == rows["sector"].tolist()
        assert features["cell"].tolist() == rows["cell"].tolist()
        np.testing.assert_allclose(features["mean RhoA (a.u.)"], rows["mean"], rtol=1e-4)
        np.testing.assert_allclose(features["depth (µm)"], rows["depth"], rtol=1e-4)


def test_the_status_bar_tells_the_window_under_the_cursor(
    movie: Study, make_viewer: Callable[..., Any]
) -> None:
    viewer = make_viewer()
    shown = show_study(viewer, movie)
    viewer.dims.set_current_step(0, 3)
    windows = shown.windows_at(1, 3)
    place = np.rint(windows.centroids_yx[1, 5])
    number = windows.labels[tuple(place.astype(int))]

    words = shown.layers["windows"].get_status((15.0, *(0.2 * place)), world=True)["coordinates"]

    assert shown.cell_at(3, place) == 1
    layer, sector = divmod(int(number), SECTORS)
    assert f"cell: 1, layer: {layer}, sector: {sector}" in words
    assert "depth (µm)" in words


def test_values_are_painted_into_the_windows(movie: Study, make_viewer: Callable[..., Any]) -> None:
    viewer = make_viewer()
    shown = show_study(viewer, movie)
    channels: list[str] = []
    shown.changed.connect(lambda: channels.append(shown.channel))
    layer = shown.layers["values"]

    first = layer.data[1]
    shown.channel = "RhoA"

    assert channels == ["RhoA"]
    windows = shown.windows_at(0, 1)
    inside = windows.labels >= 0
    values = shown.values(0, "RhoA", 1).ravel()[windows.labels[inside]]
    np.testing.assert_allclose(layer.data[1][inside], values, rtol=1e-6)
    assert not np.allclose(first[inside], values)
    assert np.isnan(layer.data[1][0, 0])


def test_what_is_shown_ends_with_its_layers(movie: Study, make_viewer: Callable[..., Any]) -> None:
    viewer = make_viewer()
    shown = show_study(viewer, movie)
    assert shown_studies(viewer) == [shown]
    assert not shown.layers["windows"].editable  # no brush that is meant for masks paints it

    viewer.layers.clear()

    assert shown_studies(viewer) == []
    viewer.add_image(np.zeros((5, 4, 4)))
    viewer.dims.set_current_step(0, 2)


def test_a_damaged_map_is_told_and_the_other_cells_are_shown(
    movie: Study, make_viewer: Callable[..., Any], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    damaged = tmp_path / "damaged"
    shutil.copytree(movie.path, damaged)
    (damaged / "maps" / "cell_00000_t00003.npz").write_bytes(b"no map")
    told: list[str] = []
    monkeypatch.setattr(shown_study, "show_error", told.append)
    viewer = make_viewer()
    study = cd.open_study(damaged)
    shown = shown_study.show_study(viewer, study)
    with pytest.raises(ReadError) as error:
        study.map(0, 3)

    viewer.dims.set_current_step(0, 3)
    viewer.dims.set_current_step(0, 1)
    viewer.dims.set_current_step(0, 3)

    assert told == [str(error.value)]
    assert shown.layers["windows"].features["cell"].unique().tolist() == [1]


def test_tables_of_features_are_told_when_the_slider_rests(
    movie: Study, make_viewer: Callable[..., Any], qtbot: Any
) -> None:
    viewer = make_viewer()
    layer = show_study(viewer, movie).layers["windows"]
    qtbot.wait(500)
    told: list[int] = []
    layer.events.features.connect(lambda event: told.append(len(layer.features)))

    for frame in (1, 2, 3):
        viewer.dims.set_current_step(0, frame)
    at_once = list(told)
    qtbot.waitUntil(lambda: bool(told), timeout=5_000)

    assert at_once == []
    assert told == [2 * LAYERS * SECTORS]


def test_a_movie_without_maps_shows_its_activity_beside_what_is_open(
    movie: Study, make_viewer: Callable[..., Any], qtbot: Any, tmp_path: Path
) -> None:
    from cytodisk.napari.commands.correlate import Correlate
    from cytodisk.napari.disk_view.disk_dock import NO_STUDY, DiskDock
    from cytodisk.napari.study_layers.open_results import OpenResults

    bare = shutil.copytree(movie.path, tmp_path / "bare")
    shutil.rmtree(bare / "maps")
    viewer = make_viewer()
    place = {"scale": (5.0, 0.2, 0.2), "units": ("second", "micrometer", "micrometer")}
    image = viewer.add_image(np.zeros((FRAMES, 60, 60)), **place)
    right = viewer.layers.extent.world[1][-1]

    shown = show_study(viewer, cd.open_study(bare))

    assert shown_studies(viewer) == [shown]
    assert set(shown.layers) == {"activity: velocity", "activity: Rac1", "activity: RhoA"}
    np.testing.assert_array_equal(
        shown.layers["activity: velocity"].data, movie.activity(0)["velocity"].transpose("sector", "time")
    )
    assert min(layer.extent.world[0][-1] for layer in shown.layers.values()) > right
    widgets = [widget(viewer) for widget in (Correlate, DiskDock, OpenResults)]
    for widget in widgets:
        qtbot.addWidget(widget)
    correlate, disk, results = widgets
    assert correlate.shown is shown
    assert disk.parts.picture.message == NO_STUDY
    assert "has no maps" in results.words
    for layer in list(shown.layers.values()):
        viewer.layers.remove(layer)
    assert shown.viewer is None
    assert list(viewer.layers) == [image]
