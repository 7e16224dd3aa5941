"""A table of what is wrong: kinds of faults, and under each its places, to be clicked."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from qtpy.QtCore import Qt
from qtpy.QtWidgets import QHeaderView, QTreeWidget, QTreeWidgetItem, QVBoxLayout, QWidget

from cytodisk.napari.check.found_flags import FlagPlace, FoundFlag, sentence
from cytodisk.napari.scrolled import ScrolledWords
from cytodisk.number_words import counted

_MOST_PLACES = 1000  # of a kind, that are listed
_OPEN = 12  # places of a kind up to which they are listed from the start
_PART = Qt.ItemDataRole.UserRole


class FlagTable(QWidget):
    """What is wrong, a line each kind, with its places below; what is selected is explained under the table.

    Parameters
    ----------
    go : callable
        Called with the `FlagPlace` that was clicked; returns whether there is anything to see.
    """

    def __init__(self, go: Callable[[FlagPlace], bool]):
        super().__init__()
        self._go = go
        self.tree: Any = QTreeWidget()
        self.tree.setHeaderLabels(["Frame", "Cell", "What is wrong"])
        self.tree.setUniformRowHeights(True)
        header = self.tree.header()
        header.setStretchLastSection(False)
        header.setSectionResizeMode(2, QHeaderView.ResizeMode.Stretch)
        for column in (0, 1):
            header.setSectionResizeMode(column, QHeaderView.ResizeMode.ResizeToContents)
        self.said: Any = ScrolledWords()
        box = QVBoxLayout(self)
        box.setContentsMargins(4, 4, 4, 4)
        box.addWidget(self.tree, 3)
        box.addWidget(self.said.area, 1)
        self.tree.currentItemChanged.connect(self._select)
        self.tree.itemClicked.connect(self._select)
        self.show_flags(())

    def show_flags(self, flags: Sequence[FoundFlag], nothing: str = "Nothing is wrong.") -> None:
        """List flags in the place of what was listed.

        Parameters
        ----------
        flags : sequence of FoundFlag
        nothing : str
            What to say where there are none.
        """
        self.tree.blockSignals(True)
        self.tree.clear()
        places = [place for flag in flags for place in flag.places]
        self.tree.setColumnHidden(1, bool(places) and not any(place.cell for place in places))
        for flag in flags:
            self._add(flag)
        self.tree.blockSignals(False)
        self.said.setText("Click on a line to go there." if flags else nothing)

    def _add(self, flag: FoundFlag) -> None:
        title = f"{flag.name}: {flag.finding}"
        top = QTreeWidgetItem(self.tree, [title, "", ""])
        top.setFirstColumnSpanned(True)
        top.setData(0, _PART, (flag, None))
        top.setToolTip(0, flag.words)
        for place in flag.places[:_MOST_PLACES]:
            frame = "" if place.frame is None else str(place.frame)
            item = QTreeWidgetItem(top, [frame, place.cell, place.note or flag.name])
            item.setData(0, _PART, (flag, place))
            item.setToolTip(2, place.note)
        if len(flag.places) > _MOST_PLACES:
            more = counted(len(flag.places) - _MOST_PLACES, "more place")
            last = QTreeWidgetItem(top, ["", "", f"… {more}, each with a circle in its frame"])
            last.setData(0, _PART, (flag, None))
        top.setExpanded(len(flag.places) <= _OPEN)

    def _select(self, item: Any, *_: Any) -> None:
        part = None if item is None else item.data(0, _PART)
        if part is None:
            return
        flag, place = part
        place = flag.places[0] if place is None and flag.places else place
        seen = place is not None and self._go(place)
        told = part[1] is not None and place.note not in flag.words
        note = f"{sentence(place.note)} " if told else ""
        unseen = "" if seen or place is None else " (There is no such place in the layers that are shown.)"
        self.said.setText(f"{note}{flag.words[:1].upper()}{flag.words[1:]}{unseen}")
