"""Whether the past of one signal predicts another, beyond that one's own past and its neighbours'."""
