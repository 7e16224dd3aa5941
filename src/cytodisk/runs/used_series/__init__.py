"""The part of a study's series that a command works on: frames, sectors, and what is regressed out."""
