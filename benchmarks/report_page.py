"""Size of a report page, how fast it is written and first seen in Chromium, and moved through time."""

import argparse
import shutil
import statistics
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.support.ui import WebDriverWait

import cytodisk as cd
from cytodisk.pages.report.page import write_report

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
_LOADS = 5
_SEEN = "performance.getEntriesByName('first-contentful-paint')[0]?.startTime"
_GO_TO = """
cytodisk.drawMilliseconds = null;
const slider = document.getElementById("time");
slider.value = arguments[0];
slider.dispatchEvent(new Event("input"));
"""


def open_browser(profile: str) -> webdriver.Chrome:
    """Headless Chromium with an empty profile."""
    browser, driver = shutil.which("chromium"), shutil.which("chromedriver")
    if browser is None or driver is None:
        sys.exit("chromium and chromedriver are needed, and not found")
    options = webdriver.ChromeOptions()
    options.binary_location = browser
    for argument in (*_QUIET, f"--user-data-dir={profile}"):
        options.add_argument(argument)
    return webdriver.Chrome(options=options, service=Service(driver))


def wait_for(browser: webdriver.Chrome, expression: str) -> Any:
    """Value of an expression as soon as it is neither null nor false."""
    return WebDriverWait(browser, 60, 0.01).until(lambda _: browser.execute_script(f"return {expression}"))


def load_seconds(browser: webdriver.Chrome, page: Path, is_movie: bool) -> tuple[float, float]:
    """From the start of navigation until text is seen, and until all views are drawn."""
    browser.get(page.as_uri())
    wait_for(browser, "window.cytodisk?.ready" + (" && cytodisk.shown !== null" if is_movie else ""))
    seen = wait_for(browser, _SEEN)
    drawn = browser.execute_script("return cytodisk.readyMilliseconds")
    return float(seen) / 1000, float(drawn) / 1000


def frame_milliseconds(browser: webdriver.Chrome) -> list[float]:
    """From moving the slider until the frame is drawn, once for each frame but the first."""
    spent = []
    for index in range(1, int(browser.execute_script("return cytodisk.data.frames.length"))):
        browser.execute_script(_GO_TO, index)
        spent.append(float(wait_for(browser, "cytodisk.drawMilliseconds")))
    return spent


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("study", type=Path, nargs="+", help="study folders of movies or masks")
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        browser = open_browser(folder)
        try:
            for path in parser.parse_args().study:
                study = cd.open_study(path)
                start = time.perf_counter()
                page = write_report(study, Path(folder) / "report.html")
                written = time.perf_counter() - start
                loads = [load_seconds(browser, page, study.is_movie) for _ in range(_LOADS)]
                seen, drawn = (statistics.median(times) for times in zip(*loads, strict=True))
                print(
                    f"{path.name}: {page.stat().st_size / 1e6:.2f} MB, written in {written:.1f} s; first "
                    f"text after {seen:.2f} s, all drawn after {drawn:.2f} s (medians of {_LOADS})"
                )
                if study.is_movie:
                    frames = frame_milliseconds(browser)
                    print(f"  a frame takes {statistics.median(frames):.0f} ms, {max(frames):.0f} ms at most")
        finally:
            browser.quit()


if __name__ == "__main__":
    main()
