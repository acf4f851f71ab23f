# The setup files of a workspace, such as install/setup.bash, source this file to add the underlay, the ROS 2 wheels of
# the course. The set-up copies it to the root of the environment as local_setup.sh, .bash and .zsh, since colcon expects
# these files in a prefix. The file does nothing if this ROS 2 is already in the environment.
case ":${AMENT_PREFIX_PATH-}:" in
*":$COLCON_CURRENT_PREFIX:"*) ;;
*) eval "$("$COLCON_CURRENT_PREFIX/bin/grader" env)" ;;
esac
