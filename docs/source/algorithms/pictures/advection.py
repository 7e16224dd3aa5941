import matplotlib.pyplot as plt
from matplotlib.collections import PolyCollection

import cytodisk as cd

mask = cd.simulate.star(arms=5, body_radius=14, arm_length=24, arm_width=6)
grid = cd.polar_windows(layers=6, sectors=30)
figure, axes = plt.subplots(1, 3, figsize=(6.4, 3), layout="constrained")
for ax, method in zip(axes, ("harmonic", "advection", "newton"), strict=True):
    disk = cd.map_to_disk(mask, method=method)
    cd.plot.draw_windows(ax, grid.on(disk), by_layer=True)
    flipped = disk.triangles[list(disk.certificate.flipped_in_disk)]
    ax.add_collection(PolyCollection(disk.vertices_yx[flipped][..., ::-1], color="#D55E00", zorder=3))
    cd.plot.frame_cell(ax, disk)
    ax.set_title(f"{method}: area distortion {disk.distortion.area:.2f}\nturned over: {len(flipped)}")
