"""Series whose past predicts one another, with known gain."""
