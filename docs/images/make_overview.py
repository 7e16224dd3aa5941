"""Draw `overview.png`: a simulated cell with its windows, the signal on its disk, and the window means."""

from pathlib import Path

from matplotlib.figure import Figure

from cytodisk.disk.mapping import map_to_disk
from cytodisk.files import replacing
from cytodisk.plot.cell.cell_axes import draw_cell
from cytodisk.plot.cell.disk_axes import draw_disk_image, draw_disk_means
from cytodisk.plot.cell.window_polygons import draw_window_means, draw_windows
from cytodisk.plot.style import SIGNAL_COLOURS, colour_bar, paper_style, signal_limits
from cytodisk.scale import Scale
from cytodisk.simulate import cell_with_signal
from cytodisk.windows.polar_windows import polar_windows
from cytodisk.windows.sample import sample

WIDTH_PX, HEIGHT_PX, DPI = 1400, 400, 200


def main() -> None:
    """Write the picture next to this file."""
    cell = cell_with_signal(seed=0)
    image, scale = cell.signal.sel(channel="edge"), Scale.of(cell.signal)
    disk = map_to_disk(cell.mask)
    windows = polar_windows(layers=8, sectors=48).on(disk)
    means = sample(windows, image)["mean"]
    limits = signal_limits(image, cell.mask)
    with paper_style():
        figure = Figure(figsize=(WIDTH_PX / DPI, HEIGHT_PX / DPI))
        headings = ("a cell and its windows", "its disk", "mean of each window", "the same in the cell")
        axes = []
        for left, heading in zip((0.01, 0.245, 0.475, 0.705), headings, strict=True):
            axes.append(figure.add_axes((left, 0.07, 0.2, 0.8)))
            figure.text(left + 0.1, 0.92, heading, ha="center", fontsize=8)
        drawn = draw_cell(axes[0], image, disk, scale=scale, cmap=SIGNAL_COLOURS, limits=limits)
        draw_windows(axes[0], windows, linewidth=0.2, alpha=0.7)
        draw_disk_image(axes[1], disk, image, limits=limits)
        draw_disk_means(axes[2], windows.grid, means, limits=limits)
        draw_window_means(axes[3], windows, means, scale=scale, limits=limits)
        bar = figure.add_axes((0.925, 0.2, 0.01, 0.54))
        colour_bar(drawn, bar, "signal at the edge", "a.u.", extend="both")
        with replacing(Path(__file__).with_name("overview.png")) as temporary:
            figure.savefig(temporary, dpi=DPI, pil_kwargs={"optimize": True})


if __name__ == "__main__":
    main()
