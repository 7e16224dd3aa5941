"""Files as microscopes write them, and OME-Zarr: scenes with frames, channels and slices in z."""
