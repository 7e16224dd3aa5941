"""Formats of image files: one module knows each, and gives its frames as the same kind of `FrameFile`."""
