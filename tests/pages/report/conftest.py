"""A small movie with a gap and names that break careless pages, its study, and a browser."""

import shutil
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import tifffile
from report_study import FRAMES, LAYERS, NAMES, SECTORS, correlated
from selenium import webdriver
from selenium.webdriver.chrome.service import Service

import cytodisk as cd
from cytodisk.pages.report.page import write_report
from cytodisk.runs.correlate.correlation_columns import CORRELATION_TABLES
from cytodisk.runs.movie.movie_inputs import open_movie
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.movie.movie_study import movie_study
from cytodisk.simulate.moving_cells import SimulatedMovie
from cytodisk.store.correlation_store import write_correlation
from cytodisk.store.study import Study

_SMALL = MovieParameters(layers=LAYERS, sectors=SECTORS)
_CHROMIUM, _DRIVER = shutil.which("chromium"), shutil.which("chromedriver")
_LONGEST = 60  # seconds that a page, or a script on it, may take before the test fails; a browser can hang
_QUIET = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--window-size=1366,768",
)


@pytest.fixture(scope="session")
def truth() -> SimulatedMovie:
    """Five bulges come and go; frame 6 is lost."""
    return cd.simulate.movie("dropping", 0, frames=FRAMES, radius_px=20.0)


@pytest.fixture(scope="session")
def masks(truth: SimulatedMovie, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("report") / "masks.tif"
    tifffile.imwrite(path, truth.masks.astype(np.uint8), metadata={"axes": "TYX"}, photometric="minisblack")
    return path


@pytest.fixture(scope="session")
def signal(truth: SimulatedMovie, masks: Path) -> Path:
    assert truth.signal is not None
    path = masks.with_name("signal.ome.tif")
    metadata = {
        "axes": "TCYX",
        "Channel": {"Name": NAMES},
        "PhysicalSizeX": 0.16,
        "PhysicalSizeY": 0.16,
        "TimeIncrement": 5.0,
        "TimeIncrementUnit": "s",
    }
    tifffile.imwrite(path, truth.signal.to_numpy(), metadata=metadata, ome=True, photometric="minisblack")
    return path


@pytest.fixture(scope="session")
def study(masks: Path, signal: Path) -> Study:
    return movie_study(open_movie(masks, signal, _SMALL), masks.with_name("study"))


@pytest.fixture(scope="session")
def bare_study(masks: Path) -> Study:
    """Without a signal, a scale or an interval."""
    return movie_study(open_movie(masks, None, _SMALL), masks.with_name("bare"))


@pytest.fixture(scope="session")
def written(study: Study) -> Path:
    """The page of the study with a correlation."""
    write_correlation(study.path, NAMES[1], "velocity", correlated(), CORRELATION_TABLES, {"max_lag": 3})
    return write_report(study, study.path.with_name("report.html"))


@pytest.fixture(scope="session")
def chromium(tmp_path_factory: pytest.TempPathFactory) -> Iterator[webdriver.Chrome]:
    if _CHROMIUM is None or _DRIVER is None:
        pytest.skip("chromium and chromedriver are not installed")
    options = webdriver.ChromeOptions()
    options.binary_location = _CHROMIUM
    for argument in (*_QUIET, f"--user-data-dir={tmp_path_factory.mktemp('profile')}"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(options=options, service=Service(_DRIVER))
    driver.set_page_load_timeout(_LONGEST)
    driver.set_script_timeout(_LONGEST)
    driver.get("about:blank")
    yield driver
    driver.quit()


@pytest.fixture
def browser(chromium: webdriver.Chrome) -> webdriver.Chrome:
    """The browser, with empty logs."""
    chromium.get("about:blank")
    chromium.get_log("browser")
    chromium.get_log("performance")
    return chromium
