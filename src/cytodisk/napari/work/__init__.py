"""Work beside the viewer: in a thread, with progress and a button that cancels."""
