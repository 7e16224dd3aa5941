"""How the pixels of a cell are shared among its windows."""
