"""`ros2` and `rqt_graph` for machines without ros2cli."""
