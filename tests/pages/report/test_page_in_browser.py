import shutil
from pathlib import Path

import numpy as np
import pytest
from page_driver import Page, errors, requests
from report_study import FRAMES, GAP, LAGS, LAYERS, NAMES, SECTORS, correlated
from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select

import cytodisk as cd
from cytodisk.pages.report.page import write_report
from cytodisk.runs.channel_names import shown_name
from cytodisk.runs.correlate.correlation_columns import CORRELATION_TABLES
from cytodisk.store.correlation_store import write_correlation
from cytodisk.store.study import Study

pytestmark = pytest.mark.slow

SHOWN = [shown_name(name, 24) for name in NAMES]  # cut in the middle, as lists have little room


@pytest.fixture
def page(browser: webdriver.Chrome, written: Path) -> Page:
    return Page(browser, written)


def number(text: str) -> float:
    return float(text.split()[0].replace("−", "-"))


def disk_point(layer: int, sector: int) -> tuple[float, float]:
    u, v = cd.polar_windows(LAYERS, SECTORS).centres_uv.reshape(LAYERS, SECTORS, 2)[layer, sector]
    return float(u), float(v)


def test_loads_alone_and_in_silence(page: Page, browser: webdriver.Chrome) -> None:
    assert requests(browser) == [browser.current_url]
    assert browser.current_url.startswith("file://")
    assert errors(browser) == []
    assert page.js("document.documentElement.scrollWidth <= innerWidth")
    assert not page.control("failed").is_displayed()
    figures = page.js("Object.keys(cytodisk.figures)")
    assert {"cell", "disk", "activity", "velocity", "peaks", "area", "curve"} <= set(figures)


def test_names_stay_names(page: Page, browser: webdriver.Chrome) -> None:
    assert browser.title == "study – cytodisk report"
    options = [option.get_property("textContent") for option in Select(page.control("channel")).options]
    assert options == [*SHOWN, "window area"]
    assert page.text("disk-title") == f"mean {SHOWN[1]}"  # the one that was correlated
    Select(page.control("channel")).select_by_index(0)
    page.settle()
    assert page.text("disk-title") == f"mean {SHOWN[0]}"
    assert errors(browser) == []


def test_slider_and_play(page: Page, browser: webdriver.Chrome) -> None:
    browser.execute_script(
        "const slider = document.getElementById('time'); slider.value = 3;"
        "slider.dispatchEvent(new Event('input'));"
    )
    page.settle()
    assert page.js("cytodisk.shown.index") == 3
    assert page.text("now") == "frame 3 · 15.0 s"
    chart = "cytodisk.figures.area.chart"
    line = page.js(f"Number({chart}.over.firstChild.getAttribute('d').split('V')[0].split(' ')[0].slice(1))")
    assert line == pytest.approx(page.js(f"{chart}.toX(15)"))
    page.control("play").click()
    page.wait("document.getElementById('play').getAttribute('aria-pressed') === 'true'")
    page.wait("cytodisk.shown.index > 4 || cytodisk.shown.index < 3")
    page.control("play").click()
    stopped = page.js("cytodisk.state.index")
    page.settle()
    assert page.js("cytodisk.state.index") == stopped
    assert page.control("play").text == "▶ Play"


def test_hover_on_the_disk_shows_in_every_view(page: Page, study: Study) -> None:
    page.hover("disk", *disk_point(1, 5))
    assert page.focus() == (1, 5, 0)
    window = study.activity(0).isel(time=0, channel=1, layer=1, sector=5)
    assert page.text("read-window") == "layer 1, sector 5"
    assert number(page.text("read-mean")) == pytest.approx(float(window["mean"]), rel=5e-3)
    assert number(page.text("read-area")) == pytest.approx(float(window["area"]), rel=5e-3)
    assert number(page.text("read-velocity")) == pytest.approx(1000 * float(window["velocity"]), rel=5e-3)
    assert page.text("read-area").endswith("µm²")
    depth = page.text("read-depth")
    assert depth.endswith(" µm deep")
    assert number(depth.removeprefix(", ")) == pytest.approx(float(window["depth"]), rel=5e-3)
    assert page.text("read-velocity").endswith("nm/s")
    assert page.text("read-correlation") == "0.05"
    assert page.text("read-lag") == "2 frames (10 s)"
    assert (page.text("read-p"), page.text("read-q")) == ("0.004", "0.5")
    assert page.js("cytodisk.shown.highlighted") == SECTORS + 5
    for name in ("activity", "velocity"):
        box = "document.querySelector('#figure-{0} svg > g:last-child rect')"
        size = page.js(f"['x', 'y', 'height'].map((name) => Number({box.format(name)}.getAttribute(name)))")
        chart = f"cytodisk.figures.{name}.chart"
        np.testing.assert_allclose(
            size, page.js(f"[{chart}.toX(-2.5), {chart}.toY(5.5), {chart}.toY(4.5) - {chart}.toY(5.5)]")
        )
    curve = page.js("cytodisk.figures.curve.data")
    assert curve["lag"] == [5.0 * lag for lag in LAGS]
    np.testing.assert_allclose(curve["window"], 0.1 * LAGS, atol=1e-6)
    np.testing.assert_allclose(curve["high"], 0.4, atol=1e-6)
    assert page.text("curve-layer") == "mean of layer 1: r 0.05 at −5 s, q 0.002"
    page.hover("disk", 1.1, 1.1)
    np.testing.assert_allclose(page.js("cytodisk.figures.curve.data.high"), 0.25, atol=1e-6)


