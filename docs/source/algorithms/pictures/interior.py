import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

truth = cd.simulate.movie("lamellipodium", frames=21, radius_px=35.0, signals=False)
grid = cd.polar_windows(layers=4, sectors=16)
area, still = (cd.map_movie(truth.masks, interior=interior) for interior in ("area", "still"))
stands = np.random.default_rng(2).permutation(truth.interior_yx[0])[:60]
rows, columns = np.nonzero(truth.masks.any(axis=0))
left, right, top, bottom = columns.min() - 3, columns.max() + 3, rows.min() - 3, rows.max() + 3
figure, axes = plt.subplots(1, 3, figsize=(6.2, 2.7), layout="constrained")
shown = [(area[0], "frame 0"), (area[20], 'frame 20, "area"'), (still[20], 'frame 20, "still"')]
for ax, (disk, title) in zip(axes, shown, strict=True):
    for polygon in grid.on(disk).polygons():
        ax.fill(*polygon.T[::-1], facecolor="0.93", edgecolor="0.55", linewidth=0.5)
    there = disk.to_cell(area[0].to_disk(stands))
    for start, stop in zip(stands, there, strict=True):
        ax.plot([start[1], stop[1]], [start[0], stop[0]], color="#D55E00", linewidth=0.7)
    ax.plot(there[:, 1], there[:, 0], ".", color="#D55E00", markersize=4)
    ax.plot(stands[:, 1], stands[:, 0], ".", color="0.1", markersize=2)
    ax.set(aspect="equal", title=title, xlim=(left, right), ylim=(bottom, top))
    ax.axis("off")
axes[0].plot([right - 24, right - 4], [bottom - 4] * 2, color="0.1", linewidth=2)
axes[0].text(right - 14, bottom - 6, "20 px", ha="center", va="bottom", fontsize=7)
