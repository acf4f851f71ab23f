from setuptools import find_packages, setup

package_name = "my_robot_controller"

setup(
    # BEGIN SOLUTION
    name=package_name,
    # END SOLUTION
    # BEGIN STARTER
    # name=pakage_name,
    # END STARTER
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
    entry_points={
        "console_scripts": [
            # BEGIN SOLUTION
            "test_node = my_robot_controller.my_first_node:main",
            "draw_circle = my_robot_controller.draw_circle:main",
            # END SOLUTION
            # BEGIN STARTER
            # "test_node = my_robot_controller.my_first_node:main",
            # "draw_circle = my_robot_controller.circle:main",
            # END STARTER
        ],
    },
)
