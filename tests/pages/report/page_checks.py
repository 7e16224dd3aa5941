"""What each page of a report must hold: no accessibility fault, nothing cut off, text that is there."""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from selenium import webdriver

LAPTOP, WIDE = (1366, 768), (1920, 1080)

_RUN = """
const done = arguments[arguments.length - 1];
const told = (found) => done(found.violations);
axe.run(document, { resultTypes: ["violations"] }).then(told, (error) => done(String(error)));
"""
_OPEN = """
document.querySelectorAll(".more-flags, .why").forEach((one) => {
  if (one.getAttribute("aria-expanded") === "false" && one.checkVisibility()) one.click();
});
"""
_CUT_OFF = """
const outside = [];
const scrolls = (one) => ["auto", "scroll"].includes(getComputedStyle(one).overflowX);
const inScroll = (one) => one && one !== document.body && (scrolls(one) || inScroll(one.parentElement));
const short = (one) => getComputedStyle(one).textOverflow === "ellipsis";
const inLine = (one) => one && (short(one) || inLine(one.parentElement));
const looked = "button, select, input, summary, a, canvas, svg, p, dd, h1, h2";
for (const one of document.querySelectorAll(looked)) {
  const { left, right, width, height } = one.getBoundingClientRect();
  if (!one.checkVisibility({ visibilityProperty: true }) || width < 2 || height < 2) continue;
  const { overflowX } = getComputedStyle(one);
  const cut = overflowX === "hidden" && one.scrollWidth > one.clientWidth + 1;
  const name = `${one.tagName.toLowerCase()}#${one.id || one.textContent.trim().slice(0, 30)}`;
  if (inLine(one)) continue; // a line that ends in …, and opens
  const beside = left < -1 || (right > innerWidth + 1 && !inScroll(one.parentElement));
  if (beside || cut) outside.push(`${name}: from ${left.toFixed()} to ${right.toFixed()}`);
}
return outside;
"""


def accessibility_faults(browser: webdriver.Chrome) -> list[str]:
    """What axe-core finds on the page, each with the rule and the element."""
    package = find_spec("axe_playwright_python")
    if package is None or package.origin is None:
        pytest.skip("axe-core is not installed: pip install axe-playwright-python")
    script = Path(package.origin).with_name("axe.min.js").read_text(encoding="utf-8")
    browser.execute_script(script)
    found: Any = browser.execute_async_script(_RUN)
    assert isinstance(found, list), found
    return [f"{rule['id']}: {node['html']}" for rule in found for node in rule["nodes"]]


@contextmanager
def window_of(browser: webdriver.Chrome, size: tuple[int, int]) -> Iterator[None]:
    """The page's window in another size."""
    width, height = size
    browser.execute_cdp_cmd(
        "Emulation.setDeviceMetricsOverride",
        {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False},
    )
    try:
        browser.execute_async_script("requestAnimationFrame(() => requestAnimationFrame(arguments[0]))")
        yield
    finally:
        browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def cut_off(browser: webdriver.Chrome) -> list[str]:
    """Controls, pictures and texts that do not lie within the window's width; empty if all do.

    QC flags are opened first: closed, their lines may end in "…".
    """
    browser.execute_script(_OPEN)
    outside: list[str] = browser.execute_script(_CUT_OFF)
    width = browser.execute_script("return [document.documentElement.scrollWidth, innerWidth]")
    return [*outside, *([f"the page is {width[0]} wide"] if width[0] > width[1] else [])]
