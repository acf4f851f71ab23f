"""`ros2` for machines without ros2cli."""
