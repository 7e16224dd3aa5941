"""A grid of windows in words, for headings."""

from cytodisk.windows.polar_layout import PolarLayout


def grid_words(grid: PolarLayout) -> str:
    """Layers and sectors, as "8 layers × 60 sectors" or "8 + 3 layers (cytoplasm + nucleus) × 60 sectors"."""
    if not grid.nucleus_layers:
        return f"{grid.layers} layers × {grid.sectors} sectors"
    layers = f"{grid.cytoplasm_layers} + {grid.nucleus_layers} layers (cytoplasm + nucleus)"
    return f"{layers} × {grid.sectors} sectors"
