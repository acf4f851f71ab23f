"""The ROS graph: how it is discovered, what belongs to it, and how it is drawn."""
