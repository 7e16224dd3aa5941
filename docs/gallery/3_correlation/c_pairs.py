"""
How far a correlation reaches
=============================

Correlate every window of one signal with every window of another, by their distance and
by the lag. This shows how far apart two positions still correlate.
"""

import warnings

import matplotlib.pyplot as plt

import cytodisk as cd

warnings.simplefilter("ignore", cd.errors.StationarityWarning)
truth = cd.simulate.movie("ruffling", seed=0, frames=36)
movie = cd.map_movie(
    truth.masks,
    pixel_size_um=truth.pixel_size_um,
    frame_interval_s=truth.frame_interval_s,
    registration=False,  # waves around a cell look like a rotation
)
grid = cd.polar_windows(layers=4, sectors=32)
signal = cd.sample_movie(movie, grid, truth.signal)["mean"].sel(channel="edge")

# %%
# Distances between windows: straight, inside the cell, or along its edge.
distances = cd.window_distances(movie, grid)
pairs = cd.correlate_pairs(
    signal, signal, max_lag=12, distances=distances["edge"], bins=14
)
print(pairs)

# %%
# Waves run around the edge of this cell. Over all pairs, both directions look the same.
# Two positions that are a wavelength apart along the edge, about 18 µm, rise and fall
# at the same time; 40 s later it is the opposite.
figure, ax = plt.subplots(figsize=(5.4, 3), layout="constrained")
limit = float(abs(pairs["correlation"]).max())
shown = ax.pcolormesh(
    pairs["lag_s"],
    pairs["distance"],
    pairs["correlation"],
    cmap="RdBu_r",
    vmin=-limit,
    vmax=limit,
)
ax.set(xlabel="lag (s)", ylabel="distance along the edge (µm)")
figure.colorbar(shown, label="mean correlation")
plt.show()
