import os
from glob import glob

from setuptools import find_packages, setup

PACKAGE = 'my_robot_controller'
NODES = {
    'test_node': 'first',
    'draw_circle': 'circle',
}


def data_files():
    files = [
        ('share/ament_index/resource_index/packages', [os.path.join('resource', PACKAGE)]),
        (os.path.join('share', PACKAGE), ['package.xml']),
    ]
    for folder in ('launch', 'config'):
        found = glob(os.path.join(folder, '*'))
        if found:
            files.append((os.path.join('share', PACKAGE, folder), found))
    return files


setup(
    name=PACKAGE,
    version='0.0.0',
    packages=find_packages(exclude=['test', 'test.*']),
    package_data={PACKAGE: ['py.typed']},
    data_files=data_files(),
    install_requires=['setuptools'],
    zip_safe=True,
    entry_points={
        'console_scripts': [f'{name} = {PACKAGE}.{module}:main' for name, module in NODES.items()],
    },
)
