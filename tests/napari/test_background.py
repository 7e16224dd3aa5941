"""Work in a thread: what is counted is told, it can be cancelled, and faults become notifications."""

import threading
from collections.abc import Callable
from typing import Any

import pytest

from cytodisk.errors import MaskError

Make = Callable[..., Any]
pytestmark = pytest.mark.slow


def started(make_viewer: Make, function: Callable[[Any], Any], **settings: Any) -> tuple[Any, ...]:
    from cytodisk.napari.work.background import run_in_background
    from cytodisk.napari.work.work_bar import WorkBar

    viewer, bar, results = make_viewer(), WorkBar(), []
    viewer.window.add_dock_widget(bar)
    work = run_in_background(bar, function, done=results.append, **settings)
    return viewer, bar, work, results


def test_a_result_comes_back_into_the_thread_of_the_viewer(make_viewer: Make, qtbot: Any) -> None:
    def count(report: Any) -> int:
        for done in range(4):
            report(done, 3)
        return 7

    _, bar, work, results = started(make_viewer, count, words="First start")

    assert bar.label.text() == "First start"
    qtbot.waitUntil(lambda: work.done, timeout=5000)
    assert results == [7]
    assert bar.bar.isHidden()
    assert bar.label.isHidden()


def test_cancelled_work_ends_at_its_next_report(make_viewer: Make, qtbot: Any) -> None:
    go_on, ended = threading.Event(), []

    def wait(report: Any) -> int:
        report(1, 3)
        go_on.wait(5)
        try:
            report(2, 3)
        finally:
            ended.append("tidy")
        return 7

    left: list[str] = []
    _, bar, work, results = started(make_viewer, wait, unit="frames", failed=lambda: left.append("left"))
    qtbot.waitUntil(lambda: bar.label.text().startswith("1 of 3 frames"), timeout=5000)
    bar.cancel_button.click()
    assert not bar.cancel_button.isEnabled()
    go_on.set()
    qtbot.waitUntil(lambda: work.done, timeout=5000)

    assert (results, ended, left) == ([], ["tidy"], ["left"])
    assert bar.label.text() == "Cancelled: nothing was kept."


def test_an_error_of_the_library_is_shown_with_its_words(make_viewer: Make, qtbot: Any) -> None:
    from napari.utils.notifications import notification_manager

    def fail(report: Any) -> None:
        raise MaskError("mask is empty: draw one")

    viewer, _, work, results = started(make_viewer, fail)
    qtbot.waitUntil(lambda: work.done, timeout=5000)

    assert results == []
    assert notification_manager.records[-1].message == "mask is empty: draw one"
    assert str(notification_manager.records[-1].severity) == "error"
    viewer.close()


def test_other_errors_are_not_swallowed(make_viewer: Make, qtbot: Any) -> None:
    def fail(report: Any) -> None:
        raise KeyError("a bug")

    with qtbot.captureExceptions() as caught:
        _, _, work, _ = started(make_viewer, fail)
        qtbot.waitUntil(lambda: work.done, timeout=5000)

    assert [kind for kind, *_ in caught] == [KeyError]


def test_work_ends_with_its_viewer(make_viewer: Make, qtbot: Any) -> None:
    go_on, told = threading.Event(), []

    def wait(report: Any) -> None:
        go_on.wait(5)
        try:
            report(2, 3)
        except BaseException as end:
            told.append(type(end).__name__)
            raise

    viewer, _, work, results = started(make_viewer, wait)
    viewer.close()
    qtbot.wait(50)
    go_on.set()
    qtbot.waitUntil(lambda: work.done, timeout=5000)

    assert (results, told) == ([], ["_Cancelled"])
