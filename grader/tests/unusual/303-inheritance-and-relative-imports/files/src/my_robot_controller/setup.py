import setuptools

NAME = "my_robot_controller"

setuptools.setup(
    name=NAME,
    version="0.3.0",
    packages=setuptools.find_packages(),
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
    ],
    install_requires=["setuptools"],
    zip_safe=False,
    maintainer="Anouk",
    maintainer_email="anouk@example.org",
    description="Turtle drivers",
    license="Apache-2.0",
    entry_points={"console_scripts": [f"draw_circle = {NAME}:main"]},
)
