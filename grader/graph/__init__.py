"""The ROS graph: its discovery, its contents, and its drawing."""
