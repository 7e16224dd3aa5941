"""
See a signal on the disk
========================

On the disk all cells have the same shape. You can look at the signals of different
cells side by side, and average them.
"""

import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

# %%
# Four simulated cells of different shape. Their signal is bright at the edge, and
# brighter on the right.
masks = [
    cd.simulate.migrating(seed=1),
    cd.simulate.random_smooth(seed=2),
    cd.simulate.star(arms=5),
    cd.simulate.dumbbell(neck_width=16),
]
signals = [
    cd.simulate.ring_signal(mask, decay_px=8)
    + cd.simulate.linear_signal(mask.shape, (0, 1 / mask.shape[1]))
    for mask in masks
]
disks = [cd.map_to_disk(mask) for mask in masks]

figure, axes = plt.subplots(2, 4, figsize=(6.2, 3.2), layout="constrained")
for column, (disk, signal) in enumerate(zip(disks, signals, strict=True)):
    cd.plot.draw_cell(
        axes[0, column], signal, disk, cmap="viridis", scale=cd.Scale(0.16)
    )
    cd.plot.draw_disk_image(axes[1, column], disk, signal)
plt.show()

# %%
# The mean of the four cells at each pixel of the disk. ``disk.image`` gives an array
# that is NaN outside the disk.
images = [
    disk.image(signal, size=200) for disk, signal in zip(disks, signals, strict=True)
]
figure, ax = plt.subplots(figsize=(3.2, 2.6), layout="constrained")
shown = ax.imshow(np.mean(images, axis=0))
ax.set_title("mean of four cells")
ax.axis("off")
figure.colorbar(shown, label="mean signal (a.u.)")
plt.show()
