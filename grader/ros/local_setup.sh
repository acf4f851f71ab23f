# What a workspace's install/setup.bash sources of the ROS 2 below it: the ROS 2 wheels of the course. Installed into
# the root of its environment as local_setup.sh, .bash and .zsh, since colcon takes only a prefix with such files for
# one; says nothing where `source <(grader env)` was said before.
case ":${AMENT_PREFIX_PATH-}:" in
*":$COLCON_CURRENT_PREFIX:"*) ;;
*) eval "$("$COLCON_CURRENT_PREFIX/bin/grader" env)" ;;
esac
