"""
A movie with a nucleus
======================

The nuclear outline is followed as the membrane is. The cell is the frame of reference;
a nucleus that turns in its cell keeps its places.
"""

import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

truth = cd.simulate.movie_with_nuclei(
    "migrating",
    seed=1,
    frames=9,
    radius_px=35.0,
    nucleus_elongation=1.6,
    nucleus_turn_deg=8.0,
    nucleus_missing=0.12,
    signals=False,
)
print("frames without a nucleus:", np.flatnonzero(~truth.nucleus_present))

# %%
# ``missing="hold"`` takes the nucleus of the frame before where there is none, moved
# with the cell, and says so. Without it these frames are gaps.
movie = cd.map_movie(truth.masks, nuclei=truth.nuclei, missing="hold")
print(movie.status)
for frame, words in enumerate(movie.nucleus_held):
    if words:
        print(f"frame {frame}: {words}")

# %%
# Followed through the movie
# --------------------------
# A dot is a tracked point of the membrane or of the nuclear outline, and keeps its
# color. The nucleus turns by 8° a frame: its dots turn with it, and sectors (lines) are
# sheared between the outlines.
grid = cd.polar_windows(layers=6, sectors=12, nucleus_layers=2)
shown = (0, 4, 8)
figure, axes = plt.subplots(1, 3, figsize=(6.6, 2.6), layout="constrained")
for ax, frame in zip(axes, shown, strict=True):
    cd.plot.draw_windows(ax, grid.on(movie[frame]), by_layer=True)
    for points in (movie.points_yx[frame], movie.nucleus_points_yx[frame]):
        some = points[:: len(points) // 8][:8]
        ax.scatter(*some.T[::-1], c=np.arange(8), cmap="hsv", vmax=8, s=12, zorder=5)
    cd.plot.draw_outline(ax, movie[frame])
    cd.plot.frame_cell(ax, movie[frame])
    ax.set_title(f"frame {frame}")
plt.show()
