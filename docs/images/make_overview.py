"""Draw `overview.png`: a simulated cell with its windows, the signal on its disk, and the window means."""

from pathlib import Path

from matplotlib.figure import Figure

from cytodisk.disk.mapping import map_to_disk
from cytodisk.files import replacing
from cytodisk.plot.cell import draw_cell, draw_window_means, draw_windows
from cytodisk.plot.disk import draw_disk_image, draw_disk_means
from cytodisk.plot.style import SIGNAL_COLOURS, paper_style, signal_limits
from cytodisk.simulate import cell_with_signal
from cytodisk.windows.grid import polar_windows
from cytodisk.windows.sample import sample

WIDTH_PX, HEIGHT_PX, DPI = 1400, 440, 200


def main() -> None:
    """Write the picture next to this file."""
    cell = cell_with_signal(seed=0)
    image, scale = cell.signal.sel(channel="edge"), cell.signal.attrs["pixel_size_um"]
    disk = map_to_disk(cell.mask)
    windows = polar_windows(layers=8, sectors=48).on(disk)
    means = sample(windows, image)["mean"]
    limits = signal_limits(image, cell.mask)
    with paper_style():
        figure = Figure(figsize=(WIDTH_PX / DPI, HEIGHT_PX / DPI))
        axes = [figure.add_axes((0.01 + 0.2475 * k, 0.09, 0.235, 0.78)) for k in range(4)]
        headings = ("a cell and its windows", "its disk", "mean of each window", "the same on the cell")
        for k, heading in enumerate(headings):
            figure.text(0.1275 + 0.2475 * k, 0.92, heading, ha="center", fontsize=8)
        draw_cell(axes[0], image, disk, pixel_size_um=scale, cmap=SIGNAL_COLOURS, limits=limits)
        draw_windows(axes[0], windows, linewidth=0.2, alpha=0.7)
        draw_disk_image(axes[1], disk, image, limits=limits)
        draw_disk_means(axes[2], windows.grid, means, limits=limits)
        draw_window_means(axes[3], windows, means, pixel_size_um=scale, limits=limits)
        with replacing(Path(__file__).with_name("overview.png")) as temporary:
            figure.savefig(temporary, dpi=DPI)


if __name__ == "__main__":
    main()
