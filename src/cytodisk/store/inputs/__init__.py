"""The files that a study was made from: which they are, and whether they hold what was measured."""
