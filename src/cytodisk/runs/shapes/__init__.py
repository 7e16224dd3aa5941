"""`cytodisk shapes`: features and complexity of shapes."""
