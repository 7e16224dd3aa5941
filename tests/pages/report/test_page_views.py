"""A movie's cell on the page: painted as chosen, opened by an address, laid out on screens and on paper."""

from pathlib import Path
from typing import Any
from urllib.parse import quote

import numpy as np
import pytest
import tifffile
from page_checks import LAPTOP, WIDE, cut_off, window_of
from page_driver import Page, errors
from report_study import NAMES
from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select

import cytodisk as cd
from cytodisk.pages.report.page import write_report
from cytodisk.store.study import Study

pytestmark = pytest.mark.slow

_A4 = (718, 1040)  # CSS pixels between the margins
_CELL_PIXELS = """
const canvas = document.getElementById("cell-picture");
return [...canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data];
"""


@pytest.fixture
def page(browser: webdriver.Chrome, written: Path) -> Page:
    return Page(browser, written)


@pytest.fixture(scope="module")
def three(masks: Path, signal: Path, tmp_path_factory: pytest.TempPathFactory) -> Study:
    """Three cells in a movie with a signal."""
    cell, image = tifffile.imread(masks)[:4], tifffile.imread(signal)[:4]
    folder = tmp_path_factory.mktemp("three")
    labels, pixels = folder / "labels.tif", folder / "pixels.tif"
    of_all = np.concatenate([cell, 2 * cell[:, ::-1], 3 * cell[:, :, ::-1]], axis=2)
    tifffile.imwrite(labels, of_all, metadata={"axes": "TYX"}, photometric="minisblack")
    image = np.concatenate([image, image[:, :, ::-1], image[..., ::-1]], axis=3)
    tifffile.imwrite(pixels, image, metadata={"axes": "TCYX"}, photometric="minisblack")
    names = ("Rac1", "Ras & Rap")
    return cd.run_movie(
        labels, folder / "study", signal=pixels, channels=names, layers=2, sectors=6, kind="labels"
    )


def painted(page: Page) -> Any:
    """Colours of the cell's picture, shape (N, 4)."""
    return np.reshape(page.browser.execute_script(_CELL_PIXELS), (-1, 4))


def grey_share(colours: Any) -> float:
    return float((np.ptp(colours[:, :3], axis=1) == 0).mean())


def box(page: Page, name: str) -> dict[str, float]:
    return dict(page.js(f"document.getElementById('{name}').getBoundingClientRect().toJSON()"))


def test_the_cell_is_painted_as_chosen(page: Page) -> None:
    """Each choice says what it shows, and has its own colours and their ends."""
    seen = {}
    for name in ("pixels", "means", "velocity", "correlation", "lag"):
        Select(page.control("shows")).select_by_value(name)
        page.settle()
        seen[name] = (page.text("cell-shows"), page.text("bar-cell"), tuple(painted(page).ravel()))
    for place in range(3):
        assert len({look[place] for look in seen.values()}) >= 4
    assert "velocity" in seen["velocity"][0]
    assert seen["velocity"][1].endswith(page.js("cytodisk.data.units.velocity"))
    assert seen["correlation"][1].endswith(" r")
    assert "follows" in seen["lag"][0]
    assert page.control("auto").get_attribute("disabled")  # colours of a lag are not stretched


def test_lines_between_windows_go(page: Page) -> None:
    """Without them and the rim, the picture is that of the pixels but for the cell's edge."""
    page.control("rim").click()
    page.settle()
    with_lines = painted(page)
    page.control("grid").click()
    page.settle()
    changed = (painted(page) != with_lines).any(axis=1).mean()
    assert 0.005 < changed < 0.3
    assert page.js("[cytodisk.state.grid, cytodisk.state.rim]") == [False, False]


