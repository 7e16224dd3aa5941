"""Draw `real_cell.png`: a real cell with its windows, its signal on the disk, and the mean of each window.

The image is field D7 of the Schwann cells in CytoDataFrame (cytomining, BSD-3-Clause). The script reads
`schwann_nuclei/D7_signal.tif` (DAPI, GFP, RFP) from the folder that the variable CYTODISK_DATA names.
"""

import os
from pathlib import Path

import numpy as np
import tifffile
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from PIL import Image
from scipy.ndimage import binary_opening
from skimage.filters import gaussian, threshold_otsu
from skimage.measure import label
from skimage.segmentation import watershed

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.disk.mapping import map_to_disk
from cytodisk.files import replacing
from cytodisk.plot.cell.disk_axes import disk_polygons, draw_disk_image, draw_disk_means, draw_disk_windows
from cytodisk.plot.cell.window_polygons import draw_windows
from cytodisk.plot.style import colour_bar, paper_style, signal_limits
from cytodisk.windows.polar_windows import polar_windows
from cytodisk.windows.sample import sample

IN_NUCLEUS_YX, MARGIN_PX = (180, 650), 8
LAYERS, SECTORS = 5, 24
SHOWN_WINDOWS = ((1, 22), (0, 6))
SHOWN_COLOURS = ("#0072b2", "#009e73")
COLOURS, LINES = "magma_r", "0.25"
REACH = 1.08
WIDTH_MM, HEIGHT_MM, DPI, PALETTE = 85.0, 35.0, 360, 256


def main() -> None:
    """Write the picture next to this file."""
    mask, image = real_cell(Path(os.environ["CYTODISK_DATA"]) / "schwann_nuclei" / "D7_signal.tif")
    disk = map_to_disk(mask)
    windows = polar_windows(layers=LAYERS, sectors=SECTORS).on(disk)
    means = sample(windows, image)["mean"]
    limits = signal_limits(image, mask)
    with paper_style():
        figure = Figure(figsize=(WIDTH_MM / 25.4, HEIGHT_MM / 25.4))
        axes = [figure.add_axes((left, 0.01, 0.29, 0.86)) for left in (0.0, 0.3, 0.6)]
        titles = ("cell, 5 × 24 windows", "signal on the disk", "mean of each window")
        for ax, title in zip(axes, titles, strict=True):
            figure.text(ax.get_position().x0 + 0.145, 0.92, title, ha="center", fontsize=6.5)
        drawn = axes[0].imshow(image, cmap=COLOURS, vmin=limits[0], vmax=limits[1])
        axes[0].set_axis_off()
        draw_windows(axes[0], windows, color=LINES, linewidth=0.25)
        draw_disk_image(axes[1], disk, image, cmap=COLOURS, limits=limits)
        draw_disk_windows(axes[1], windows.grid, color=LINES, linewidth=0.15)
        draw_disk_means(axes[2], windows.grid, means, cmap=COLOURS, limits=limits)
        cell_polygons = [polygon[:, ::-1] for polygon in windows.polygons()]
        for ax, polygons in zip(axes, (cell_polygons, *[disk_polygons(windows.grid)] * 2), strict=True):
            show_windows(ax, polygons)
        for ax in axes[1:]:
            ax.set(xlim=(-REACH, REACH), ylim=(REACH, -REACH))
            for text in list(ax.texts):
                text.remove()
        colour_bar(drawn, figure.add_axes((0.895, 0.16, 0.012, 0.56)), "GFP", "10⁴ a.u.", extend="both")
        with replacing(Path(__file__).with_name("real_cell.png")) as temporary:
            figure.savefig(temporary, dpi=DPI)
            with Image.open(temporary) as drawn_image:
                small = drawn_image.convert("RGB").quantize(PALETTE, dither=Image.Dither.NONE)
            small.save(temporary, "png", optimize=True)


def real_cell(path: Path) -> tuple[BoolArray, xr.DataArray]:
    """Mask of the cell around a nucleus, and its GFP image, cut out.

    RFP separates cells from background. A watershed of GFP, started in the nuclei, separates the cells.
    """
    raw = tifffile.imread(path).astype(np.float64)
    dapi, gfp, rfp = gaussian(np.log(raw), (0.0, 1.5, 1.5))
    nuclei = label(binary_opening(dapi > threshold_otsu(dapi), iterations=4))
    cells = watershed(-gfp, nuclei, mask=binary_opening(rfp > threshold_otsu(rfp), iterations=2))
    pieces = label(cells == cells[IN_NUCLEUS_YX])
    mask = pieces == pieces[IN_NUCLEUS_YX]
    cut = tuple(slice(max(at.min() - MARGIN_PX, 0), at.max() + MARGIN_PX) for at in np.nonzero(mask))
    return mask[cut], xr.DataArray(raw[(1, *cut)] / 1e4, dims=("y", "x"))


def show_windows(ax: Axes, polygons: list[FloatArray]) -> None:
    """Mark the same windows in each panel."""
    for (layer, sector), colour in zip(SHOWN_WINDOWS, SHOWN_COLOURS, strict=True):
        outline = polygons[layer * SECTORS + sector]
        ax.add_patch(Polygon(outline, fill=False, edgecolor=colour, linewidth=0.9, zorder=4))


if __name__ == "__main__":
    main()
