import os
from glob import glob
from setuptools import setup

package_name = 'my_robot_controller'

setup(
    name=package_name,
    version='1.2.3',
    packages=[package_name],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
        (os.path.join('share', package_name, 'launch'), glob('launch/*.launch.py')),
        (os.path.join('share', package_name, 'config'), glob(os.path.join('config', '*.yaml'))),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='Group 7',
    maintainer_email='group7@example.edu',
    description='Circle and watchdog',
    license='BSD',
    entry_points={
        'console_scripts': [
            'draw_circle = my_robot_controller.draw_circle_node:main',
            'watchdog = my_robot_controller.watchdog_node:main',
        ],
    },
)
