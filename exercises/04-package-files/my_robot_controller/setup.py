from setuptools import find_packages, setup

package_name = "my_robot_controller"

setup(
    name=pakage_name,
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
            "test_node = my_robot_controller.my_first_node:main",
            "draw_circle = my_robot_controller.circle:main",
        ],
    },
)
