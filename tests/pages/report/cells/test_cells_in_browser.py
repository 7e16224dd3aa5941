from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cells_study import CHANNELS, FILES, LAYERS, SECTORS
from page_driver import errors, requests
from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.remote.webelement import WebElement
from selenium.webdriver.support.ui import Select, WebDriverWait

from cytodisk.store.study import Study

pytestmark = pytest.mark.slow


class CellsPage:
    """The page of single cells in a browser."""

    def __init__(self, browser: webdriver.Chrome, path: Path, place: str = "") -> None:
        self.browser = browser
        browser.get(path.as_uri() + place)
        self.wait("cytodisk.ready")

    def js(self, expression: str) -> Any:
        return self.browser.execute_script(f"return {expression}")

    def wait(self, condition: str) -> None:
        WebDriverWait(self.browser, 15, 0.02).until(lambda _: self.js(condition), condition)

    def find(self, selector: str) -> WebElement:
        return self.browser.find_element(By.CSS_SELECTOR, selector)

    def all(self, selector: str) -> list[WebElement]:
        return self.browser.find_elements(By.CSS_SELECTOR, selector)

    def column(self, number: int) -> list[str]:
        return [one.text for one in self.all(f"table.list tbody td:nth-child({number})")]

    def press(self, key: str) -> None:
        self.browser.switch_to.active_element.send_keys(key)

    def shown(self, cell: int) -> None:
        self.wait(f"cytodisk.shownCell === {cell}")

    def as_table(self) -> None:
        self.find("button[value=table]").click()


@pytest.fixture
def page(browser: webdriver.Chrome, cells_written: Path) -> CellsPage:
    return CellsPage(browser, cells_written)


def test_loads_alone_and_in_silence(page: CellsPage, browser: webdriver.Chrome) -> None:
    assert requests(browser) == [browser.current_url]
    assert errors(browser) == []
    assert browser.title == "study – cytodisk report"
    assert page.js("document.documentElement.scrollWidth <= innerWidth")
    assert not page.find("#failed").is_displayed()
    assert len(page.all(".card")) == 6
    assert page.all(".card strong")[0].text == f"{FILES[0]}, label 1"


def test_table_is_sorted_by_any_column_also_by_key(page: CellsPage) -> None:
    page.as_table()
    assert page.column(1) == ["0", "1", "2", "3", "4", "5"]
    button = page.find('th[data-name="area"] button')
    button.send_keys(Keys.ENTER)
    place = page.js(
        "[...document.querySelectorAll('table.list th')].findIndex((one) => one.dataset.name === 'area')"
    )
    areas = page.column(place + 1)
    assert areas[-1] == ""  # the refused one has none, and stands last
    assert [float(area) for area in areas[:-1]] == sorted(float(area) for area in areas[:-1])
    assert page.find('th[data-name="area"]').get_attribute("aria-sort") == "ascending"
    page.press(Keys.ENTER)  # the same heading still has the focus
    assert page.find('th[data-name="area"]').get_attribute("aria-sort") == "descending"
    areas = page.column(place + 1)
    assert areas[-1] == ""
    assert [float(area) for area in areas[:-1]] == sorted((float(area) for area in areas[:-1]), reverse=True)


def test_filter_by_text_and_by_status(page: CellsPage) -> None:
    page.as_table()
    page.find("#cells input[type=search]").send_keys("b.tif")
    assert page.column(1) == ["3", "4", "5"]
    assert page.find("#cells .count").text == "3 of 6"
    Select(page.find("#cells select[aria-label^='cells of which status']")).select_by_visible_text(
        "refused (1)"
    )
    assert page.column(1) == ["5"]
    page.find("#cells input[type=search]").send_keys("x")
    assert "Nothing fits" in page.find("#cells .scroll").text


def test_click_opens_a_cell_and_steps_go_on(page: CellsPage, browser: webdriver.Chrome) -> None:
    page.all(".card")[1].click()
    page.shown(1)
    assert page.find("#cell-name").text == f"{FILES[0]}, label 2"
    assert page.find("#cell-place").text == "2 of 6"
    assert page.js("location.hash") == "#cell-1"
    options = [option.get_property("textContent") for option in Select(page.find("#channel")).options]
    assert options[1] == CHANNELS[1]
    page.find("#next").click()
    page.shown(2)
    page.press(Keys.ARROW_LEFT)
    page.shown(1)
    page.press(Keys.ESCAPE)
    assert not page.js("document.getElementById('cell').open")
    page.wait("location.hash === ''")
    assert errors(browser) == []


def test_pointer_on_a_window_reads_its_numbers(page: CellsPage, cells: Study) -> None:
    page.js("cytodisk.open(0)")
    page.shown(0)
    layer, sector = 1, 3
    angle, radius = 2 * np.pi * (sector + 0.5) / SECTORS, float(np.sqrt(1 - 1.5 / LAYERS))
    box = "document.getElementById('cell-disk').getBoundingClientRect()"
    x, y, width = page.js(f"(({{left, top, width}}) => [left + width / 2, top + width / 2, width])({box})")
    reach = width / 2 / 1.16
    at = {"x": x + reach * radius * np.cos(angle), "y": y + reach * radius * np.sin(angle)}
    page.browser.execute_cdp_cmd("Input.dispatchMouseEvent", {"type": "mouseMoved", **at})
    page.wait(f"cytodisk.cellState.window === {layer * SECTORS + sector}")
    page.wait("document.getElementById('read').textContent.includes('sector 3')")
    windows = cells.windows.set_index(["cell", "channel", "layer", "sector"]).loc[
        (0, CHANNELS[1], layer, sector)
    ]
    assert f"{windows['mean']:.0f} ± " in page.find("#read").text
    page.js("cytodisk.stepWindow(0, 1)")
    page.wait("document.getElementById('read').textContent.includes('sector 4')")


def test_refused_cell_shows_its_mask_and_reason(page: CellsPage) -> None:
    page.find("p.lost button").click()
    page.shown(5)
    assert "refused" in page.find("#cell-badges").text
    assert page.find("#cell-picture").is_displayed()
    assert not page.find("#disk-side").is_displayed()


def test_address_of_a_cell_opens_it(browser: webdriver.Chrome, cells_written: Path) -> None:
    page = CellsPage(browser, cells_written, "#cell-4")
    page.shown(4)
    assert page.find("#cell-name").text == f"{FILES[1]}, label 2"


@pytest.mark.parametrize("size", [(1366, 768), (1920, 1080)])
def test_no_control_of_an_open_cell_is_cut_off(page: CellsPage, size: tuple[int, int]) -> None:
    metrics = {"width": size[0], "height": size[1], "deviceScaleFactor": 1, "mobile": False}
    page.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
    try:
        page.js("cytodisk.open(0)")
        page.shown(0)
        for control in page.all(
            "dialog button, dialog select, dialog input, dialog canvas, dialog .bar-line"
        ):
            box = control.rect
            assert box["x"] >= 0
            assert box["y"] >= 0
            assert box["x"] + box["width"] <= size[0]
            assert box["y"] + box["height"] <= size[1], control.get_attribute("id")
    finally:
        page.browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
