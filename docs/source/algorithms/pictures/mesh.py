import matplotlib.pyplot as plt

import cytodisk as cd

mask = cd.simulate.migrating(seed=0, size=0.6)
disk = cd.map_to_disk(mask)
figure, axes = plt.subplots(1, 2, figsize=(6.2, 2.6), width_ratios=(1.5, 1), layout="constrained")
for ax, linewidth in zip(axes, (0.1, 0.4), strict=True):
    ax.imshow(mask, cmap="Greys", alpha=0.25)
    cd.plot.draw_mesh(ax, disk.vertices_yx, disk.triangles, color="#0072B2", linewidth=linewidth)
    cd.plot.draw_outline(ax, disk, linewidth=0.8)
    ax.axis("off")
right = int(disk.outline_yx[:, 1].max())
axes[1].set(xlim=(right - 26, right + 3), ylim=(65, 40))
axes[0].set_title("the whole cell")
axes[1].set_title("its right side")
