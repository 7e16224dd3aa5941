"""What stands on the pages, read from their HTML; no browser."""

import json
import re
from html.parser import HTMLParser
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest
import tifffile
from report_study import FRAMES

from cytodisk.pages.report import encoded_cells
from cytodisk.pages.report.page import write_report
from cytodisk.runs.movie.movie_inputs import open_movie
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.movie.movie_study import movie_study
from cytodisk.simulate.moving_cells import SimulatedMovie
from cytodisk.store.study import Study

_ASSETS = files("cytodisk.pages.report") / "assets"
_MOST_SCRIPT = 80_000  # bytes a page; a plotting library alone had 1.3 MB
_LEAST_CONTRAST = 4.5  # of small text, WCAG 2.2 AA


class _Elements(HTMLParser):
    """Names, attributes and enclosing labels of a page's elements."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.found: list[tuple[str, dict[str, str | None], bool]] = []
        self._labels = 0
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, dict(attributes), self._labels > 0))
        self._labels += tag == "label"

    def handle_endtag(self, tag: str) -> None:
        self._labels -= tag == "label"

    @property
    def ids(self) -> list[str]:
        return [str(attributes["id"]) for _, attributes, _ in self.found if "id" in attributes]


@pytest.fixture(scope="module")
def two_cells(truth: SimulatedMovie, tmp_path_factory: pytest.TempPathFactory) -> Study:
    """The second cell, mirrored, leaves after three frames."""
    folder = tmp_path_factory.mktemp("two")
    first = truth.masks.astype(np.uint8)
    second = 2 * first[:, :, ::-1] * (np.arange(FRAMES) < 3)[:, None, None].astype(np.uint8)
    labels = np.concatenate([first, second], axis=2)
    tifffile.imwrite(folder / "labels.tif", labels, metadata={"axes": "TYX"}, photometric="minisblack")
    parameters = MovieParameters(layers=2, sectors=6, kind="labels")
    return movie_study(open_movie(folder / "labels.tif", None, parameters), folder / "two")


def html_of(page: Path) -> str:
    return page.read_text(encoding="utf-8")


def test_parts_stand_in_their_order(written: Path) -> None:
    ids = _Elements(html_of(written)).ids
    assert [one for one in ids if one in ("finding", "flags", "explorer")] == ["finding", "flags", "explorer"]
    assert ids.index("cell-picture") < ids.index("figure-velocity") < ids.index("disk-picture")
    assert len(ids) == len(set(ids))


def test_every_control_has_a_name(written: Path) -> None:
    controls = [one for one in _Elements(html_of(written)).found if one[0] in ("input", "select")]
    assert len(controls) >= 10
    assert all(in_label or attributes.get("aria-label") for _, attributes, in_label in controls)


def test_movie_without_a_signal_has_no_empty_plot(bare_study: Study, tmp_path: Path) -> None:
    ids = set(_Elements(html_of(write_report(bare_study, tmp_path / "bare.html"))).ids)
    assert {"cell-picture", "figure-velocity", "figure-area", "disk-picture"} <= ids
    assert not ids & {
        "figure-activity",
        "figure-intensity",
        "peaks-picture",
        "figure-curve",
        "black",
        "colours",
    }


def test_page_is_mostly_data(written: Path) -> None:
    scripts = re.findall(r"<script>(.*?)</script>", html_of(written), re.DOTALL)
    assert sum(map(len, scripts)) < _MOST_SCRIPT


def test_page_names_no_other_host(written: Path) -> None:
    text = html_of(written)
    assert re.findall(r"https?://(?!www\.w3\.org/2000/svg)[\w.-]+", text) == []
    assert "default-src 'none'" in text


def test_cells_without_room_are_named_with_the_command(
    two_cells: Study, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(encoded_cells, "LEAST_BYTES", encoded_cells.MOST_BYTES)
    text = html_of(write_report(two_cells, tmp_path / "report.html"))
    assert text.count('id="cell-1"') == 0
    assert "This page has room for 1 cell. Left out: 1." in text
    assert "cytodisk report two --cell 1" in text
    told = json.loads(re.findall(r'id="study">(.*?)</script>', text)[0])
    assert told["cells"] == [{"cell": 0, "shown": True}, {"cell": 1, "shown": False}]


def test_later_cells_are_left_out_of_a_full_page(
    two_cells: Study, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(encoded_cells, "MOST_TEXT", 1000)
    text = html_of(write_report(two_cells, tmp_path / "report.html"))
    assert [f'id="cell-{cell}"' in text for cell in (0, 1)] == [True, False]
    assert "Left out: 1." in text


def test_each_cell_has_a_row_and_a_button(two_cells: Study, tmp_path: Path) -> None:
    found = _Elements(html_of(write_report(two_cells, tmp_path / "report.html"))).found
    rows = [
        attributes["data-row"] for tag, attributes, _ in found if tag == "tr" and "data-row" in attributes
    ]
    assert rows == ["0", "1"]
    opens = [attributes for _, attributes, _ in found if attributes.get("class") == "opens"]
    assert [one["data-cell"] for one in opens] == rows


@pytest.mark.parametrize("name", ["page", "cells", "population", "batch"])
def test_pages_share_one_head(name: str) -> None:
    text = (_ASSETS / "templates" / f"{name}.html").read_text(encoding="utf-8")
    assert text.startswith('{% extends "base.html" %}')
    assert "<head" not in text


def _luminance(colour: str) -> float:
    digits = colour.lstrip("#")
    digits = "".join(2 * digit for digit in digits) if len(digits) == 3 else digits
    parts = np.array([int(digits[k : k + 2], 16) for k in (0, 2, 4)]) / 255
    linear = np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])


@pytest.mark.parametrize("name", ["ink", "quiet", "flag", "clear", "focus"])
def test_text_can_be_read(name: str) -> None:
    style = (_ASSETS / "styles" / "page.css").read_text(encoding="utf-8")
    colour = re.findall(rf"--{name}: (#\w+)", style)[0]
    for paper in ("#fff", "#fff6f0", "#f1faf6", "#eef4fb"):
        contrast = (_luminance(paper) + 0.05) / (_luminance(colour) + 0.05)
        assert contrast >= _LEAST_CONTRAST, paper
