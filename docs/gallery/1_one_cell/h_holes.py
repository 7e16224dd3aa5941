"""
Leave holes out of a cell
=========================

A vacuole or a bead is no part of the cell. With ``holes="exclude"`` the cell is mapped
as if its mask had no hole, and the pixels in the hole belong to no window. See
:doc:`/guides/holes`.
"""

import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

# %%
# A cell whose signal is bright at the edge, with two dark vacuoles. The mask leaves
# these out.
mask = cd.simulate.random_smooth(seed=2)
signal = cd.simulate.ring_signal(mask, peak=100.0, decay_px=40)
row, column = np.indices(mask.shape)
for centre, radius in (((85, 95), 18), ((110, 66), 8)):
    vacuole = np.hypot(row - centre[0], column - centre[1]) < radius
    mask[vacuole], signal[vacuole] = False, 0.0

filled = cd.map_to_disk(mask)
disk = cd.map_to_disk(mask, holes="exclude")
print(*filled.report.notes, *disk.report.notes, sep="\n")

# %%
# Filled, the windows around the vacuoles seem dim: their mean counts the dark pixels.
# Without the holes they are as bright as their neighbours, and windows that lie wholly
# in a hole have no mean.
grid = cd.polar_windows(layers=8, sectors=36)
figure, axes = plt.subplots(1, 4, figsize=(6.8, 1.9), layout="constrained")
cd.plot.draw_cell(axes[0], signal, disk, cmap="viridis", scale=cd.Scale(0.16))
for ax, cell in zip(axes[1:], (filled, disk), strict=False):
    windows = grid.on(cell)
    means = cd.sample(windows, signal)["mean"]
    cd.plot.draw_window_means(ax, windows, means, scale=cd.Scale(0.16), limits=(0, 100))
    print("empty windows:", windows.n_empty, "; coverage:", round(windows.coverage, 3))
cd.plot.draw_disk_image(axes[3], disk, signal)
for ax, title in zip(axes, ("cell", "filled", "excluded", "on the disk"), strict=True):
    ax.set_title(title)
plt.show()
