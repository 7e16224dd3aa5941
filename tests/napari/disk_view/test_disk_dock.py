"""The dock with the disk in a real viewer: linked with the cell both ways, and with the slider."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile
from numpy.testing import assert_allclose

import cytodisk as cd
from cytodisk.store.study import Study

pytestmark = pytest.mark.slow
pytest.importorskip("napari.viewer")

from cytodisk.napari.disk_view.disk_dock import NO_STUDY, DiskDock  # noqa: E402
from cytodisk.napari.napari_versions import camera_of  # noqa: E402
from cytodisk.napari.study_layers.shown_study import show_study  # noqa: E402

LAYERS, SECTORS, PIXEL, INTERVAL = 3, 12, 0.2, 5.0


@pytest.fixture
def open_dock(make_viewer: Callable[..., Any], qtbot: Any) -> Callable[..., tuple[Any, Any, DiskDock]]:
    """Opens a study and the dock in a viewer with an image of the user's."""

    def opened(study: Study) -> tuple[Any, Any, DiskDock]:
        viewer = make_viewer(show=True)
        shown = show_study(viewer, study)
        height, width = shown.cells.image_shape
        scale = (INTERVAL, PIXEL, PIXEL) if study.is_movie else (PIXEL, PIXEL)
        units = ("second",) * (len(scale) - 2) + ("micrometer", "micrometer")
        frames = (4,) if study.is_movie else ()
        pixels = np.random.default_rng(0).random((*frames, height, width))
        viewer.add_image(pixels, name="mine", scale=scale, units=units)
        _, dock = viewer.window.add_plugin_dock_widget("cytodisk", "Disk")
        viewer.mouse_over_canvas = True
        qtbot.wait(10)
        return viewer, shown, dock

    return opened


def point_at(viewer: Any, yx: Any) -> None:
    """Move the cursor to a place of the image, in pixels."""
    viewer.cursor.position = (*viewer.dims.point[:-2], PIXEL * yx[0], PIXEL * yx[1])


def cursor_in_disk(dock: DiskDock, u: float, v: float, kind: str = "MouseMove") -> None:
    """Move the cursor over the disk, or press it."""
    from qtpy.QtCore import QEvent, QPointF, Qt
    from qtpy.QtGui import QMouseEvent
    from qtpy.QtWidgets import QApplication

    dock.viewer.mouse_over_canvas = False
    at = QPointF(*dock.parts.picture.point_of(u, v))
    button = Qt.MouseButton.LeftButton if kind == "MouseButtonPress" else Qt.MouseButton.NoButton
    event = QMouseEvent(getattr(QEvent.Type, kind), at, at, button, button, Qt.KeyboardModifier.NoModifier)
    QApplication.sendEvent(dock.parts.picture, event)


def test_cell_and_disk_are_linked_both_ways(movie: Study, open_dock: Callable[..., Any]) -> None:
    viewer, shown, dock = open_dock(movie)
    random = np.random.default_rng(0)
    viewer.dims.set_current_step(0, 1)

    for cell in (0, 1):
        windows = movie_windows(shown, cell, 1)
        for yx in random.permutation(np.argwhere(windows.labels >= 0))[:10]:
            point_at(viewer, yx)
            assert dock.pointed is not None
            assert dock.state is not None
            number = int(windows.labels[tuple(yx)])
            assert (dock.pointed.cell, dock.state.cell) == (cell, cell)
            assert dock.pointed.window == divmod(number, SECTORS)
            assert dock.parts.picture.window == number
            assert_allclose(dock.pointed.uv, windows.disk.to_disk([yx], outside="nearest")[0])

    assert dock.link is not None
    disk = shown.map_at(1, 1)
    for angle, radius in zip(random.uniform(0, 7, 20), random.uniform(0, 0.97, 20), strict=True):
        u, v = radius * np.cos(angle), radius * np.sin(angle)
        cursor_in_disk(dock, u, v)
        assert dock.pointed is not None
        assert dock.pointed.by_disk
        assert_allclose(dock.pointed.uv, (u, v), atol=1e-6)
        ((y, x),) = disk.to_cell([dock.pointed.uv])
        cross = dock.link.marks._cross[0]._data["a_position"][0, :2]
        assert_allclose(cross, (PIXEL * x, PIXEL * y), atol=1e-4)
        line = dock.link.marks._lines["pointed"][0].pos
        assert_allclose(
            line[:-1, ::-1], PIXEL * shown.windows_at(1, 1).polygon(*dock.pointed.window), atol=1e-4
        )

    cursor_in_disk(dock, 0.5, 0.2, "MouseButtonPress")
    ((y, x),) = disk.to_cell([(0.5, 0.2)])
    assert_allclose(tuple(camera_of(viewer).center)[-2:], (PIXEL * y, PIXEL * x), atol=1e-3)
    assert dock.pinned is not None
    assert dock.pinned[0] == 1


