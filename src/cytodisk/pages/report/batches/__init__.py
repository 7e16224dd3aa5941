"""The page of a batch: its inputs and cells, with links to the pages of the studies."""
