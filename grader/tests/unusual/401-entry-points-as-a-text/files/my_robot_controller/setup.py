"""Setup of my_robot_controller."""
import re
from pathlib import Path

from setuptools import find_packages, setup

HERE = Path(__file__).resolve().parent
XML = (HERE / "package.xml").read_text(encoding="utf-8")
VERSION = re.search(r"<version>(.*)</version>", XML)[1]


def main():
    name = HERE.joinpath("resource").iterdir().__next__().name
    setup(
        name=name,
        version=VERSION,
        packages=find_packages(),
        data_files=[
            ("share/ament_index/resource_index/packages", ["resource/%s" % name]),
            ("share/%s" % name, ["package.xml"]),
        ],
        install_requires=["setuptools"],
        entry_points="""
            [console_scripts]
            test_node = my_robot_controller.nodes:first
            draw_circle = my_robot_controller.nodes:circle
        """,
    )


if __name__ == "__main__":
    main()
