"""
Windows on the disk against windows along the edge
==================================================

The usual method divides a cell by distance from its edge: bands of equal depth, divided
by the nearest point of the edge. Such windows are regular at the edge and run out
inside. Springs between them make them more alike. You use these windows, windows on the
disk, and rings as in CellProfiler in the same way, so you can compare them on any cell.
"""

import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

mask = cd.simulate.random_spiky(seed=2)
disk = cd.map_to_disk(mask)
layers, sectors = 6, 40
kinds = {
    "disk": cd.polar_windows(layers, sectors).on(disk),
    "edge": cd.edge_windows(disk, layers, sectors),
    "springs": cd.spring_windows(disk, layers, sectors),
    "rings": cd.ring_windows(disk, layers, sectors),
}

# %%
# The windows of each kind in colours at random. What is white lies in no window.
order = np.random.default_rng(0).permutation(layers * sectors)
figure, axes = plt.subplots(2, 2, figsize=(4.6, 4.6), layout="constrained")
for ax, (name, windows) in zip(axes.flat, kinds.items(), strict=True):
    inside = windows.labels >= 0
    shown = np.where(inside, order[windows.labels], np.nan)
    ax.imshow(shown, cmap="Set3", interpolation="nearest")
    cd.plot.draw_outline(ax, disk)
    cd.plot.frame_cell(ax, disk)
    empty = (windows.areas == 0).mean()
    ax.set_title(f"{name}: {empty:.0%} of windows empty", fontsize=8)
plt.show()

# %%
# By layer, from the edge inwards: the share of windows that hold any pixel, and how
# much the areas of those differ (standard deviation over mean).
figure, axes = plt.subplots(1, 2, figsize=(6.2, 2.4), layout="constrained")
styles = {"disk": "o-", "edge": "s--", "springs": "d-.", "rings": "^:"}
for name, windows in kinds.items():
    measures = cd.measures_by_layer(windows)
    axes[0].plot(100 * measures["completeness"], styles[name], markersize=3, label=name)
    axes[1].plot(measures["area_cv"], styles[name], markersize=3, label=name)
axes[0].set(xlabel="layer", ylabel="windows with signal (%)", ylim=(0, 105))
axes[1].set(xlabel="layer", ylabel="variation of area")
axes[1].legend(frameon=False)
plt.show()

# %%
# ``window_measures`` gives the area, the eccentricity and the number of pieces of every
# window. It counts pieces on pixels. A window of the disk is in one piece; but where it
# is thinner than a pixel, its pixels may not touch.
for name, windows in kinds.items():
    measures = cd.window_measures(windows)
    pieces = measures["pieces"].to_numpy()
    share = (pieces == 1).sum() / (pieces > 0).sum()
    coverage = measures.attrs["coverage"]
    print(f"{name:7s}: {coverage:.0%} of the cell, {share:.0%} of windows in one piece")
