"""What studies with nuclei have beyond others: columns of their tables."""
