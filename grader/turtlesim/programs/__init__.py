"""What else the package turtlesim brings to run: turtle_teleop_key, draw_square and mimic. Each a node of its own."""
