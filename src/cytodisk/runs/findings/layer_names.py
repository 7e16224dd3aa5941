"""Layers in words."""

from __future__ import annotations

from cytodisk.runs.channel_names import shown_name
from cytodisk.runs.depth_layers import layer_borders
from cytodisk.store.study import Study
from cytodisk.windows.study_grid import polar_grid_of


def layer_name(study: Study, layer: int) -> str:
    """A layer with what it is, as "layer 0 (outermost)", "layer 1 (0.5–1 µm)" or "layer 9 (nucleus)"."""
    grid = polar_grid_of(study.provenance)
    outside = grid.layers - grid.nucleus_layers
    what = layer_borders(grid)[layer] or ("outermost" if not layer else "nucleus" if layer >= outside else "")
    return f"layer {layer} ({what})" if what else f"layer {layer}"


def channel_words(name: str) -> str:
    """A channel's name in a sentence, as "Rac1"; one that may be taken for a word as "signal 'edge'"."""
    shown = shown_name(name)
    return f"signal '{shown}'" if shown.islower() and " " not in shown else shown


def numbers_words(name: str, numbers: list[int]) -> str:
    """Numbers with the name of what they count, as "layer 1", "layers 1–3" or "clusters 1, 2 and 5"."""
    ordered = sorted(numbers)
    if len(ordered) == 1:
        return f"{name} {ordered[0]}"
    if ordered == list(range(ordered[0], ordered[-1] + 1)) and len(ordered) > 2:
        return f"{name}s {ordered[0]}–{ordered[-1]}"
    return f"{name}s {', '.join(map(str, ordered[:-1]))} and {ordered[-1]}"
