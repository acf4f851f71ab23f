# A workspace's install/setup.bash sources this file. It does nothing, since the environment with ROS 2 has turtlesim
# already; colcon expects such a file in each prefix.
