"""colcon: the workspace that a submission is built in, and what colcon made of it."""
