"""The page of single cells: no accessibility fault, nothing cut off, the finding first."""

from pathlib import Path

import pytest
from page_checks import LAPTOP, WIDE, accessibility_faults, cut_off, window_of
from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait

from cytodisk.runs.findings.cells_finding import cells_finding
from cytodisk.store.study import Study

pytestmark = pytest.mark.slow


def test_list_and_opened_cell(browser: webdriver.Chrome, cells_written: Path, cells: Study) -> None:
    for place in ("", "#cell-0"):
        browser.get("about:blank")
        browser.get(cells_written.as_uri() + place)
        WebDriverWait(browser, 15, 0.02).until(lambda _: browser.execute_script("return cytodisk.ready"))
        assert browser.find_element(By.ID, "cell").is_displayed() is bool(place)
        assert accessibility_faults(browser) == []
        for size in (LAPTOP, WIDE):
            with window_of(browser, size):
                assert cut_off(browser) == []
    said = browser.find_element(By.ID, "finding").get_property("textContent")
    for words in cells_finding(cells).sentences:
        assert words in said
