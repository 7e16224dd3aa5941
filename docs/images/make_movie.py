"""Draw `movie.png`: a simulated cell's outlines through time, its edge velocity, and its edge's signal."""

from pathlib import Path

from matplotlib.figure import Figure

import cytodisk as cd
from cytodisk.files import replacing
from cytodisk.plot.movie.activity_maps import draw_activity_map, draw_velocity_map
from cytodisk.plot.movie.edge_motion import draw_tracks
from cytodisk.plot.style import paper_style

WIDTH_PX, HEIGHT_PX, DPI = 1400, 420, 200
SECTORS = 60


def main() -> None:
    """Write the picture next to this file."""
    truth = cd.simulate.movie("migrating", seed=0, frames=40)
    movie = cd.map_movie(
        truth.masks, pixel_size_um=truth.pixel_size_um, frame_interval_s=truth.frame_interval_s
    )
    velocity = cd.edge_velocity(movie, SECTORS)
    activity = cd.sample_movie(movie, cd.polar_windows(10, SECTORS), truth.signal)
    edge = activity["mean"].sel(channel="edge", layer=0)
    with paper_style():
        figure = Figure(figsize=(WIDTH_PX / DPI, HEIGHT_PX / DPI))
        headings = ("a cell crawls", "edge velocity", "signal in the outermost windows")
        axes = []
        for left, width, heading in zip((0.0, 0.355, 0.71), (0.235, 0.19, 0.19), headings, strict=True):
            axes.append(figure.add_axes((left, 0.19, width, 0.68)))
            figure.text(left + width / 2, 0.93, heading, ha="center", fontsize=8)
        draw_tracks(axes[0], movie.points_yx, every=2, scale=movie.scale)
        draw_velocity_map(axes[1], velocity)
        draw_activity_map(axes[2], edge)
        axes[1].set_ylabel("sector")
        axes[2].set_ylabel("")
        with replacing(Path(__file__).with_name("movie.png")) as temporary:
            figure.savefig(temporary, dpi=DPI, pil_kwargs={"optimize": True})


if __name__ == "__main__":
    main()
