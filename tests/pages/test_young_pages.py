"""A page is made again where what it shows is younger."""

import os
from pathlib import Path

import pytest

from cytodisk.files import mark_of
from cytodisk.pages.batch_reports import _is_young
from cytodisk.store.provenance_file import write_json
from cytodisk.store.results.study_results import DERIVED


@pytest.mark.parametrize("folder", DERIVED)
def test_a_page_is_older_than_what_was_computed_after_it(folder: str, tmp_path: Path) -> None:
    page, cells = tmp_path / "report.html", tmp_path / "cells.parquet"
    for file in (cells, page):
        file.write_text("there")
    os.utime(cells, (1000, 1000))
    write_json(tmp_path / "provenance.json", {"fingerprint": {}, "files": {"report.html": mark_of(page)}})
    assert _is_young(tmp_path)
    settings = tmp_path / folder / "one" / "settings.json"
    settings.parent.mkdir(parents=True)
    settings.write_text("{}")
    later = page.stat().st_mtime + 10
    os.utime(settings, (later, later))
    assert not _is_young(tmp_path)
