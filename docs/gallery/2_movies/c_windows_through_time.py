"""
Do windows keep their position?
===============================

The paper asks two things of windows that follow a cell. The signal in a window should
be similar to that in the next frame, and windows should not jump. You can measure both
on any movie.
"""

import matplotlib.pyplot as plt

import cytodisk as cd

truth = cd.simulate.movie("neutrophil", seed=0, frames=24)
movie = cd.map_movie(
    truth.masks,
    pixel_size_um=truth.pixel_size_um,
    frame_interval_s=truth.frame_interval_s,
)
grid = cd.polar_windows(layers=6, sectors=36)

# %%
# A cell that changes its whole shape. Each colour is a sector: the same colour is the
# same piece of the edge.
frames = [0, 8, 16, 23]
figure, axes = plt.subplots(1, 4, figsize=(6.2, 2.4), layout="constrained")
cd.plot.draw_strip(
    axes,
    [grid.on(movie[frame]) for frame in frames],
    [f"{frame * movie.scale.frame_interval_s:g} s" for frame in frames],
)
plt.show()

# %%
# How similar consecutive frames are, by layer, and how far windows move after the rigid
# motion of the cell is removed. A window that is lost for one frame would make a peak.
activity = cd.sample_movie(movie, grid, truth.signal)
alike = cd.consecutive_correlation(activity["mean"].sel(channel="material"))
moved = cd.centroid_displacement(movie, activity)
layers = [0, 2, 4]
figure, axes = plt.subplots(2, 1, figsize=(5, 4), sharex=True, layout="constrained")
for ax, values, label in (
    (axes[0], alike, "correlation with the\nnext frame"),
    (axes[1], moved.mean("sector", keep_attrs=True), "mean displacement\n"),
):
    lines = cd.plot.draw_by_layer(ax, values, layers, label, scale=movie.scale)
axes[1].legend(lines, [f"layer {layer}" for layer in layers], frameon=False)
plt.show()
