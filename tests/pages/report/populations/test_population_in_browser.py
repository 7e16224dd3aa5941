from pathlib import Path
from typing import Any

import pytest
from page_driver import errors, requests
from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import Select, WebDriverWait

from cytodisk.pages.report.populations.population_html import population_page
from cytodisk.store.populations.population_study import PopulationStudy

pytestmark = pytest.mark.slow


class PopulationPage:
    """The page of a population in a browser."""

    def __init__(self, browser: webdriver.Chrome, path: Path) -> None:
        self.browser = browser
        browser.get(path.as_uri())
        self.wait("cytodisk.ready")

    def js(self, expression: str) -> Any:
        return self.browser.execute_script(f"return {expression}")

    def wait(self, condition: str) -> None:
        WebDriverWait(self.browser, 15, 0.02).until(lambda _: self.js(condition), condition)

    def text(self, name: str) -> str:
        return str(self.browser.find_element(By.ID, name).text)


@pytest.fixture
def page(browser: webdriver.Chrome, population_written: Path) -> PopulationPage:
    return PopulationPage(browser, population_written)


def test_loads_alone_and_in_silence(page: PopulationPage, browser: webdriver.Chrome) -> None:
    assert requests(browser) == [browser.current_url]
    assert errors(browser) == []
    assert page.js("document.documentElement.scrollWidth <= innerWidth")
    for name in ("disk-0", "disk-2", "cell-2", "profiles", "superplot", "forest"):
        assert page.js(f"document.getElementById('{name}').getBoundingClientRect().width > 100"), name


def test_window_under_the_pointer_has_its_numbers(page: PopulationPage, compared: PopulationStudy) -> None:
    page.js("document.getElementById('disk-2').scrollIntoView({ block: 'center' })")
    disk = "document.getElementById('disk-2').getBoundingClientRect()"
    box = page.js(f"(({{left, top, width}}) => [left, top, width])({disk})")
    radius = 0.9 * box[2] / 2.32
    at = {"x": box[0] + box[2] / 2 + radius * 0.92, "y": box[1] + box[2] / 2 + radius * 0.39}
    page.browser.execute_cdp_cmd("Input.dispatchMouseEvent", {"type": "mouseMoved", **at})
    page.wait("cytodisk.atlasState.window === 0")
    page.wait("document.getElementById('read').textContent.includes('sector 0')")
    words = page.text("read")
    window = compared.window_arrays("drug").isel(channel=0, layer=0, sector=0)
    assert f"{float(window['p_fwer']):.2g}" in words
    assert "p corrected (max-T)" in words
    assert "(8 cells, 4 experiments)" in words
    if window["cluster"] > 0:
        clusters = compared.clusters[compared.clusters["channel"] == "Rac1"].set_index("cluster")
        p = float(clusters.loc[int(window["cluster"]), "p_holm"])
        assert f"{int(window['cluster'])}, p corrected {p:.2g}" in words


def test_windows_that_do_not_differ_are_hatched_on_all_sides(page: PopulationPage) -> None:
    grey = page.browser.execute_script(
        """
        const canvas = document.getElementById("disk-2");
        const { data, width } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
        const p = cytodisk.ofWindows("p_holm");
        const pixel = (share) => Math.round(width / 2 * (1 + share / 1.16));
        const at = (turn, far) => 4 * (pixel(far * Math.sin(turn)) * width + pixel(far * Math.cos(turn)));
        return Array.from({ length: 8 }, (_, sector) => {
          const angle = (sector + 0.5) * Math.PI / 4;
          const steps = Array.from({ length: 200 }, (_, k) => at(angle, 0.85 + 0.1 * k / 200));
          const lines = steps.filter((k) => data[k] < 190 && Math.abs(data[k] - data[k + 2]) < 12).length;
          return [p[sector] <= cytodisk.data.level, lines > 0];
        });
        """
    )
    assert [marked != hatched for marked, hatched in grey] == [True] * 8


