import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

truth = cd.simulate.movie("neutrophil", seed=0, frames=5)
figure, axes = plt.subplots(1, 2, figsize=(6, 3), layout="constrained")
for ax, tracker in zip(axes, ("matching", "demons"), strict=True):
    movie = cd.map_movie(truth.masks[[0, 4]], tracker=tracker)
    first, last = movie.points_yx
    for points, colour in ((first, "0.6"), (last, "0.1")):
        closed = np.concatenate([points, points[:1]])
        ax.plot(closed[:, 1], closed[:, 0], color=colour, linewidth=0.8)
    for start, stop in zip(first[::4], last[::4], strict=True):
        ax.plot([start[1], stop[1]], [start[0], stop[0]], color="#D55E00", linewidth=0.6)
    ax.set(aspect="equal", title=f'"{tracker}"')
    ax.invert_yaxis()
    ax.axis("off")
