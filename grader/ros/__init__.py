"""The ROS 2 installation in use, the environment of child processes, and the installed ROS 2 packages."""
