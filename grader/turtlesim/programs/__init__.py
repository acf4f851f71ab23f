"""The other executables in the package turtlesim: turtle_teleop_key, draw_square and mimic. Each of them is a node."""
