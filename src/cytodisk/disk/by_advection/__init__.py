"""The paper's relaxation, for comparison."""