def movie_windows(shown: Any, cell: int, frame: int) -> cd.CellWindows:
    """Windows made anew, beside what the viewer keeps."""
    study = shown.study
    return cd.polar_windows(LAYERS, SECTORS).on(study.map(cell, frame))


def test_the_slider_drives_the_disk_and_the_lines_through_time(
    movie: Study, open_dock: Callable[..., Any]
) -> None:
    viewer, shown, dock = open_dock(movie)
    parts = dock.parts
    parts.cells.setCurrentIndex(1)  # cell 0, always
    viewer.dims.set_current_step(0, 3)
    cursor_in_disk(dock, 0.9, 0.3)
    assert dock.pointed is not None
    layer, sector = dock.pointed.window

    activity = movie.activity(0)
    rac1 = activity["mean"].sel(channel="Rac1", layer=layer, sector=sector).to_numpy()
    assert_allclose(parts.trace.values, rac1)
    velocity = activity["velocity"].sel(sector=sector).to_numpy()  # in µm/s
    factor = {"nm/s": 1000.0, "µm/s": 1.0}[parts.velocity_trace.title.split("(")[1].split(")")[0]]
    assert_allclose(parts.velocity_trace.values, factor * velocity)
    assert parts.trace.now == 3
    assert "Rac1 (a.u.)" in parts.trace.title
    assert f"sector {sector}" in parts.words.text()
    assert "µm deep" in parts.words.text()
    assert f"{rac1[3]:.3g}" in parts.words.text()

    shown.channel = "RhoA"
    assert parts.choices.currentText() == "mean RhoA"
    rhoa = activity["mean"].sel(channel="RhoA", layer=layer, sector=sector).to_numpy()
    assert_allclose(parts.trace.values, rhoa)

    viewer.dims.set_current_step(0, 2)
    assert "refused" in parts.picture.message
    assert parts.picture.colours.windows is None
    parts.trace.chosen.emit(1)
    assert shown.frame == 1
    assert parts.picture.message == ""
    assert parts.trace.now == 1

    parts.choices.setCurrentIndex(parts.choices.findText("pixels of mine"))
    assert parts.picture.colours.image is not None
    assert dock.grab().toImage().width() > 200


def test_the_viewer_is_left_as_it_was(movie: Study, open_dock: Callable[..., Any], qtbot: Any) -> None:
    viewer, shown, dock = open_dock(movie)
    viewer.layers.selection.active = viewer.layers["mine"]
    names = [layer.name for layer in viewer.layers]
    point_at(viewer, np.argwhere(movie_windows(shown, 1, shown.frame).labels >= 0)[50])
    assert dock.pointed is not None
    assert dock.link is not None
    visuals, callbacks = dock.link.marks.visuals, list(viewer.mouse_drag_callbacks)
    assert [layer.name for layer in viewer.layers] == names
    assert viewer.layers.selection.active.name == "mine"

    viewer.window.remove_dock_widget(dock)
    qtbot.wait(10)

    assert dock.link is None
    assert all(visual.parent is None for visual in visuals)
    assert len(viewer.mouse_drag_callbacks) == len(callbacks) - 1
    viewer.dims.set_current_step(0, 1)
    assert [layer.name for layer in viewer.layers] == names


def test_cells_with_nuclei_and_no_signal(tmp_path: Path, open_dock: Callable[..., Any], qtbot: Any) -> None:
    cells = cd.simulate.label_image_with_nuclei(seed=1)
    tifffile.imwrite(tmp_path / "cells.tif", cells.cells)
    tifffile.imwrite(tmp_path / "nuclei.tif", cells.nuclei)
    study = cd.run_map(
        tmp_path / "cells.tif",
        tmp_path / "out",
        nuclei=tmp_path / "nuclei.tif",
        layers=2,
        nucleus_layers=1,
        sectors=6,
        missing="plain",
        pixel_size_um=PIXEL,
    )
    viewer, shown, dock = open_dock(study)
    frame = shown.frame
    seen = set()

    for cell in shown.cells.mapped[frame]:
        disk = shown.map_at(cell, frame)
        point_at(viewer, disk.to_cell([(0.2, 0.1)])[0])
        assert dock.state is not None
        assert dock.state.cell == cell
        assert dock.parts.picture.colours.nucleus_radius == disk.nucleus_radius
        assert "window area" in dock.parts.words.text()
        seen.add(disk.nucleus is None)
    assert seen == {True, False}

    viewer.layers.clear()
    qtbot.wait(20)
    assert dock.parts.picture.message == NO_STUDY