def test_outline_of_the_cell_is_closed(page: PopulationPage) -> None:
    gaps = page.browser.execute_script(
        """
        const { shape: [height, width], labels } = cytodisk.cell;
        const { data } = document.getElementById("cell-0").getContext("2d").getImageData(0, 0, width, height);
        const outside = (k) => labels[k] === 65535;
        return [...labels.keys()].filter((k) => {
          const border = k % width === 0 || (k + 1) % width === 0 || k < width || k >= labels.length - width;
          if (outside(k) || border) return false;
          return [k - 1, k + 1, k - width, k + width].some(outside) && data[4 * k] !== 0x55;
        }).length;
        """
    )
    assert gaps == 0


def test_main_columns_fit_a_laptop(page: PopulationPage) -> None:
    assert page.js("innerWidth") <= 1366
    box = "document.querySelector('#table-scalars .scroll')"
    assert page.js(f"{box}.scrollWidth <= {box}.clientWidth")


def test_eight_experiments_have_eight_marks(page: PopulationPage) -> None:
    shapes = page.js("Array.from({ length: 8 }, (_, k) => cytodisk.mark(k, 7, 0, 0, {}).getAttribute('d'))")
    assert len(set(shapes)) == 8


def test_small_numbers_have_true_minuses(page: PopulationPage) -> None:
    assert page.js("cytodisk.digits(-0.00072)") == "−7.2e−4"


def test_very_many_numbers_have_a_range(page: PopulationPage) -> None:
    low, high = page.js("cytodisk.range(Array.from({ length: 300000 }, (_, k) => k), 0)")
    assert (low, high) == (0, 299_999)


def test_channel_and_scalar_are_chosen(page: PopulationPage) -> None:
    assert "Rac1" in page.text("value")
    Select(page.browser.find_element(By.ID, "atlas-channel")).select_by_index(1)
    assert "RhoA" in page.text("value")
    Select(page.browser.find_element(By.ID, "scalar")).select_by_visible_text("area")
    assert "area" in page.js("document.querySelector('#superplot svg').getAttribute('aria-label')")
    dots = page.js("document.querySelectorAll('#superplot circle').length")
    marks = page.js("document.querySelectorAll('#superplot path[transform]').length")
    assert (dots, marks) == (16, 8)  # cells, experiments


def test_tables_are_sorted_and_open_cells_on_the_chosen_channel(page: PopulationPage) -> None:
    Select(page.browser.find_element(By.ID, "atlas-channel")).select_by_index(1)
    page.browser.find_element(By.CSS_SELECTOR, '#table-cells th[data-name="cell"] button').click()
    assert page.js("document.querySelector('#table-cells th[data-name=\"cell\"]').ariaSort") == "ascending"
    page.browser.find_element(By.CSS_SELECTOR, "#table-cells tbody a").click()
    page.wait("cytodisk.shownCell !== undefined && document.getElementById('cell')?.open")
    assert page.js("location.pathname").endswith("/maps/report.html")
    assert page.js("location.hash").endswith("&channel=RhoA")
    assert page.js("cytodisk.data.channels[cytodisk.cellState.channel].name") == "RhoA"


def test_shapes_alone_have_their_comparison(browser: webdriver.Chrome, shapes_written: Path) -> None:
    page = PopulationPage(browser, shapes_written)
    assert errors(browser) == []
    assert page.js("document.querySelectorAll('#forest circle').length") == 2  # scalars
    assert "4 + 4 experiments" in page.text("compared")
    assert browser.find_elements(By.ID, "atlas-channel") == []


@pytest.mark.parametrize("table", ["profiles", "scalars", "clusters", "left_out", "experiments", "cells"])
def test_a_table_without_rows_leaves_the_others(
    browser: webdriver.Chrome, compared: PopulationStudy, tmp_path: Path, table: str
) -> None:
    study = PopulationStudy(compared.path, compared.provenance)
    study.__dict__[table] = getattr(compared, table).iloc[:0]
    path = tmp_path / "report.html"
    path.write_text(population_page(study), encoding="utf-8")
    page = PopulationPage(browser, path)
    assert errors(browser) == []
    assert page.js("document.getElementById('failed').hidden")
