"""Which ROS 2 is used, the environment of child processes, and the ROS 2 packages that are installed."""
