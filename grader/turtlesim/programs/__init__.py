"""The other executables of the package turtlesim: turtle_teleop_key, draw_square and mimic. Each is a node."""
