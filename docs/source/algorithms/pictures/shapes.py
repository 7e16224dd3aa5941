import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

masks = [
    cd.simulate.random_spiky(seed, radius=25, spikes=round(2 + 12 * step), spike_length=2 + 40 * step)
    for seed, step in enumerate(np.linspace(0, 1, 40))
]
score = cd.complexity_score(cd.shape_features(masks), seed=0)
figure, ax = plt.subplots(figsize=(5, 3), layout="constrained")
_, outlines = cd.plot.draw_shape_landscape(ax, score, masks)
figure.colorbar(outlines, label="complexity", shrink=0.8)
