"""
See a signal on the disk
========================

On the disk all cells have the same shape, so signals of different cells can be looked
at side by side, and averaged.
"""

import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

# %%
# Four simulated cells of different shape.
cells = [cd.simulate.cell_with_signal(seed=seed) for seed in range(4)]
disks = [cd.map_to_disk(cell.mask) for cell in cells]

figure, axes = plt.subplots(2, 4, figsize=(6.2, 3.2))
for column, (cell, disk) in enumerate(zip(cells, disks, strict=True)):
    edge = cell.signal.sel(channel="edge")
    cd.plot.draw_cell(axes[0, column], edge, disk, cmap="viridis", pixel_size_um=0.16)
    cd.plot.draw_disk_image(axes[1, column], disk, edge)
plt.show()

# %%
# Their mean, pixel by pixel of the disk: the front is bright in all of them.
# ``disk.image`` is an array, NaN outside of the disk.
images = [
    disk.image(cell.signal.sel(channel="edge"), size=200)
    for cell, disk in zip(cells, disks, strict=True)
]
figure, ax = plt.subplots(figsize=(3.2, 2.6))
shown = ax.imshow(np.mean(images, axis=0))
ax.set_title("mean of four cells")
ax.axis("off")
figure.colorbar(shown, label="mean signal (a.u.)")
plt.show()
