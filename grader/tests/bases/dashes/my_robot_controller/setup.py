from setuptools import setup
package_name='my_robot_controller'
setup(
    name=package_name,
    version='0.0.0',
    packages=[package_name],
    # data files
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/'+package_name]),
        ('share/'+package_name, ['package.xml'])],
    install_requires=['setuptools'],
    zip_safe=True,
    author='priya', maintainer='priya', maintainer_email='priya.k@example.in',
    description='turtle controler', license='Apache License 2.0',
    entry_points={
        'console_scripts': [
            # executables
            "draw_circle=my_robot_controller.draw_circle:main",
        ],
    },
)
