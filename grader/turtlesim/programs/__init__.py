"""The programs turtle_teleop_key, draw_square and mimic of the package turtlesim."""
