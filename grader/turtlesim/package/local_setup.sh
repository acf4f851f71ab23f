# What a workspace's install/setup.bash sources of the turtlesim below it: nothing, since the environment with ROS 2 in
# it has turtlesim too. colcon takes only a prefix that has such files for one.
