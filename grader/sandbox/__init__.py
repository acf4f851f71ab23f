"""The sandbox: cells, which contain student code, rooms, which contain the simulator, and their limits."""
