"""Commands of a study, on the folder of a batch."""
