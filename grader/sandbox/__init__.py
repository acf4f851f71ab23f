"""The sandbox: cells (for student code), rooms (for the simulator), and their limits."""
