"""The ROS 2 installation in use, the environment of child processes, and the index of installed ROS 2 packages."""
