"""Read images and masks; write and read a study folder."""
