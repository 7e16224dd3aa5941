"""Layers by depth in a run: what they need, and what they are in words."""

from itertools import pairwise

from cytodisk.errors import ParameterError
from cytodisk.scale import Scale
from cytodisk.windows.polar_windows import PolarGrid


def check_depths(grid: PolarGrid, scale: Scale) -> None:
    """Check that depths in µm can be found in the images of a run.

    Raises
    ------
    ParameterError
        The layers are by depth, and the pixel size is unknown.
    """
    if grid.depth_um is not None and scale.pixel_size_um is None:
        raise ParameterError(
            "depth_um (--depth-um) needs the pixel size: add pixel_size_um (--pixel-size), or use layers"
        )


def layer_borders(grid: PolarGrid) -> list[str]:
    """Borders of each layer by depth, as "0–0.5 µm" and "> 2 µm"; of other grids none.

    Parameters
    ----------
    grid : PolarGrid

    Returns
    -------
    list of str
        One a layer, empty for layers that have no depths of their own.
    """
    if grid.depth_um is None:
        return [""] * grid.layers
    borders = [f"{depth:g}" for depth in (0.0, *grid.depth_um)]
    in_cytoplasm = [*(f"{outer}–{inner} µm" for outer, inner in pairwise(borders)), f"> {borders[-1]} µm"]
    return in_cytoplasm + [""] * grid.nucleus_layers


def depth_words(grid: PolarGrid) -> str:
    """A grid of layers by depth in words, as "layers 0–0.5, 0.5–1 µm deep and the rest inside"."""
    borders = [f"{depth:g}" for depth in (0.0, *(grid.depth_um or ()))]
    layers = ", ".join(f"{outer}–{inner}" for outer, inner in pairwise(borders))
    if not grid.nucleus_layers:
        return f"layers {layers} µm deep and the rest inside, sectors {grid.sectors}"
    rest = f"the rest of the cytoplasm, nucleus_layers {grid.nucleus_layers}"
    return f"layers {layers} µm deep and {rest}, sectors {grid.sectors}"