def test_hover_on_the_cell_and_the_maps(page: Page, study: Study) -> None:
    frame = study.activity(0).isel(time=0)
    y, x = (float(frame[f"centroid_{axis}"].sel(layer=0, sector=7)) for axis in "yx")
    page.hover("cell", x, y)
    assert page.focus() == (0, 7, 0)
    page.hover("velocity", 20.0, 9.0)
    assert page.focus() == (0, 9, 4)
    assert page.js("document.querySelectorAll('#figure-area svg > g:last-child path').length") == 3
    assert page.text("read-frame") == "4 · 20.0 s"
    assert page.js("cytodisk.shown.index") == 0
    page.hover("peaks", *disk_point(2, 3))
    assert page.focus() == (2, 3, 0)
    page.hover("peaks", 1.05, 1.05)
    assert page.focus() is None


def test_click_pins_and_moves_time(page: Page) -> None:
    page.click("activity", 25.0, 4.0)
    assert page.js("cytodisk.state.frame") == 5
    assert page.control("read-pin").is_displayed()
    page.hover("disk", *disk_point(3, 9))
    assert page.focus() == (0, 4, 5)
    page.click("disk", *disk_point(3, 9))
    assert page.focus() == (3, 9, 5)
    assert Select(page.control("layer")).first_selected_option.text.startswith("3, ")
    page.press(Keys.ESCAPE)
    page.hover("area", 10.0, 0.0)
    assert page.focus() is None
    assert page.text("read-window") == "–"


def test_keyboard(page: Page, browser: webdriver.Chrome) -> None:
    for key, expected in (
        (Keys.ARROW_RIGHT, ("cytodisk.state.frame", 1)),
        (Keys.ARROW_LEFT, ("cytodisk.state.frame", 0)),
        (Keys.ARROW_LEFT, ("cytodisk.state.frame", 0)),
        (Keys.ARROW_DOWN, ("cytodisk.state.layer", 1)),
        ("]", ("cytodisk.state.pinned.sector", 0)),
        ("[", ("cytodisk.state.pinned.sector", SECTORS - 1)),
        (Keys.ARROW_UP, ("cytodisk.state.pinned.layer", 0)),
        (Keys.ARROW_UP, ("cytodisk.state.layer", 0)),
        (" ", ("cytodisk.state.playing", True)),
        (" ", ("cytodisk.state.playing", False)),
        (Keys.ESCAPE, ("cytodisk.state.pinned", None)),
    ):
        page.press(key)
        assert page.js(expected[0]) == expected[1], key
    assert page.text("spoken").startswith("frame ")


def test_chords_are_the_browsers_but_for_brackets(page: Page, browser: webdriver.Chrome) -> None:
    """Returns whether the page took the key."""

    def took(key: str, **modifiers: bool) -> bool:
        event = {"key": key, "bubbles": True, "cancelable": True, **modifiers}
        return bool(
            browser.execute_script(
                "return !document.body.dispatchEvent(new KeyboardEvent('keydown', arguments[0]))", event
            )
        )

    assert took("ArrowRight")
    for modifier in ("altKey", "ctrlKey", "metaKey"):
        assert not took("ArrowLeft", **{modifier: True})
    assert took("]", ctrlKey=True, altKey=True, modifierAltGraph=True)
    assert took("[", altKey=True)
    assert not took("[", ctrlKey=True)


