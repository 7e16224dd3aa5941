import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

disk = cd.map_to_disk(cd.simulate.migrating(seed=0))
outline_uv = disk.vertices_uv[disk.boundary]
turn = np.mod(np.arctan2(outline_uv[:, 1], outline_uv[:, 0]), 2 * np.pi)
figure, axes = plt.subplots(1, 2, figsize=(6.2, 2.7), width_ratios=(1.5, 1), layout="constrained")
axes[0].scatter(disk.outline_yx[:, 1], disk.outline_yx[:, 0], c=turn, cmap="twilight", s=4)
shown = axes[1].scatter(*outline_uv.T, c=turn, cmap="twilight", s=4)
even = np.arange(24) * np.pi / 12
rim = np.column_stack([np.cos(even), np.sin(even)])
places = disk.to_cell(rim * (1 - 1e-9))
axes[0].plot(places[:, 1], places[:, 0], "o", mfc="white", mec="0.15", markersize=4)
axes[1].plot(*rim.T, "o", mfc="white", mec="0.15", markersize=4)
for ax, x, y in ((axes[0], places[0, 1], places[0, 0]), (axes[1], 1, 0)):
    ax.annotate("0°", (x, y), xytext=(6, 0), textcoords="offset points", va="center")
    ax.set_aspect("equal")
    ax.invert_yaxis()
    ax.axis("off")
figure.colorbar(
    shown, ax=axes, label="angle on the disk", ticks=np.arange(5) * np.pi / 2, shrink=0.7
).set_ticklabels(["0°", "90°", "180°", "270°", "360°"])
