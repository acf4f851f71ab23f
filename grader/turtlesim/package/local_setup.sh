# A workspace's install/setup.bash sources this file, since colcon expects it in each prefix. It does nothing, because
# the environment of ROS 2 includes turtlesim already.
