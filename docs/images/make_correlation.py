"""Draw `correlation.png`: where a simulated signal follows the edge, and where, and when, that is found."""

import warnings
from pathlib import Path

from matplotlib.figure import Figure

import cytodisk as cd
from cytodisk.errors import StationarityWarning
from cytodisk.files import replacing
from cytodisk.plot.cell.cell_axes import frame_cell
from cytodisk.plot.cell.window_polygons import draw_windows
from cytodisk.plot.correlation.correlation_peaks import PeakMap
from cytodisk.plot.correlation.peak_maps import draw_peaks_on_cell
from cytodisk.plot.style import colour_bar, paper_style

WIDTH_PX, HEIGHT_PX, DPI = 1400, 420, 200
SECTORS = 60
FRAME = 30


def main() -> None:
    """Write the picture next to this file."""
    warnings.simplefilter("ignore", StationarityWarning)
    truth = cd.simulate.movie("fluctuating", seed=0, frames=60, speed_px=0.5, coupled=0.5)
    pixel = truth.pixel_size_um
    movie = cd.map_movie(truth.masks, pixel_size_um=pixel, frame_interval_s=truth.frame_interval_s)
    grid = cd.polar_windows(10, SECTORS)
    signal = cd.sample_movie(movie, grid, truth.signal)["mean"].sel(channel="edge")
    lags = cd.cross_correlate(signal, cd.edge_velocity(movie, SECTORS), max_lag=15, surrogates=1999)
    rows = cd.peak_correlation(lags).to_dataframe().reset_index().assign(cell=0)
    peaks = PeakMap.of(rows, grid)
    windows = grid.on(movie[FRAME])
    with paper_style():
        figure = Figure(figsize=(WIDTH_PX / DPI, HEIGHT_PX / DPI))
        lefts, width = (0.04, 0.36, 0.7), 0.2
        headings = ("the signal follows the edge here", "correlation, q < 0.05 framed", "and its lag")
        axes = []
        for left, heading in zip(lefts, headings, strict=True):
            axes.append(figure.add_axes((left, 0.12, width, 0.74)))
            figure.text(left + width / 2, 0.93, heading, ha="center", fontsize=8)
        draw_windows(axes[0], windows, color="0.8", linewidth=0.3)
        coupled = truth.boundary_yx[FRAME][truth.coupled > 0.5]
        axes[0].plot(coupled[:, 1], coupled[:, 0], ".", color="#b2182b", markersize=2)
        frame_cell(axes[0], movie[FRAME])
        shown = draw_peaks_on_cell(axes[1], peaks, windows)
        colour_bar(shown, figure.add_axes((0.565, 0.3, 0.008, 0.4)), "peak correlation")
        lag = draw_peaks_on_cell(axes[2], peaks, windows, "lag")
        colour_bar(lag, figure.add_axes((0.905, 0.3, 0.008, 0.4)), "lag", "s")
        with replacing(Path(__file__).with_name("correlation.png")) as temporary:
            figure.savefig(temporary, dpi=DPI, pil_kwargs={"optimize": True})


if __name__ == "__main__":
    main()
