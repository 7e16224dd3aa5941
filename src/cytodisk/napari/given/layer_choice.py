"""A list of the viewer's layers of fitting kinds to choose from, kept up to date."""

from __future__ import annotations

import re
from typing import Any

from qtpy.QtCore import Qt, Signal
from qtpy.QtWidgets import QComboBox, QListWidget, QListWidgetItem, QVBoxLayout, QWidget

from cytodisk.napari.given.binary_layers import looks_binary
from cytodisk.napari.given.layer_kinds import LayerKind, is_picture, is_result, layer_kind

_WORDS = {"labels": "labels", "shapes": "shapes", "image": "image", "tracks": "tracks", "points": "points"}
_ROW = 22  # px
_LETTERS = 12  # of a name, for which there is room in a narrow dock

_NUCLEI = re.compile("nucle|dapi|hoechst", re.IGNORECASE)  # in names of layers


class LayerChoice(QWidget):
    """Choose a layer, or several; the list follows layers that come, go, or are renamed.

    Parameters
    ----------
    viewer : napari.Viewer
    kinds : tuple of str
        Which layers fit; labels come before images. Layers that cytodisk made as results do not.
    optional : bool
        Whether no layer can be chosen; it is what is chosen first.
    several : bool
        Whether more than one can be chosen, each with a box to tick.
    """

    changed = Signal()

    def __init__(
        self, viewer: Any, kinds: tuple[LayerKind, ...], *, optional: bool = False, several: bool = False
    ):
        super().__init__()
        self._viewer, self._kinds, self._optional = viewer, kinds, optional
        self._list: Any = QListWidget() if several else QComboBox()
        self._several, self._by_hand = several, False
        self._watched: list[Any] = []
        self._offered: list[Any] = []  # by row; as data of Qt's items None would lose a reference each time
        if not several:
            self._list.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
            self._list.setMinimumContentsLength(_LETTERS)
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)
        box.addWidget(self._list)
        (self._list.itemChanged if several else self._list.currentIndexChanged).connect(self._chosen)
        if not several:
            self._list.activated.connect(self._note_hand)
        for event in (viewer.layers.events.inserted, viewer.layers.events.removed):
            event.connect(self._refresh)
        self._refresh()

    @property
    def layers(self) -> tuple[Any, ...]:
        """The chosen layers, in the order of the list."""
        if not self._several:
            row = self._list.currentIndex()
            return () if row < 0 or self._offered[row] is None else (self._offered[row],)
        rows = range(len(self._offered))
        ticked = [row for row in rows if self._list.item(row).checkState() == Qt.CheckState.Checked]
        return tuple(self._offered[row] for row in ticked)

    @property
    def layer(self) -> Any | None:
        """The first chosen layer, or None."""
        return next(iter(self.layers), None)

    def choose(self, *layers: Any) -> None:
        """Choose layers of the list; none to choose nothing where that is possible."""
        self._by_hand = True
        self._fill(layers)
        self.changed.emit()

    def close_down(self) -> None:
        """Follow the viewer no more."""
        for event in (self._viewer.layers.events.inserted, self._viewer.layers.events.removed):
            event.disconnect(self._refresh)
        for layer in self._watched:
            layer.events.name.disconnect(self._refresh)
        self._watched = []

    def fitting(self) -> list[Any]:
        """Layers of the viewer that can be chosen: kinds in their order, the uppermost layer first.

        Images that hold other values than 0 and one more come last where labels fit too. Where a layer must
        be chosen, so do those that are called nuclei.
        """
        given = [
            one
            for one in reversed(self._viewer.layers)
            if layer_kind(one) in self._kinds and not is_result(one)
        ]
        return sorted(given, key=lambda one: (self._kinds.index(layer_kind(one)), self._is_doubtful(one)))

    def _is_doubtful(self, layer: Any) -> bool:
        """Whether a layer that could hold masks of cells looks like a signal, or is called nuclei."""
        if len(self._kinds) == 1:
            return False
        called_nuclei = not self._optional and _NUCLEI.search(layer.name) is not None
        return called_nuclei or (layer_kind(layer) == "image" and not looks_binary(layer))

    def _refresh(self, event: Any = None) -> None:
        before = self.layers
        fitting = self.fitting()
        for layer in self._watched:
            layer.events.name.disconnect(self._refresh)
        self._watched = fitting
        for layer in fitting:
            layer.events.name.connect(self._refresh)
        kept = tuple(one for one in before if any(one is other for other in fitting))
        if kept and not (self._by_hand or self._several or self._optional) and self._is_doubtful(kept[0]):
            kept = ()
        self._fill(kept or (() if self._optional or self._several else tuple(fitting[:1])))
        after = self.layers
        if len(before) != len(after) or any(a is not b for a, b in zip(before, after, strict=True)):
            self.changed.emit()

    def _fill(self, chosen: tuple[Any, ...]) -> None:
        self._list.blockSignals(True)
        self._list.clear()
        fitting = self.fitting()
        for layer in fitting if self._several else []:
            item = QListWidgetItem(_words(layer), self._list)
            item.setFlags(item.flags() | Qt.ItemFlag.ItemIsUserCheckable)
            on = any(layer is one for one in chosen)
            item.setCheckState(Qt.CheckState.Checked if on else Qt.CheckState.Unchecked)
        if self._several:
            self._offered = fitting
            self._list.setFixedHeight(_ROW * min(max(1, len(fitting)), 4) + 6)
        else:
            self._fill_combo(fitting, chosen)
        if not fitting and self._several:
            QListWidgetItem(self._nothing, self._list).setFlags(Qt.ItemFlag.NoItemFlags)
        self._list.blockSignals(False)

    def _fill_combo(self, fitting: list[Any], chosen: tuple[Any, ...]) -> None:
        if self._optional or not fitting:
            self._list.addItem("none" if fitting else self._nothing)
        for layer in fitting:
            self._list.addItem(_words(layer))
        self._offered = [None] * (self._list.count() - len(fitting)) + fitting
        rows = [row for row, one in enumerate(self._offered) if chosen and one is chosen[0]]
        self._list.setCurrentIndex(rows[0] if rows else 0)

    @property
    def _nothing(self) -> str:
        return f"no layer of {' or '.join(_WORDS.get(kind, kind) for kind in self._kinds)} is open"

    def _note_hand(self, *_: Any) -> None:
        self._by_hand = True

    def _chosen(self, *_: Any) -> None:
        self.changed.emit()


def _words(layer: Any) -> str:
    kind = "RGB picture" if is_picture(layer) else layer_kind(layer)
    return f"{layer.name}  ({kind})"
