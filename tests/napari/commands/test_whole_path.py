"""The widgets on layers that are open, from the click to the saved study: the same as the commands."""

import shlex
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import cytodisk as cd
from cytodisk.cli import main

pytestmark = pytest.mark.slow
pytest.importorskip("napari.viewer")

from cytodisk.napari.commands.correlate import Correlate  # noqa: E402
from cytodisk.napari.commands.follow_cells import FollowCells  # noqa: E402
from cytodisk.napari.commands.map_cells import MapCells  # noqa: E402
from cytodisk.napari.commands.open_widgets import layers_of  # noqa: E402
from cytodisk.runs.demo_input import write_demo_input  # noqa: E402
from cytodisk.runs.qc_flags.remedy import run_again, shown_path  # noqa: E402

FRAMES, LAYERS, SECTORS = 16, 3, 12
UNITS = ("second", "micrometer", "micrometer")
Open = Callable[..., Any]


@pytest.fixture(autouse=True)
def own_place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Work folders are made here, and commands run here."""
    place = tmp_path / "work"
    place.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(place))
    monkeypatch.chdir(tmp_path)
    return place


@pytest.fixture(scope="module")
def truth() -> Any:
    return cd.simulate.movie("fluctuating", frames=FRAMES, radius_px=14.0, coupled=0.5)


@pytest.fixture
def viewer(make_viewer: Open, truth: Any) -> Iterator[Any]:
    """A movie of two cells as labels, with a layer for each channel; their scale is known."""
    viewer = make_viewer()
    settings = {"scale": (5.0, 0.2, 0.2), "units": UNITS, "axis_labels": ("t", "y", "x")}
    one = truth.masks.astype(np.uint8)
    signal = np.concatenate([truth.signal.to_numpy()] * 2, axis=3)
    viewer.add_image(signal[:, 0], name="Rac1", **settings)
    viewer.add_image(signal[:, 1], name="RhoA", **settings)
    viewer.add_labels(np.concatenate([one, 2 * one], axis=2), name="cells", **settings)
    return viewer


def of_user(viewer: Any) -> dict[str, Any]:
    """What a user sees of his layers, and what they hold."""
    layers = [layer for layer in viewer.layers if "cytodisk" not in layer.metadata]
    return {
        layer.name: (
            np.asarray(layer.data).tobytes(),
            layer.visible,
            layer.opacity,
            tuple(layer.scale),
            tuple(layer.translate),
            dict(layer.metadata),
        )
        for layer in layers
    }


def opened(viewer: Any, kind: Any, **values: Any) -> Any:
    widget = kind(viewer)
    viewer.window.add_dock_widget(widget)
    widget.form.set_values({"layers": LAYERS, "sectors": SECTORS} | values)
    return widget


def clicked(qtbot: Any, widget: Any, button: Any) -> None:
    """Click, and wait until the work that this starts has ended."""
    button.click()
    qtbot.waitUntil(lambda: widget.work is not None and widget.work.done, timeout=100_000)


def run_command(monkeypatch: pytest.MonkeyPatch, line: str, code: int = 0) -> None:
    monkeypatch.setattr(sys, "argv", [*shlex.split(line), "--quiet"])
    with pytest.raises(SystemExit) as ended:
        main()
    assert (ended.value.code or 0) == code


def assert_equal_tables(one: Path, other: Path) -> None:
    tables = sorted(path.name for path in one.glob("*.parquet"))
    assert tables
    assert tables == sorted(path.name for path in other.glob("*.parquet"))
    for name in tables:
        here, there = (pd.read_parquet(folder / name) for folder in (one, other))
        changing = [column for column in here if column in ("seconds", "source")]
        pd.testing.assert_frame_equal(here.drop(columns=changing), there.drop(columns=changing))


def test_a_movie_is_followed_saved_correlated_and_reported(
    viewer: Any, qtbot: Any, tmp_path: Path, own_place: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = of_user(viewer)
    follow = opened(viewer, FollowCells)
    assert [layer.name for layer in follow.signal.layers] == ["RhoA", "Rac1"]

    clicked(qtbot, follow, follow.run_button)

    assert follow.shown.channels == ("RhoA", "Rac1")
    assert f"{2 * FRAMES} of {2 * FRAMES} frames of 2 cells mapped" in follow.results.words.text()
    assert "Not saved yet" in follow.results.words.text()
    assert follow.made.study.scale.pixel_size_um == pytest.approx(0.2)
    assert follow.made.study.scale.frame_interval_s == pytest.approx(5.0)

    follow.save(tmp_path / "saved")
    qtbot.waitUntil(lambda: follow.work.done, timeout=20_000)

    saved = cd.open_study(tmp_path / "saved")
    assert list(own_place.iterdir()) == []
    assert follow.shown.study.path == saved.path
    assert str(own_place) not in (saved.path / "provenance.json").read_text()
    assert "saved" in follow.results.words.text()
    assert run_again(saved, "9", sectors=9).split()[2] == shown_path(f"{saved.path}/inputs/cells.ome.tif")
    run_command(monkeypatch, follow.results.line.toPlainText())
    assert_equal_tables(saved.path, tmp_path / "saved_again")

    follow.results.next_button.click()
    correlate = next(one for one in viewer.window.dock_widgets.values() if isinstance(one, Correlate))
    correlate.form.set_values({"surrogates": 39, "max_lag": 3, "min_pairs": 5})
    correlate.signal.setCurrentText("Rac1")
    clicked(qtbot, correlate, correlate.run_button)

    found = cd.open_study(saved.path).correlation("Rac1", "velocity")
    peaks = correlate.layers[0]
    frame, cell = 7, 1
    windows = follow.shown.windows_at(cell, frame)
    rows = found.windows[found.windows["cell"] == cell]
    expected = rows.pivot(index="layer", columns="sector", values="correlation").to_numpy()
    inside = windows.labels >= 0
    np.testing.assert_allclose(
        np.asarray(peaks.data[frame])[inside], expected.ravel()[windows.labels[inside]], rtol=1e-6
    )
    assert "Finding, cell 0" in correlate.results.words.text()
    assert correlate.plot.cell.count() == 2
    assert len(correlate.plot.figure.axes[0].lines) >= LAYERS
    run_command(monkeypatch, correlate.results.line.toPlainText().replace(str(saved.path), "saved_again"))
    there = cd.open_study(tmp_path / "saved_again").correlation("Rac1", "velocity")
    pd.testing.assert_frame_equal(found.windows, there.windows)

    assert not correlate.results.save_button.isEnabled()
    pages: list[str] = []
    monkeypatch.setattr("webbrowser.open", pages.append)
    clicked(qtbot, correlate, correlate.results.report_button)
    assert pages == [(saved.path / "report.html").as_uri()]
    assert (saved.path / "report.html").exists()
    assert of_user(viewer) == before


def test_cells_of_a_label_movie_are_mapped_one_by_one(
    viewer: Any, qtbot: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    viewer.layers["cells"].data = viewer.layers["cells"].data[:2]
    for name in ("Rac1", "RhoA"):
        viewer.layers[name].data = viewer.layers[name].data[:2]
    before = of_user(viewer)
    widget = opened(viewer, MapCells, nan="omit")

    clicked(qtbot, widget, widget.run_button)

    assert "4 of 4 cells mapped, one to one" in widget.results.words.text()
    first = layers_of(viewer, widget.made.study.path)
    assert {"windows", "values"} <= {layer.metadata["cytodisk"]["role"] for layer in first}
    clicked(qtbot, widget, widget.run_button)
    second = layers_of(viewer, widget.made.study.path)
    assert len(viewer.layers) == 3 + len(second)  # the first set is replaced
    widget.replace_box.setChecked(False)
    clicked(qtbot, widget, widget.run_button)
    assert len(viewer.layers) == 3 + 2 * len(second)
    widget.save(tmp_path / "saved")
    qtbot.waitUntil(lambda: widget.work.done, timeout=20_000)
    run_command(monkeypatch, widget.results.line.toPlainText())
    assert_equal_tables(tmp_path / "saved", tmp_path / "saved_again")
    assert of_user(viewer) == before


def test_the_demo_is_followed_from_its_own_files(
    make_viewer: Open, qtbot: Any, tmp_path: Path, own_place: Path
) -> None:
    _, masks, signal = write_demo_input(tmp_path / "input", 0)
    viewer = make_viewer()
    viewer.open(masks, plugin="napari", layer_type="labels")
    viewer.open(signal, plugin="napari", layer_type="image")
    widget = opened(viewer, FollowCells, layers=8)

    widget.run_button.click()
    qtbot.waitUntil(lambda: "of 40 frames" in widget.bar.label.text(), timeout=100_000)
    assert not widget.run_button.isEnabled()
    widget.bar.cancel_button.click()
    qtbot.waitUntil(lambda: widget.work.done, timeout=100_000)

    assert widget.bar.label.text() == "Cancelled: nothing was kept."
    assert widget.run_button.isEnabled()
    assert (widget.made, len(viewer.layers), list(own_place.iterdir())) == (None, 2, [])

    clicked(qtbot, widget, widget.run_button)

    assert "40 of 40 frames of 1 cell mapped" in widget.results.words.text()
    assert widget.made.files.written == ()
    assert widget.made.command_line == (
        f"cytodisk movie {masks} --signal {signal} --out cytodisk_study --layers 8 --sectors {SECTORS}"
    )


def test_wrong_masks_are_told_in_the_words_of_the_library(
    viewer: Any, qtbot: Any, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from napari.utils.notifications import notification_manager

    viewer.layers["cells"].data = np.zeros_like(viewer.layers["cells"].data)
    before = of_user(viewer)
    widget = opened(viewer, FollowCells)

    clicked(qtbot, widget, widget.run_button)

    told = notification_manager.records[-1]
    assert str(told.severity) == "error"
    assert told.message.startswith("no frame could be mapped: mask of shape (64, 106) is empty")
    run_command(monkeypatch, widget.results.line.toPlainText(), code=2)
    assert f"Error: {told.message}" in capsys.readouterr().err
    assert widget.run_button.isEnabled()
    assert of_user(viewer) == before
    assert len(viewer.layers) == 3
    viewer.layers["cells"].data = np.full((3, 9, 9), 2, dtype=np.uint8)
    clicked(qtbot, widget, widget.run_button)
    assert str(notification_manager.records[-1].severity) == "error"
    assert notification_manager.records[-1].message == (
        "signal RhoA.ome.tif was understood as 16 frames of 2 channels (TCYX (16, 2, 64, 106)), the masks "
        "have 3 frames: pass as many"
    )


def test_what_is_missing_or_wrong_is_told_before_a_run(make_viewer: Open) -> None:
    from napari.utils.notifications import notification_manager

    viewer = make_viewer()
    follow, correlate = opened(viewer, FollowCells), Correlate(viewer)
    viewer.window.add_dock_widget(correlate)

    follow.run_button.click()
    assert notification_manager.records[-1].message.startswith("masks: no layer is chosen")
    correlate.run_button.click()
    assert "follow cells first" in notification_manager.records[-1].message
    viewer.add_labels(np.ones((4, 20, 20), dtype=np.uint8))
    follow.form.set_values({"sectors": 0})
    follow.run_button.click()
    assert notification_manager.records[-1].message.startswith("--sectors must be a whole number from 1")
    assert follow.work is None


def test_a_study_is_saved_into_a_new_folder_only(
    make_viewer: Open, truth: Any, qtbot: Any, tmp_path: Path
) -> None:
    from napari.utils.notifications import notification_manager

    viewer = make_viewer()
    viewer.add_labels(truth.masks[0].astype(np.uint8), name="cell")
    widget = opened(viewer, MapCells)
    clicked(qtbot, widget, widget.run_button)
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.txt").write_text("all of it")

    assert widget.made.usual_target == tmp_path / "cell_study"
    widget.save(tmp_path / "mine")
    qtbot.waitUntil(lambda: widget.work.done, timeout=20_000)

    assert "is not empty: choose a new folder" in notification_manager.records[-1].message
    for inside in (widget.made.study.path / "maps" / "kept", widget.made.work.path / "kept"):
        widget.save(inside)
        qtbot.waitUntil(lambda: widget.work.done, timeout=20_000)
        assert "which goes when you close the viewer" in notification_manager.records[-1].message
    other = opened(viewer, MapCells)  # goes on with the same study
    widget.open_report()
    other.save(tmp_path / "elsewhere")
    assert "another widget works with this study" in notification_manager.records[-1].message
    assert (other.work, other.made.is_in_use) == (None, True)
    widget.bar.cancel_button.click()
    qtbot.waitUntil(lambda: widget.work.done, timeout=20_000)
    assert not other.made.is_in_use
    assert not widget.made.is_saved
    assert widget.results.save_button.isEnabled()
    assert (tmp_path / "mine" / "thesis.txt").read_text() == "all of it"


def test_layers_are_chosen_by_what_they_hold(make_viewer: Open, truth: Any) -> None:
    viewer = make_viewer()
    widget = opened(viewer, FollowCells)
    viewer.add_image(truth.masks.astype(np.uint8) * 255, name="from Fiji")
    viewer.add_image(truth.signal.to_numpy()[:, 0], name="Rac1")

    assert widget.masks.layer.name == "from Fiji"
    assert [layer.name for layer in widget.signal.layers] == ["Rac1"]
    viewer.layers.remove("from Fiji")
    viewer.add_labels(truth.masks.astype(np.uint8), name="cell")
    assert widget.masks.layer.name == "cell"
    widget.signal.choose()
    viewer.add_image(truth.signal.to_numpy()[:, 1], name="RhoA")
    assert widget.signal.layers == ()  # as the user chose


def test_a_new_widget_goes_on_with_what_is_shown(
    make_viewer: Open, truth: Any, qtbot: Any, own_place: Path
) -> None:
    viewer = make_viewer()
    viewer.add_labels(truth.masks[0].astype(np.uint8), name="cell")
    widget = opened(viewer, MapCells)
    clicked(qtbot, widget, widget.run_button)
    study = widget.made.study
    viewer.window.remove_dock_widget(widget)
    widget.deleteLater()
    del widget

    again = opened(viewer, MapCells)

    assert again.made.study.path == study.path
    assert again.shown.map_at(0, 0).certificate.valid
    assert again.results.save_button.isEnabled()
