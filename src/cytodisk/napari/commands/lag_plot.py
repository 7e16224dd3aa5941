"""A small picture of correlation against lag, by layer."""

from __future__ import annotations

from typing import Any

from matplotlib.backends.backend_qtagg import FigureCanvasQTAgg
from matplotlib.figure import Figure
from qtpy.QtWidgets import QComboBox, QVBoxLayout, QWidget

from cytodisk.plot.correlation.lag_curves import draw_lag_curves
from cytodisk.store.correlation_store import Correlation

_HEIGHT = 190  # px
_FONT = 7.5  # pt


class LagPlot(QWidget):
    """Curves of the layers of one cell; nothing is seen before there are any."""

    def __init__(self) -> None:
        super().__init__()
        self.figure = Figure(layout="constrained")
        self.canvas: Any = FigureCanvasQTAgg(self.figure)  # type: ignore[no-untyped-call]
        self.canvas.setFixedHeight(_HEIGHT)
        self.cell = QComboBox()
        self.cell.setAccessibleName("Cell of the curves")
        self.cell.currentIndexChanged.connect(lambda _: self._draw())
        self._found: Correlation | None = None
        self._cells: list[int] = []
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(self.cell)
        layout.addWidget(self.canvas)
        self.hide()

    def show_curves(self, found: Correlation, cells: list[int]) -> None:
        """Show the curves of a correlation, of the first of some cells."""
        self._found = None
        self.cell.clear()
        for cell in cells:
            self.cell.addItem(f"cell {cell}")
        self._cells = cells
        self.cell.setVisible(len(cells) > 1)
        self._found = found
        self._draw()
        self.show()

    def _draw(self) -> None:
        if self._found is None or self.cell.currentIndex() < 0:
            return
        found, cell = self._found, self._cells[self.cell.currentIndex()]
        self.figure.clear()
        ax = self.figure.add_subplot()
        lines = draw_lag_curves(ax, found.layer_curves, cell=cell, signal=found.signal, with_=found.with_)
        ax.tick_params(labelsize=_FONT)
        for label in (ax.xaxis.label, ax.yaxis.label):
            label.set_fontsize(_FONT)
        names = [str(line.get_label()).removeprefix("layer ") for line in lines]
        self.figure.legend(
            lines,
            names,
            title="layer",
            title_fontsize=_FONT,
            fontsize=_FONT,
            frameon=False,
            loc="outside right upper",
            handlelength=0.8,
            handletextpad=0.4,
            borderpad=0.0,
        )
        self.canvas.draw_idle()
