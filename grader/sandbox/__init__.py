"""The sandbox: cells for student code, and their limits."""
