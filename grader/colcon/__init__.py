"""Build a submission with colcon in a cell, and read the result."""