def test_keys_come_back_after_the_pointer(page: Page, browser: webdriver.Chrome) -> None:
    def active() -> str:
        element = browser.switch_to.active_element
        return element.get_attribute("id") or element.tag_name

    page.control("channel").click()
    page.press(Keys.ARROW_DOWN)
    page.press(Keys.ENTER)
    page.wait("cytodisk.state.channel === 2")
    assert active() == "body"
    page.press(Keys.ARROW_RIGHT)
    assert page.js("[cytodisk.state.frame, cytodisk.state.channel]") == [1, 2]
    page.control("time").click()
    assert active() == "body"
    browser.find_element(By.CSS_SELECTOR, f"button[data-frame='{GAP}']").click()
    page.press(" ")
    assert page.js("cytodisk.state.playing") is True
    page.press(" ")
    page.press(Keys.TAB)
    browser.execute_script("document.getElementById('layer').focus()")
    page.press(Keys.ARROW_DOWN)
    assert page.js("cytodisk.state.layer") == 1
    assert active() == "layer"


def test_layer_of_a_resting_pointer_follows(page: Page) -> None:
    page.hover("activity", 10.0, 4.0)
    page.press(Keys.ARROW_DOWN)
    assert page.focus() == (1, 4, 2)
    assert page.text("read-window") == "layer 1, sector 4"
    assert "layer 1, sector 4" in page.text("spoken")
    Select(page.control("layer")).select_by_value("3")
    page.settle()
    assert page.focus()[0] == page.js("cytodisk.state.layer") == 3


def test_spoken_words_follow_the_slider(page: Page, browser: webdriver.Chrome) -> None:
    page.press(Keys.ARROW_RIGHT)
    assert page.text("spoken").startswith("frame 1,")
    browser.execute_script(
        "const slider = document.getElementById('time'); slider.value = 5;"
        "slider.dispatchEvent(new Event('input'));"
    )
    page.wait("document.getElementById('spoken').textContent.startsWith('frame 5,')")


def test_every_control_is_reached_and_seen(page: Page, browser: webdriver.Chrome) -> None:
    reached = {}
    for _ in range(40):
        browser.switch_to.active_element.send_keys(Keys.TAB)
        element = browser.switch_to.active_element
        if element.tag_name != "body":
            reached[element.get_attribute("id")] = element.value_of_css_property("outline-style")
    assert {"play", "time", "channel", "layer", "colours", "pair", "peak"} <= set(reached)
    assert set(reached.values()) == {"solid"}, reached
    page.control("time").send_keys(Keys.ARROW_RIGHT)  # a step, not two
    page.settle()
    assert page.js("cytodisk.state.index") == 1
    page.control("play").send_keys(" ")
    assert page.js("cytodisk.state.playing") is True


def test_a_flag_leads_to_its_frame(page: Page, browser: webdriver.Chrome, study: Study) -> None:
    browser.find_element(By.CSS_SELECTOR, f"button[data-frame='{GAP}']").click()
    page.settle()
    assert page.js("cytodisk.shown.index") == GAP
    reason = study.cells["reason"][GAP]
    assert page.text("cell-note") == f"no map: {study.cells['status'][GAP]}: {reason}"
    assert page.js("cytodisk.figures.area.data.missing") == [[27.5, 32.5]]
    page.hover("cell", *page.js("[2, 2]"))
    assert page.focus() is None


def test_flags_take_a_line_and_print_in_full(page: Page, browser: webdriver.Chrome) -> None:
    line = "document.querySelector('.flag').getBoundingClientRect().height"
    meaning = browser.find_element(By.CSS_SELECTOR, ".flag .meaning")
    assert page.js(line) < 32
    assert not meaning.is_displayed()
    browser.find_element(By.CSS_SELECTOR, ".flag .why").click()
    assert meaning.is_displayed()
    browser.find_element(By.CSS_SELECTOR, ".flag .why").click()
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    try:
        assert meaning.is_displayed()
        assert not page.control("play").is_displayed()
    finally:
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})


def test_a_flag_of_a_sector_pins_it(browser: webdriver.Chrome, study: Study, tmp_path: Path) -> None:
    """The edge leaps in one place."""
    edge = study.edge.copy()
    edge.loc[(edge["frame"] == 3) & (edge["sector"] == 7), "velocity"] = 50.0
    leaping = Study(study.path, study.cells, study.provenance)
    leaping.__dict__["edge"] = edge
    page = Page(browser, write_report(leaping, tmp_path / "report.html"))
    browser.find_element(By.CSS_SELECTOR, "button[data-frame='3'][data-sector='7']").click()
    page.settle()
    assert page.focus() == (0, 7, 3)


