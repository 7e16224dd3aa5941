import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

seeds = range(8)
masks = [cd.simulate.random_smooth(seed, radius=30) for seed in seeds]
masks += [cd.simulate.migrating(seed, size=0.5) for seed in seeds]
masks += [cd.simulate.random_spiky(seed, radius=22, spike_length=25) for seed in seeds]
masks += [cd.simulate.branching(seed, process_length=45) for seed in seeds]
score = cd.complexity_score(cd.shape_features(masks), seed=0)["complexity"].to_numpy()
chosen = score.argsort()[np.linspace(0, len(score) - 1, 8).astype(int)]
figure, axes = plt.subplots(1, 8, figsize=(6.4, 1.3), layout="constrained")
for ax, number in zip(axes, chosen, strict=True):
    ax.imshow(masks[number], cmap="Greys")
    ax.set_title(f"{score[number]:.1f}")
    ax.axis("off")
