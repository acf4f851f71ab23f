"""colcon: it builds a submission in a cell, and reads the result."""
