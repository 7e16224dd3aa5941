"""The dock with the disk: linked with the cursor in the cell and with the time slider."""
