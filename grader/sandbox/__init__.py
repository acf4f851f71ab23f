"""The sandbox: the cells in which student code runs, and their limits."""
