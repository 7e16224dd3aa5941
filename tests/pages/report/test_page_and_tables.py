"""What the page of a movie says is what the tables of its study hold, and each control does what it says."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import tifffile
from page_checks import LAPTOP, WIDE, accessibility_faults, cut_off, window_of
from page_driver import Page, errors
from report_study import FRAMES, GAP, LAYERS, NAMES, SECTORS, correlated
from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import Select

import cytodisk as cd
from cytodisk.pages.report.page import write_report
from cytodisk.runs.findings.movie_finding import movie_finding
from cytodisk.store.study import Study

pytestmark = pytest.mark.slow

_PIXELS = """
const canvas = document.getElementById(arguments[0]);
const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
return data.reduce((sum, value, place) => (sum * 31 + value * (1 + (place % 7))) % 1000003, 7);
"""
_SLIDE = """
const slider = document.getElementById(arguments[0]);
slider.value = arguments[1];
slider.dispatchEvent(new Event("input", { bubbles: true }));
"""


@pytest.fixture
def page(browser: webdriver.Chrome, written: Path) -> Page:
    return Page(browser, written)


@pytest.fixture(scope="module")
def several(masks: Path, signal: Path, tmp_path_factory: pytest.TempPathFactory) -> Study:
    """Two cells in one movie."""
    one = tifffile.imread(masks)
    labels = np.concatenate([one, 2 * one[::-1]], axis=2)
    folder = tmp_path_factory.mktemp("several")
    tifffile.imwrite(folder / "labels.tif", labels, metadata={"axes": "TYX"}, photometric="minisblack")
    return cd.run_movie(folder / "labels.tif", folder / "study", layers=2, sectors=6, kind="labels")


def number(text: str) -> float:
    return float(text.split()[0].replace("−", "-"))


def slide(page: Page, name: str, value: float) -> None:
    page.browser.execute_script(_SLIDE, name, value)
    page.settle()


def point(layer: int, sector: int) -> tuple[float, float]:
    u, v = cd.polar_windows(LAYERS, SECTORS).centres_uv.reshape(LAYERS, SECTORS, 2)[layer, sector]
    return float(u), float(v)


def row_of(table: pd.DataFrame, **at: Any) -> pd.Series:
    chosen = table[np.logical_and.reduce([table[name] == value for name, value in at.items()])]
    assert len(chosen) == 1
    return chosen.iloc[0]


def test_twenty_windows_are_those_of_the_tables(page: Page, study: Study) -> None:
    """Each number under the pointer, in the unit that stands beside it."""
    rng = np.random.default_rng(3)
    frames = [frame for frame in range(FRAMES) if frame != GAP]
    tables, factor = correlated(), {"µm/s": 1.0, "nm/s": 1e-3}
    for _ in range(20):
        frame, layer, sector = int(rng.choice(frames)), int(rng.integers(LAYERS)), int(rng.integers(SECTORS))
        channel = int(rng.integers(len(NAMES)))
        Select(page.control("channel")).select_by_index(channel)
        slide(page, "time", frame)
        page.hover("disk", *point(layer, sector))
        at = {"cell": 0, "frame": frame, "layer": layer, "sector": sector, "channel": NAMES[channel]}
        window, where = row_of(study.windows, **at), f"frame {frame}, layer {layer}, sector {sector}"
        assert page.text("read-window") == f"layer {layer}, sector {sector}", where
        assert number(page.text("read-frame")) == frame, where
        assert number(page.text("read-mean")) == pytest.approx(window["mean"], rel=5e-3), where
        spread = page.text("read-mean").split("±")[1]
        assert number(spread) == pytest.approx(window["sd"], rel=5e-3), where
        assert number(page.text("read-area")) == pytest.approx(window["area"], rel=5e-3), where
        depth = page.text("read-depth").removeprefix(", ")
        assert number(depth) == pytest.approx(window["depth"], rel=5e-3), where
        edge, said = row_of(study.edge, cell=0, frame=frame, sector=sector), page.text("read-velocity")
        if np.isfinite(edge["velocity"]):
            of = factor[said.split()[-1]]
            assert of * number(said) == pytest.approx(edge["velocity"], rel=5e-3, abs=1e-9), where
            error = number(said.split("±")[1])
            assert of * error == pytest.approx(edge["velocity_error"], rel=5e-3), where
        else:
            assert said == "–", where
        peak = row_of(tables["windows"], layer=layer, sector=sector)
        assert number(page.text("read-correlation")) == pytest.approx(peak["correlation"], abs=5e-3), where
        assert page.text("read-lag") == "2 frames (10 s)", where
        assert number(page.text("read-q")) == pytest.approx(peak["q"]), where
        assert number(page.text("read-p")) == pytest.approx(peak["p"]), where


def tried_controls(page: Page) -> dict[str, tuple[Callable[[], Any], Callable[[], Any]]]:
    """By the name of a control: how it is used, and what must then be another."""

    def choose(name: str, place: int) -> Callable[[], Any]:
        return lambda: Select(page.control(name)).select_by_index(place)

    def press(name: str) -> Callable[[], Any]:
        return lambda: page.control(name).click()

    def moved(name: str, value: int) -> Callable[[], Any]:
        return lambda: slide(page, name, value)

    def seen(*names: str) -> Callable[[], Any]:
        return lambda: [
            page.browser.execute_script(_PIXELS, name) if name.endswith("picture") else page.text(name)
            for name in names
        ]

    return {
        "time": (moved("time", 3), seen("now", "cell-picture", "disk-picture")),
        "channel": (choose("channel", 0), seen("disk-title", "disk-picture")),
        "layer": (choose("layer", 2), seen("activity-title")),
        "colours": (choose("colours", 1), seen("bar-activity")),
        "peak": (choose("peak", 1), seen("peaks-name", "peaks-picture")),
        "shows": (choose("shows", 1), seen("cell-picture")),
        "black": (moved("black", 60), seen("cell-picture")),
        "white": (moved("white", 70), seen("cell-picture")),
        "reset": (press("reset"), seen("cell-picture")),
        "auto": (press("auto"), seen("cell-picture")),
        "grid": (press("grid"), seen("cell-picture")),
        "rim": (press("rim"), seen("cell-picture")),
        "play": (press("play"), lambda: page.js("cytodisk.state.playing")),
    }


def test_every_control_does_what_it_says(page: Page, browser: webdriver.Chrome) -> None:
    """A control that is new needs a line in `tried_controls`."""
    tried = tried_controls(page)
    controls = "#explorer .controls :is(button, select, input)"
    there = {one.get_attribute("id") for one in browser.find_elements(By.CSS_SELECTOR, controls)}
    assert there - {"pair"} == set(tried)
    assert len(Select(page.control("pair")).options) == 1  # one correlation: nothing to choose
    for name, (act, seen) in tried.items():
        before = seen()
        act()
        page.settle()
        if name == "shows":
            assert seen() != before
            Select(page.control("shows")).select_by_index(0)
            page.settle()
            continue
        assert seen() != before, f"{name} changes nothing"
    assert errors(browser) == []


def test_the_finding_comes_first(page: Page, browser: webdriver.Chrome, study: Study) -> None:
    """Under the title, in the words of the library, and seen without scrolling."""
    said = browser.find_element(By.ID, "finding")
    for words in movie_finding(study, 0).sentences:
        assert words in said.text
    assert said.rect["y"] + said.rect["height"] < 300
    first = page.js("document.querySelector('main').firstElementChild.id")
    assert first == "finding"


def test_nothing_is_cut_off_and_wide_screens_are_used(page: Page, browser: webdriver.Chrome) -> None:
    for size in (LAPTOP, WIDE):
        with window_of(browser, size):
            assert cut_off(browser) == []
            right = "(one) => one.getBoundingClientRect().right"
            ends = page.js(f"[...document.querySelectorAll('figure.view')].map({right})")
            assert max(ends) > 0.95 * size[0]
    with window_of(browser, LAPTOP):
        for name in ("play", "time", "channel", "layer"):
            assert page.control(name).rect["y"] + page.control(name).rect["height"] < LAPTOP[1]


def test_no_accessibility_fault(
    browser: webdriver.Chrome, written: Path, bare_study: Study, several: Study, tmp_path: Path
) -> None:
    """Of the page with a correlation, without a signal, and of several cells."""
    bare, two = (tmp_path / f"{name}.html" for name in ("bare", "two"))
    for path in (written, write_report(bare_study, bare), write_report(several, two)):
        Page(browser, path)
        assert accessibility_faults(browser) == []
        with window_of(browser, LAPTOP):
            assert cut_off(browser) == []


def test_a_page_without_a_signal_has_no_empty_plots(
    browser: webdriver.Chrome, bare_study: Study, tmp_path: Path
) -> None:
    Page(browser, write_report(bare_study, tmp_path / "bare.html"))
    said = browser.find_element(By.ID, "finding").text
    assert "the edge moves at" in said
    assert "No signal was given" in said
    plots = browser.find_elements(By.CSS_SELECTOR, ".plot")
    shown = [one.get_attribute("id") for one in plots if one.is_displayed()]
    assert {"figure-velocity", "disk-picture"} <= set(shown)
    assert not {"figure-activity", "peaks-picture", "figure-curve", "figure-intensity"} & set(shown)


def test_cells_are_clicked_through(browser: webdriver.Chrome, several: Study, tmp_path: Path) -> None:
    """Each with its own finding."""
    page = Page(browser, write_report(several, tmp_path / "two.html"))
    for cell in (1, 0):
        browser.find_element(By.CSS_SELECTOR, f"button.opens[data-cell='{cell}']").click()
        page.wait(f"cytodisk.state.cell === {cell}")
        page.settle()
        said = browser.find_element(By.ID, "finding").text
        assert movie_finding(several, cell).sentences[0] in said
    browser.find_element(By.ID, "next-cell").click()
    page.wait("cytodisk.state.cell === 1")
    browser.find_element(By.ID, "previous-cell").click()
    page.wait("cytodisk.state.cell === 0")
