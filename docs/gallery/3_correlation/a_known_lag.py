"""
Find a lag that is known
========================

In this simulated movie the signal follows the motion of the edge four frames later,
along half of the edge. Does the correlation show where, and with which lag?
"""

import warnings

import matplotlib.pyplot as plt

import cytodisk as cd

truth = cd.simulate.movie(
    "fluctuating", seed=0, frames=50, speed_px=0.5, coupled=0.5, lag_frames=4
)
movie = cd.map_movie(
    truth.masks,
    pixel_size_um=truth.pixel_size_um,
    frame_interval_s=truth.frame_interval_s,
)
grid = cd.polar_windows(layers=6, sectors=32)
signal = cd.sample_movie(movie, grid, truth.signal)["mean"].sel(channel="edge")
velocity = cd.edge_velocity(movie, sectors=32)

# %%
# Correlate each window's signal with the velocity of its sector, at each lag. Positive
# lag: the edge moves after the signal. Here the edge moves first, so the lag is
# negative. Surrogates of the velocity, with the same spectrum and random phases, show
# what chance gives.
warnings.simplefilter("ignore", cd.errors.StationarityWarning)
lags = cd.cross_correlate(signal, velocity, max_lag=15, surrogates=499, clusters=True)
peaks = cd.peak_correlation(lags)
significant = peaks["q"] < 0.05
print("lag of the simulation:", -truth.lag_frames, "frames")
counts = peaks["lag"].where(significant).sel(layer=0).to_series().value_counts()
print("significant windows of layer 0 by lag:", counts.to_dict())

# %%
# The mean of a layer has more power than a single window.
by_layer = cd.correlation_by_layer(lags)
figure, ax = plt.subplots(figsize=(5, 2.8), layout="constrained")
for layer, colour in ((0, "#0072B2"), (2, "#D55E00"), (5, "0.5")):
    ax.plot(
        by_layer["lag_s"],
        by_layer["correlation"].sel(layer=layer),
        color=colour,
        label=f"layer {layer}",
    )
threshold = float(by_layer["threshold"].sel(layer=0))
ax.axhspan(-threshold, threshold, color="0.93", zorder=0, label="chance (layer 0)")
ax.axvline(
    -truth.lag_frames * truth.frame_interval_s,
    color="0.15",
    linewidth=0.6,
    linestyle=":",
)
ax.set(xlabel="lag (s)", ylabel="mean correlation")
ax.legend(frameon=False)
plt.show()

# %%
# Neighbouring windows that agree at a lag have more power, too: they are a cluster. The
# cluster is real, its borders are not exact.
clusters = cd.correlation_clusters(lags)
for number in clusters["cluster"].to_numpy():
    one = clusters.sel(cluster=number)
    lag, size, p = (one[name].item() for name in ("lag", "size", "p"))
    print(f"cluster {number}: lag {lag}, {size} windows, p = {p:.3f}")

# %%
# The truth, the peak of each window, and its lag. Windows that are not significant are
# pale, clusters have a bold outline.
frame = 30
number = clusters["cluster"].where(clusters["member"]).min("cluster").fillna(0)
table = peaks.assign(cluster=number).to_dataframe().reset_index().assign(cell=0)
shown = cd.plot.PeakMap.of(table, grid)
windows = grid.on(movie[frame])
figure, axes = plt.subplots(1, 3, figsize=(6.4, 2.6), layout="constrained")
coupled = truth.boundary_yx[frame][truth.coupled > 0.5]
cd.plot.draw_windows(axes[0], windows, color="0.7")
axes[0].plot(coupled[:, 1], coupled[:, 0], ".", color="#b2182b", markersize=2)
cd.plot.frame_cell(axes[0], movie[frame])
axes[0].set_title("simulated here")
for ax, what, unit in ((axes[1], "correlation", None), (axes[2], "lag", "s")):
    drawn = cd.plot.draw_peaks_on_cell(ax, shown, windows, what)
    figure.colorbar(
        drawn, ax=ax, label=what if unit is None else f"{what} ({unit})", shrink=0.6
    )
plt.show()
