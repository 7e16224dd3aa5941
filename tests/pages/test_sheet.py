"""Pages in millimetres: names that users give are written as they are."""

from pathlib import Path

from matplotlib.lines import Line2D

from cytodisk.pages.sheet import Sheet


def test_names_with_dollar_signs_are_no_formulas(tmp_path: Path) -> None:
    sheet = Sheet(40.0, 60.0)
    ax = sheet.axes(10, 10, 40, 20)
    sheet.text(2, 4, r"5 $\foo$")
    sheet.key(2, 34, [Line2D([], [], label=r"$\foo$")], 1)
    ax.plot([0, 1], label="$a_{$")
    ax.legend()
    note = ax.annotate(r"$\bar$", (0, 0))
    assert sheet.save(tmp_path / "page.png").exists()
    assert not note.get_parse_math()
