import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

mask = cd.simulate.migrating(seed=0, size=0.4)
disk = cd.map_to_disk(mask)
windows = cd.polar_windows(layers=4, sectors=24).on(disk)
figure, axes = plt.subplots(1, 2, figsize=(6.2, 2.8), width_ratios=(1.4, 1), layout="constrained")
colours = np.random.default_rng(1).permutation(windows.areas.size).astype(float)
labels = np.where(windows.labels < 0, np.nan, colours[windows.labels])
for ax in axes:
    ax.imshow(labels, cmap="Pastel1", interpolation="nearest")
    cd.plot.draw_windows(ax, windows, color="0.2", linewidth=0.5)
    ax.axis("off")
right = int(disk.outline_yx[:, 1].max())
top = int(disk.outline_yx[disk.outline_yx[:, 1].argmax(), 0]) - 8
lines = np.arange(-0.5, 200, 0.25)
axes[1].hlines(lines, 0, 200, color="0.75", linewidth=0.15)
axes[1].vlines(lines, 0, 200, color="0.75", linewidth=0.15)
axes[1].hlines(lines[::4], 0, 200, color="0.5", linewidth=0.3)
axes[1].vlines(lines[::4], 0, 200, color="0.5", linewidth=0.3)
axes[1].set(xlim=(right - 18, right + 2), ylim=(top + 17, top))
