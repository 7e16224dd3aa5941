"""Windows on maps with a nucleus: the cytoplasm's, and the nucleus' own."""
