# fichier recopié du cours, adapté
from setuptools import setup

setup(
    name="my_robot_controller", version="0.0.1",
    packages=["my_robot_controller"],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/my_robot_controller"]),
        ("share/my_robot_controller", ["package.xml"]),
    ],
    install_requires=["setuptools"],
    maintainer="Luc", maintainer_email="luc@exemple.fr", license="GPL-3.0-only", description="Paquet du TP 3",
    entry_points={"console_scripts": ["draw_circle = my_robot_controller.draw_circle:main"]},
)
