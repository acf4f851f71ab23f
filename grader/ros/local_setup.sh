# A workspace's install/setup.bash sources this file to get the ROS 2 below it, the wheels of the course. It is
# installed into the root of the environment as local_setup.sh, .bash and .zsh, since colcon expects these files in a
# prefix. It does nothing if this ROS 2 is in the environment already.
case ":${AMENT_PREFIX_PATH-}:" in
*":$COLCON_CURRENT_PREFIX:"*) ;;
*) eval "$("$COLCON_CURRENT_PREFIX/bin/grader" env)" ;;
esac
