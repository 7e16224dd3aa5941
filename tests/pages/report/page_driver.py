"""Moves a page's pointer and reads its state."""

import json
import time
from pathlib import Path
from typing import Any

from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.remote.webelement import WebElement
from selenium.webdriver.support.ui import WebDriverWait

_PLACE = """
const figure = cytodisk.figures[arguments[0]];
figure.canvas.scrollIntoView({ block: "center" });
return figure.toPage(arguments[1], arguments[2]);
"""
_TWO_FRAMES = "requestAnimationFrame(() => requestAnimationFrame(arguments[0]))"


class Page:
    """A report in a browser."""

    def __init__(self, browser: webdriver.Chrome, path: Path) -> None:
        self.browser = browser
        browser.get(path.as_uri())
        self.wait("cytodisk.ready && cytodisk.shown !== null")

    def js(self, expression: str) -> Any:
        return self.browser.execute_script(f"return {expression}")

    def wait(self, condition: str) -> None:
        WebDriverWait(self.browser, 15, 0.02).until(lambda _: self.js(condition), condition)

    def text(self, name: str) -> str:
        return str(self.js(f"document.getElementById({name!r}).textContent"))

    def control(self, name: str) -> WebElement:
        return self.browser.find_element(By.ID, name)

    def press(self, key: str) -> None:
        self.browser.switch_to.active_element.send_keys(key)
        self.settle()

    def settle(self) -> None:
        """Until what was asked for is drawn."""
        time.sleep(0.05)
        self.browser.execute_async_script(_TWO_FRAMES)  # the page draws in the next one
        self.wait("cytodisk.shown.index === cytodisk.state.index")

    def _mouse(self, kind: str, at: list[float], **more: Any) -> None:
        event = {"type": kind, "x": at[0], "y": at[1], **more}
        self.browser.execute_cdp_cmd("Input.dispatchMouseEvent", event)

    def hover(self, figure: str, x: float, y: float) -> list[float]:
        """Put the pointer on a point of a view, in the view's own coordinates."""
        at: list[float] = self.browser.execute_script(_PLACE, figure, x, y)
        self._mouse("mouseMoved", [at[0] - 1, at[1]])
        self._mouse("mouseMoved", at)
        self.settle()
        return at

    def click(self, figure: str, x: float, y: float) -> None:
        at = self.hover(figure, x, y)
        self._mouse("mousePressed", at, button="left", clickCount=1)
        self._mouse("mouseReleased", at, button="left", clickCount=1)
        self.settle()

    def focus(self) -> Any:
        """(layer, sector, frame) that all views highlight."""
        at = self.js("cytodisk.focus()")
        return (
            None
            if at is None
            else (at["layer"], at["sector"], self.js(f"cytodisk.data.frames[{at['index']}]"))
        )


def requests(browser: webdriver.Chrome) -> list[str]:
    """What the page asked for, but for data inside it."""
    messages = [json.loads(entry["message"])["message"] for entry in browser.get_log("performance")]
    sent: list[Any] = [m["params"] for m in messages if m["method"] == "Network.requestWillBeSent"]
    urls = [str(params["request"]["url"]) for params in sent]
    return [url for url in urls if not url.startswith(("data:", "blob:", "about:"))]


def errors(browser: webdriver.Chrome) -> list[str]:
    """What the page complained of since it was opened."""
    return [str(entry["message"]) for entry in browser.get_log("browser") if entry["level"] == "SEVERE"]
