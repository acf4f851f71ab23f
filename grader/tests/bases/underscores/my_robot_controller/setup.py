# configuración del paquete
from setuptools import setup

setup(
    name="my_robot_controller", version="0.0.1",
    packages=["my_robot_controller"],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/my_robot_controller"]),
        ("share/my_robot_controller", ["package.xml"]),
    ],
    install_requires=["setuptools"],
    maintainer="María Pérez", maintainer_email="maria@ejemplo.es", license="BSD", description="Nodos para la tortuga",
    entry_points={"console_scripts": ["draw_circle = my_robot_controller.draw_circle:main"]},
)
