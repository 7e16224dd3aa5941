"""
Activity maps: a signal in every window over time
=================================================

Time runs to the right, sectors go up, and each layer has its own map. A kymograph shows
a line; an activity map shows the whole cell.
"""

import matplotlib.pyplot as plt

import cytodisk as cd

truth = cd.simulate.movie("fluctuating", seed=0, frames=30)
movie = cd.map_movie(
    truth.masks,
    pixel_size_um=truth.pixel_size_um,
    frame_interval_s=truth.frame_interval_s,
)
activity = cd.sample_movie(movie, cd.polar_windows(layers=4, sectors=60), truth.signal)
print(activity["mean"].sizes)

# %%
# Top: edge velocity. Below: the signal in each layer. The simulated signal is bright
# where the edge has just moved, and only near the edge.
velocity = cd.edge_velocity(movie, sectors=60)
mean = activity["mean"].sel(channel="edge")
figure, axes = plt.subplots(5, 1, figsize=(5.6, 6.8), height_ratios=(1.8, 1, 1, 1, 1))
figure.subplots_adjust(hspace=0.35, top=0.96, bottom=0.08, right=0.84)
cd.plot.draw_layers(axes, mean, velocity)
plt.show()

# %%
# One frame, in the cell.
frame = 20
windows = cd.polar_windows(layers=4, sectors=60).on(movie[frame])
figure, axes = plt.subplots(1, 2, figsize=(5.6, 2.8), layout="constrained")
cd.plot.draw_cell(
    axes[0],
    truth.signal.isel(time=frame).sel(channel="edge"),
    movie[frame],
    cmap="viridis",
)
cd.plot.draw_window_means(axes[1], windows, mean.isel(time=frame))
plt.show()
