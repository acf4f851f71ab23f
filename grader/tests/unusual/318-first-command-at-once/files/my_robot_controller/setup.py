from setuptools import setup

package_name = 'my_robot_controller'
nodes = ['draw_circle']
scripts = []
for node in nodes:
    scripts.append('{0} = {1}.{0}:main'.format(node, package_name))

data = [('share/ament_index/resource_index/packages', ['resource/' + package_name])]
data += [('share/' + package_name, ['package.xml'])]

arguments = dict(
    name=package_name,
    version='0.0.0',
    packages=[package_name] + [],
    data_files=data,
    install_requires=['setuptools'],
    entry_points={'console_scripts': scripts},
)
setup(**arguments)
