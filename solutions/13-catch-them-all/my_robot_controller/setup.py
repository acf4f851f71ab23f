from setuptools import find_packages, setup

package_name = "my_robot_controller"

setup(
    name=package_name,
    version="0.1.0",
    packages=find_packages(exclude=["test"]),
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/" + package_name]),
        ("share/" + package_name, ["package.xml"]),
    ],
    install_requires=["setuptools"],
    zip_safe=True,
    maintainer="Student",
    maintainer_email="student@example.com",
    description="Nodes that drive the turtle of turtlesim",
    license="MIT",
    extras_require={"test": ["pytest"]},
    entry_points={
        "console_scripts": [
            "test_node = my_robot_controller.my_first_node:main",
            "draw_circle = my_robot_controller.draw_circle:main",
            "pose_subscriber = my_robot_controller.pose_subscriber:main",
            "own_circle = my_robot_controller.own_circle:main",
            "figure_eight = my_robot_controller.figure_eight:main",
            "draw_square = my_robot_controller.draw_square:main",
            "go_to_goal = my_robot_controller.go_to_goal:main",
            "two_pens = my_robot_controller.two_pens:main",
            "pausable_circle = my_robot_controller.pausable_circle:main",
            "tunable_circle = my_robot_controller.tunable_circle:main",
            "lookout = my_robot_controller.lookout:main",
            "draw_star = my_robot_controller.draw_star:main",
            "bag_report = my_robot_controller.bag_report:main",
            "wall_guard = my_robot_controller.wall_guard:main",
            # BEGIN SOLUTION
            "spawner = my_robot_controller.spawner:main",
            "catcher = my_robot_controller.catcher:main",
            # END SOLUTION
            # BEGIN STARTER
            # # TODO 1: add the entry points spawner and catcher.
            # END STARTER
        ],
    },
)
