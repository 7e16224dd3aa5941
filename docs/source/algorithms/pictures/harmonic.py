import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

disk = cd.map_to_disk(cd.simulate.star(arms=5), method="harmonic")
figure, axes = plt.subplots(1, 2, figsize=(5.6, 2.8), layout="constrained")
angles = np.linspace(0, 2 * np.pi, 400)
for radius in np.linspace(0.1, 0.9, 9):
    circle = radius * np.column_stack([np.cos(angles), np.sin(angles)])
    line = disk.to_cell(circle)
    axes[0].plot(line[:, 1], line[:, 0], color="#0072B2", linewidth=0.6)
    axes[1].plot(*circle.T, color="#0072B2", linewidth=0.6)
for angle in np.arange(0, 2 * np.pi, np.pi / 20):
    ray = np.linspace(0, 0.999, 200)[:, None] * [np.cos(angle), np.sin(angle)]
    line = disk.to_cell(ray)
    axes[0].plot(line[:, 1], line[:, 0], color="#D55E00", linewidth=0.4)
    axes[1].plot(*ray.T, color="#D55E00", linewidth=0.4)
cd.plot.draw_outline(axes[0], disk, linewidth=0.8)
axes[1].add_patch(plt.Circle((0, 0), 1, fill=False, linewidth=0.8))
for ax in axes:
    ax.set_aspect("equal")
    ax.autoscale_view()
    ax.invert_yaxis()
    ax.axis("off")
