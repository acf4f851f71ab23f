"""colcon: build a submission in a cell, and read the result."""
