"""
Divide a cell into windows and measure a signal
===============================================

A window is where a ring and a wedge of the disk meet, carried back into the cell. No
window is ever empty. Together the windows are the cell: their areas and intensities sum
to those of the cell.
"""

import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

cell = cd.simulate.cell_with_signal(seed=0)
edge = cell.signal.sel(channel="edge")
disk = cd.map_to_disk(cell.mask)

# %%
# You make a grid once and put it on any cell. Layer 0 is at the edge; sector 0 starts
# at angle 0.
grid = cd.polar_windows(layers=8, sectors=48)
windows = grid.on(disk)
data = cd.sample(windows, cell.signal)
print(data)

# %%
# The mean of each window, on the disk and in the cell.
figure, axes = plt.subplots(
    1, 3, figsize=(6.2, 2.2), width_ratios=(1.5, 1, 1.5), layout="constrained"
)
cd.plot.draw_cell(axes[0], edge, disk, scale=cd.Scale(0.16), cmap="viridis")
cd.plot.draw_windows(axes[0], windows)
cd.plot.draw_disk_means(axes[1], grid, data["mean"].sel(channel="edge"))
cd.plot.draw_window_means(
    axes[2], windows, data["mean"].sel(channel="edge"), scale=cd.Scale(0.16)
)
for ax, title in zip(
    axes, ("signal and windows", "means on the disk", "means in the cell"), strict=True
):
    ax.set_title(title)
plt.show()

# %%
# Nothing is lost
# ---------------
# Each pixel is divided among windows, so the windows sum to the cell.
total = float((data["mean"] * data["n_pixels"]).sel(channel="edge").sum())
print("area:", windows.areas.sum(), "px²; of the mask:", cell.mask.sum())
print(
    "intensity:",
    round(total, 3),
    "; of the cell:",
    int(edge.to_numpy()[cell.mask].sum()),
)
print("empty windows:", int((windows.areas == 0).sum()))

# %%
# Equal areas or equal radii
# --------------------------
# With ``spacing="area"``, the default, all windows have nearly the same area.
# ``"radius"`` makes rings of equal width, as the paper does: outer windows are then
# large and inner windows small.
figure, axes = plt.subplots(1, 2, figsize=(6.2, 2.6), layout="constrained")
for ax, spacing in zip(axes, ("area", "radius"), strict=True):
    laid = cd.polar_windows(8, 48, spacing).on(disk)
    cd.plot.draw_windows(ax, laid, by_layer=True)
    cd.plot.frame_cell(ax, disk, scale=cd.Scale(0.16))
    ax.set_title(f"{spacing}: {laid.areas.min():.0f} to {laid.areas.max():.0f} px²")
plt.show()

# %%
# By layer
# --------
# The simulated signal is bright at the edge. The layers show how deep it reaches.
by_layer = data["mean"].sel(channel="edge").mean("sector")
figure, ax = plt.subplots(figsize=(4, 2.4), layout="constrained")
ax.plot(np.arange(8), by_layer, "o-", color="0.15")
ax.set(xlabel="layer (0 at the edge)", ylabel="mean signal (a.u.)")
plt.show()