def test_auto_spreads_the_colours_over_this_frame(page: Page) -> None:
    """From a range that is far too wide, which reset brings back."""
    usual = page.js("cytodisk.shown.limits")
    slide = (
        "const one = document.getElementById('white'); one.value = 150; one.dispatchEvent(new Event('input'))"
    )
    page.browser.execute_script(slide)
    page.settle()
    wide = page.js("cytodisk.shown.limits")
    assert wide[1] - wide[0] == pytest.approx(1.5 * (usual[1] - usual[0]))
    page.control("auto").click()
    page.settle()
    low, high = page.js("cytodisk.shown.limits")
    assert high < wide[1]
    assert high > low
    page.control("reset").click()
    page.settle()
    assert page.js("cytodisk.shown.limits") == pytest.approx(usual)


@pytest.mark.parametrize("channel", [0, 1])
def test_an_address_opens_a_channel(browser: webdriver.Chrome, written: Path, channel: int) -> None:
    browser.get(f"{written.as_uri()}#cell-0&channel={quote(NAMES[channel])}")
    page = Page.__new__(Page)
    page.browser = browser
    page.wait("cytodisk.ready && cytodisk.shown !== null")
    page.settle()
    assert page.js("cytodisk.state.channel") == channel
    assert errors(browser) == []


def test_cells_are_stepped_through(browser: webdriver.Chrome, three: Study, tmp_path: Path) -> None:
    """By buttons and keys, around the end, also faster than they open; the address goes with them."""
    path = write_report(three, tmp_path / "three.html")
    page = Page(browser, path)
    assert page.text("cell-place") == "1 of 3"
    for act, cell in ((By.ID, 1), (Keys.PAGE_DOWN, 2), (Keys.PAGE_DOWN, 0), (Keys.PAGE_UP, 2)):
        if act == By.ID:
            page.control("next-cell").click()
        else:
            page.browser.find_element(By.TAG_NAME, "body").send_keys(act)
        page.wait(f"cytodisk.state.cell === {cell}")
        page.wait(f"location.hash === '#cell-{cell}'")
        page.settle()
        assert page.text("cell-title") == f"Cell {cell}"
        assert page.js("document.querySelectorAll('tr[aria-current=true]').length") == 1
    page.js("(cytodisk.stepCell(1), cytodisk.stepCell(1), null)")  # 2 → 0 → 1
    page.wait("cytodisk.state.cell === 1 && cytodisk.shown.cell === 1")
    browser.get("about:blank")
    browser.get(f"{path.as_uri()}#cell-2&channel={quote('Ras & Rap')}")
    page.wait("cytodisk.ready && cytodisk.state.cell === 2 && cytodisk.state.channel === 1")
    assert errors(browser) == []


def test_disk_and_peaks_come_before_quality(page: Page, browser: webdriver.Chrome) -> None:
    """On a laptop beside the cell; quality is last there. A wide screen has all three side by side."""
    with window_of(browser, LAPTOP):
        page.settle()
        velocity, quality = box(page, "figure-velocity"), box(page, "figure-area")
        end_of_cell = page.js("document.querySelector('.view.cell').getBoundingClientRect().bottom")
        for name in ("disk-picture", "peaks-picture"):
            assert velocity["bottom"] <= box(page, name)["top"]
            assert box(page, name)["top"] < end_of_cell - 150  # most of it lies beside the cell
            assert box(page, name)["bottom"] <= quality["top"]
    with window_of(browser, WIDE):
        page.settle()
        assert box(page, "disk-picture")["left"] > box(page, "figure-velocity")["right"]
        assert box(page, "figure-area")["left"] == box(page, "figure-velocity")["left"]


def test_paper_has_all_views_and_no_controls(page: Page, browser: webdriver.Chrome) -> None:
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    try:
        with window_of(browser, _A4):
            views = browser.find_elements(By.CSS_SELECTOR, "figure.view")
            assert len(views) >= 7
            assert all(one.is_displayed() for one in views)
            boxes = [one.rect for one in views]
            assert all(one["x"] >= 0 and one["x"] + one["width"] <= _A4[0] for one in boxes)
            for controls in browser.find_elements(By.CSS_SELECTOR, ".controls, .keys"):
                assert not controls.is_displayed()
            tall = box(page, "cell-picture")["height"]
            assert 200 < tall <= 130 / 25.4 * 96 + 1  # mm
            assert cut_off(browser) == []
    finally:
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})
