"""The page of a study of single cells: a list to sort, and each cell in large."""
