"""Files to images, masks, labels and tracks; axes, channels, scale."""
