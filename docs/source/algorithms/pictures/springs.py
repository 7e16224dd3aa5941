import matplotlib.pyplot as plt

import cytodisk as cd
from cytodisk.plot.cell.window_labels import draw_label_image

mask = cd.simulate.random_spiky(3, radius=60)
layers, sectors = 6, 40
figure, axes = plt.subplots(1, 3, figsize=(4.6, 1.8), layout="constrained")
for ax, evenness in zip(axes, (0.0, 1.0, 4.0), strict=True):
    windows = cd.spring_windows(mask, layers, sectors, evenness=evenness)
    draw_label_image(ax, windows.labels, windows.mask, (layers, sectors))
    ax.set_axis_off()
    empty = (windows.areas == 0).mean()
    ax.set_title(f"evenness {evenness:g}: {empty:.0%} empty", fontsize=7)
