"""The plugin of napari: thin, it analyses nothing; widgets run what the commands run."""
