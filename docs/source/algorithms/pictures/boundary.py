import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

disk = cd.map_to_disk(cd.simulate.migrating(seed=0))
outline_uv = disk.vertices_uv[disk.boundary]
turn = np.mod(np.arctan2(outline_uv[:, 1], outline_uv[:, 0]), 2 * np.pi)
figure, axes = plt.subplots(1, 3, figsize=(7.4, 2.6), width_ratios=(1.2, 0.9, 1.3), layout="constrained")
axes[0].scatter(disk.outline_yx[:, 1], disk.outline_yx[:, 0], c=turn, cmap="twilight", s=4)
shown = axes[1].scatter(*outline_uv.T, c=turn, cmap="twilight", s=4)
even = np.arange(24) * np.pi / 12
rim = np.column_stack([np.cos(even), np.sin(even)])
places = disk.to_cell(rim * (1 - 1e-9))
axes[0].plot(places[:, 1], places[:, 0], "o", mfc="white", mec="0.15", markersize=4)
axes[1].plot(*rim.T, "o", mfc="white", mec="0.15", markersize=4)
for ax, x, y in ((axes[0], places[0, 1], places[0, 0]), (axes[1], 1, 0)):
    ax.annotate("0°", (x, y), xytext=(6, 0), textcoords="offset points", va="center")
figure.colorbar(
    shown, ax=axes[:2], label="angle on the disk", ticks=np.arange(5) * np.pi / 2, shrink=0.7
).set_ticklabels(["0°", "90°", "180°", "270°", "360°"])

mask = cd.simulate.disk(18.0, margin=22)
middle = mask.shape[0] // 2
column = middle + 5
top = int(mask[:, column].argmax())
mask[top - 3 : top, column] = True  # a spike of one pixel
mask[middle - 1 : middle + 2, middle : middle + 38] = True  # a thin protrusion
cell = cd.map_to_disk(mask)
even = np.arange(60) * np.pi / 30
marks = cell.to_cell(np.column_stack([np.cos(even), np.sin(even)]) * (1 - 1e-9))
outline = np.concatenate([cell.outline_yx, cell.outline_yx[:1]])
axes[2].imshow(mask, cmap="Greys", vmin=0, vmax=4)
axes[2].plot(outline[:, 1], outline[:, 0], color="0.5", linewidth=0.8)
axes[2].plot(marks[:, 1], marks[:, 0], "o", color="tab:red", markersize=3)
axes[2].set(xlim=(middle - 20, middle + 40), ylim=(middle + 20, middle - 23))
axes[2].annotate(
    "spike of 1 px",
    (column + 0.7, top - 2),
    (column + 6, top - 3),
    va="center",
    arrowprops={"arrowstyle": "-"},
)
axes[2].text(middle + 28, middle + 5, "protrusion\nof 3 px", ha="center", va="top")
axes[2].text(middle, middle, "60 sectors", ha="center", va="center")
for ax in axes:
    ax.set_aspect("equal")
    ax.axis("off")
for ax in axes[:2]:
    ax.invert_yaxis()
