import os
from glob import glob
from setuptools import setup

package_name = "my_robot_controller"

setup(
	name=package_name,
	version="0.0.0",
	packages=[package_name],
	data_files=[
		("share/ament_index/resource_index/packages", ["resource/" + package_name]),
		("share/" + package_name, ["package.xml"]),
		(os.path.join("share", package_name, "launch"), glob("launch/*.py")),
	],
	install_requires=["setuptools"],
	zip_safe=True,
	maintainer="Jonas",
	maintainer_email="jonas@example.de",
	description="Meine Knoten für turtlesim",
	license="MIT",
	entry_points={
		"console_scripts": [
			"draw_circle = my_robot_controller.draw_circle:main",
		],
	},
)
