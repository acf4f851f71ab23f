"""Names in ROS 2 Jazzy that beginners use. If a name is misspelt, the grader suggests the most similar name."""

from __future__ import annotations

import re

MODULE_OF = {
    "Node": "rclpy.node",
    "MultiThreadedExecutor": "rclpy.executors",
    "ExternalShutdownException": "rclpy.executors",
    "QoSProfile": "rclpy.qos",
    "ReliabilityPolicy": "rclpy.qos",
    "Twist": "geometry_msgs.msg",
    "Vector3": "geometry_msgs.msg",
    "TwistStamped": "geometry_msgs.msg",
    "Pose": "turtlesim.msg",
    "Color": "turtlesim.msg",
    "RotateAbsolute": "turtlesim.action",
    "ActionClient": "rclpy.action",
    "GoalStatus": "action_msgs.msg",
    "SetPen": "turtlesim.srv",
    "Spawn": "turtlesim.srv",
    "Kill": "turtlesim.srv",
    "TeleportAbsolute": "turtlesim.srv",
    "String": "std_msgs.msg",
    "Float32": "std_msgs.msg",
    "Int32": "std_msgs.msg",
    "Empty": "std_srvs.srv",
    "setup": "setuptools",
    "find_packages": "setuptools",
    "glob": "glob",
}
"""Maps a class or function to the module from which it is usually imported."""
IN_RCLPY = {"Duration": "rclpy.duration", "Time": "rclpy.time", "wait_for_message": "rclpy.wait_for_message"}
"""Maps more names to their modules. rospy has the same names, and no name is corrected to one of them."""
SHARED_NAMES = frozenset({"Pose", "Color", "Empty", "setup", "find_packages", "glob"})
"""The names in `MODULE_OF` that also exist in other packages, such as Pose in geometry_msgs."""

MODULES = (
    "rclpy",
    "rclpy.node",
    "rclpy.executors",
    "rclpy.qos",
    "geometry_msgs.msg",
    "turtlesim.msg",
    "turtlesim.srv",
    "turtlesim.action",
    "rclpy.action",
    "action_msgs.msg",
    "std_msgs.msg",
    "std_srvs.srv",
    "math",
    "random",
    "time",
    "threading",
    "functools",
    "os",
    "sys",
)
PACKAGE = re.compile(
    r"(?!turtlesim_msgs)\w+_(?:msgs|srvs|interfaces)|rclpy|turtlesim|tf2_ros|rosbag2_py|ament_index_python"
    r"|launch|launch_ros|message_filters|cv_bridge"
)
"""Matches the names of imported ROS 2 packages: interface packages, and packages that Python nodes often use.

The list is fixed, so that a report is the same on every machine. Jazzy has no package turtlesim_msgs."""
NOT_IN_COURSE = frozenset(
    {
        *("ament_copyright", "ament_flake8", "ament_pep257", "cv_bridge", "example_interfaces", "image_geometry"),
        *("launch", "launch_pytest", "launch_ros", "launch_testing", "launch_testing_ros", "laser_geometry"),
        *("message_filters", "osrf_pycommon", "python_qt_binding", "ros2action", "ros2bag", "ros2cli", "ros2launch"),
        *("ros2node", "ros2param", "ros2pkg", "ros2run", "ros2service", "ros2topic", "rosbag2_py", "rosidl_runtime_py"),
        *("rqt_gui", "rqt_gui_py", "sensor_msgs_py", "tf2_geometry_msgs", "tf2_kdl", "tf2_msgs", "tf2_py"),
        *("tf2_ros", "tf2_sensor_msgs", "tf_transformations"),
    }
)
"""Python modules of packages for Jazzy that a full ROS 2 can have, but that the course does not install."""
ROS_1 = frozenset({"rospy", "roslib", "tf", "catkin", "roscpp", "rosbag", "actionlib"})
"""Modules that exist only in ROS 1."""

OF_ROS_1 = {
    "init_node": "The node gets its name in super().__init__.",
    "is_shutdown": "In ROS 2, rclpy.ok() returns the opposite.",
    "Publisher": "In ROS 2, the method create_publisher of the node creates a publisher.",
    "Subscriber": "In ROS 2, the method create_subscription of the node creates a subscription.",
    "Rate": "In ROS 2, a node does periodic work in the callback of a timer.",
    "Timer": "In ROS 2, the method create_timer of the node creates a timer.",
    "sleep": "In ROS 2, a node does periodic work in the callback of a timer.",
    "get_time": "In ROS 2, the node's clock gives the time: get_clock().now().",
    "get_param": "In ROS 2, a node has declare_parameter and get_parameter.",
    "set_param": "In ROS 2, a node has declare_parameter and set_parameters.",
    "ServiceProxy": "In ROS 2, the method create_client of the node creates a client.",
    "Service": "In ROS 2, the method create_service of the node offers a service.",
    "wait_for_service": "In ROS 2, a client has the methods wait_for_service and service_is_ready.",
    "loginfo": "In ROS 2, the logger has the method info.",
    "logwarn": "In ROS 2, the logger has the method warning.",
    "logerr": "In ROS 2, the logger has the method error.",
}
"""Maps a name in rospy to a sentence about its replacement in ROS 2."""
CALLED_ON_A_NODE = frozenset({"get_param", "set_param", "Publisher", "Subscriber", "Rate", "ServiceProxy"})
"""The functions of rospy that learners call on a node. The other names can mean something else there."""

NODE = (
    "create_publisher",
    "create_subscription",
    "create_timer",
    "create_client",
    "create_service",
    "create_rate",
    "declare_parameter",
    "destroy_node",
    "get_clock",
    "get_logger",
    "get_name",
    "get_parameter",
)
"""Methods of a node."""

RCLPY = (
    "init",
    "spin",
    "spin_once",
    "spin_until_future_complete",
    "shutdown",
    "try_shutdown",
    "ok",
    "create_node",
    "node",
)
"""Names in the module rclpy."""

FIELDS = {
    "Twist": ("linear", "angular"),
    "Vector3": ("x", "y", "z"),
    "Pose": ("x", "y", "theta", "linear_velocity", "angular_velocity"),
    "String": ("data",),
}
"""Maps a message type to the names of its fields."""

OTHERS = {
    "Publisher": ("publish",),
    "Subscription": (),
    "Client": ("call_async", "wait_for_service", "service_is_ready"),
    "Service": (),
    "Timer": ("cancel", "reset"),
    "RcutilsLogger": ("debug", "info", "warning", "warn", "error", "fatal"),
}
"""Maps other classes, such as the class of a logger, to the methods that beginners use."""

CONSTANTS = {
    "GoalStatus": (
        "STATUS_UNKNOWN",
        "STATUS_ACCEPTED",
        "STATUS_EXECUTING",
        "STATUS_CANCELING",
        "STATUS_SUCCEEDED",
        "STATUS_CANCELED",
        "STATUS_ABORTED",
    ),
    "ReliabilityPolicy": ("RELIABLE", "BEST_EFFORT", "SYSTEM_DEFAULT"),
    "DurabilityPolicy": ("VOLATILE", "TRANSIENT_LOCAL", "SYSTEM_DEFAULT"),
    "HistoryPolicy": ("KEEP_LAST", "KEEP_ALL", "SYSTEM_DEFAULT"),
    "ParameterType": (
        "PARAMETER_NOT_SET",
        "PARAMETER_BOOL",
        "PARAMETER_INTEGER",
        "PARAMETER_DOUBLE",
        "PARAMETER_STRING",
    ),
}
"""Maps a class to the constants that beginners use. They are attributes of the class itself, so no object is needed."""
