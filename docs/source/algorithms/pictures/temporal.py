import matplotlib.pyplot as plt

import cytodisk as cd

truth = cd.simulate.movie("neutrophil", seed=0, frames=17)
movie = cd.map_movie(truth.masks)
grid = cd.polar_windows(layers=5, sectors=24)
frames = (0, 8, 16)
figure, axes = plt.subplots(1, 3, figsize=(6.2, 2.6), layout="constrained")
cd.plot.draw_strip(axes, [grid.on(movie[frame]) for frame in frames], [f"frame {frame}" for frame in frames])
