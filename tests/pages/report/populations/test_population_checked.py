"""The page of a population: no accessibility fault, nothing cut off, its sentences first."""

from pathlib import Path

import pytest
from page_checks import LAPTOP, WIDE, accessibility_faults, cut_off, window_of
from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait

from cytodisk.pages.population.drawn_population import DrawnPopulation
from cytodisk.pages.report.populations.population_words import headline
from cytodisk.store.populations.population_study import PopulationStudy

pytestmark = pytest.mark.slow


def test_both_pages(
    browser: webdriver.Chrome, population_written: Path, shapes_written: Path, compared: PopulationStudy
) -> None:
    for path in (shapes_written, population_written):
        browser.get(path.as_uri())
        WebDriverWait(browser, 15, 0.02).until(lambda _: browser.execute_script("return cytodisk.ready"))
        assert accessibility_faults(browser) == []
        for size in (LAPTOP, WIDE):
            with window_of(browser, size):
                assert cut_off(browser) == []
    said = browser.find_element(By.ID, "finding").text
    assert said.splitlines()[0].startswith(headline(DrawnPopulation(compared))[:-1])
    assert 1 <= len(said.splitlines()) <= 3
