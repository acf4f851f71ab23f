import csv
from pathlib import Path


def pytest_generate_tests(metafunc):
    """One test for each line of scenes.csv."""
    if "scene" in metafunc.fixturenames:
        with open(Path(__file__).with_name("scenes.csv"), newline="") as file:
            scenes = list(csv.DictReader(file))
        metafunc.parametrize("scene", scenes, ids=[scene["name"] for scene in scenes])
