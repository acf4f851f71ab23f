from io import StringIO
import csv

SCENES = """\
name,x,y,tenths,commands,speed,turn
middle,5.0,5.0,10,10,1.1,0
left wall,0.5,5.0,2,2,0.5,1.2
right wall,10.5,5.0,2,2,0.5,1.2
lower wall,5.0,0.5,2,2,0.5,1.2
upper wall,5.0,10.5,2,2,0.5,1.2
no longer,5.0,5.0,16,16,0,0
"""


def pytest_generate_tests(metafunc):
    """One test for each line of the table."""
    if "scene" in metafunc.fixturenames:
        scenes = list(csv.DictReader(StringIO(SCENES)))
        metafunc.parametrize("scene", scenes, ids=[scene["name"] for scene in scenes])