def test_correlation_of_some_sectors(browser: webdriver.Chrome, study: Study, tmp_path: Path) -> None:
    folder = tmp_path / "study"
    shutil.copytree(study.path, folder, ignore=shutil.ignore_patterns("correlation"))
    tables = correlated()
    units = tables["windows"].attrs
    for name in ("windows", "curves"):
        tables[name] = tables[name][tables[name]["sector"] < 4]
        tables[name].attrs = units
    settings = {"detrend": "linear", "skip_lags": [-1, 0], "sectors": [0, 3]}
    write_correlation(folder, NAMES[1], "velocity", tables, CORRELATION_TABLES, settings)
    page = Page(browser, write_report(cd.open_study(folder)))
    assert page.text("peaks-differs") == "linear detrending, without lags −1, 0, only sectors 0–3"
    assert page.text("curve-differs") == page.text("peaks-differs")
    assert page.text("peaks-key").endswith("grey: not correlated")
    page.hover("peaks", *disk_point(1, 9))
    assert page.text("read-correlation") == "–"
    assert page.text("curve-window") == "layer 1, sector 9: not correlated"
    page.hover("peaks", *disk_point(1, 2))
    assert page.text("read-correlation") == "0.02"
    assert page.text("curve-window") == "layer 1, sector 2, band: 95 % at each lag by itself"
    assert errors(browser) == []


def test_choices_change_what_is_drawn(page: Page) -> None:
    Select(page.control("layer")).select_by_value("2")
    page.settle()
    deep = page.js("cytodisk.data.layer_depths[2]")
    assert deep.endswith(" deep")
    assert page.text("activity-title") == f"mean {SHOWN[1]}, layer 2{deep}"
    shared = page.js("cytodisk.figures.activity.data.limits[0]")
    Select(page.control("colours")).select_by_value("layer")
    page.settle()
    assert page.js("cytodisk.figures.activity.data.limits[0]") != shared
    Select(page.control("peak")).select_by_value("lag")
    page.settle()
    assert page.js("cytodisk.figures.peaks.data.limits[1]") == pytest.approx(15.0)
    low, high = page.js("cytodisk.figures.velocity.data.limits")
    assert low == -high < 0


def test_windows_that_are_not_significant_are_hatched(page: Page) -> None:
    """Layers 1 to 3 have q of 0.5."""
    hatched = page.js("cytodisk.figures.peaks.data.pale")
    assert hatched == list(range(SECTORS, LAYERS * SECTORS))
    assert page.text("peaks-key") == "hatched: not significant (q ≥ 0.05)"


def test_disk_has_its_windows_where_the_grid_has(page: Page) -> None:
    """At the middle of each window the pointer is on that window, and the canvas has its colour."""
    grid = cd.polar_windows(LAYERS, SECTORS)
    for number, (u, v) in enumerate(grid.centres_uv):
        place = page.js(f"cytodisk.figures.disk.toPage({u}, {v})")
        event = f"{{ clientX: {place[0]}, clientY: {place[1]} }}"
        found = page.js(f"cytodisk.figures.disk.under({event})")
        assert (found["layer"], found["sector"]) == divmod(number, SECTORS)


def test_without_signal_correlation_or_scale(
    browser: webdriver.Chrome, bare_study: Study, tmp_path: Path
) -> None:
    page = Page(browser, write_report(bare_study, tmp_path / "bare.html"))
    assert not page.control("channel").is_displayed()
    assert (
        browser.find_elements(By.CSS_SELECTOR, "#figure-activity, #figure-intensity, #peaks-picture, #auto")
        == []
    )
    page.hover("disk", *disk_point(2, 3))
    window = bare_study.activity(0).isel(time=0, layer=2, sector=3)
    assert page.text("read-area").endswith(" px²")
    assert number(page.text("read-area")) == pytest.approx(float(window["area"]), rel=5e-3)
    assert page.text("now") == "frame 0"
    assert "No signal:" in browser.find_element(By.CLASS_NAME, "absent").text
    assert page.js(f"cytodisk.data.frames.length === {FRAMES}")
    assert errors(browser) == []
