"""A setup.py of the usual form is read. A setup.py of any other form is not read."""

from __future__ import annotations

import pytest

from grader.submission.plain_setup import PlainSetup, read_plain_setup

PATHS = ("setup.py", "fish/__init__.py", "fish/sea/__init__.py", "test/__init__.py", "loose/sea/__init__.py")
SETUP_CFG = "[develop]\nscript_dir=$base/lib/fish\n\n[install]\ninstall-scripts = $base/lib/fish\n"
SETUP_PY = """import os
from setuptools import find_packages, setup

name = "fish"

setup(
    name=name,
    version="0.1.0",
    packages=find_packages(exclude=["test"]),
    data_files=[(os.path.join("share", name), ["package.xml", "config/sea.yaml"])],
    install_requires=["setuptools"],
    description="A fish",
    entry_points={"console_scripts": ["swim = fish.node:main", "dive=fish.sea.node:main"]},
)
"""


def read(setup_py: str = SETUP_PY, setup_cfg: str = SETUP_CFG) -> PlainSetup | None:
    return read_plain_setup(setup_py.encode(), setup_cfg.encode(), PATHS)


def test_the_usual_form_is_read() -> None:
    assert read() == PlainSetup(
        name="fish",
        version="0.1.0",
        packages=("fish", "fish.sea"),
        data_files=(("share/fish", "package.xml"), ("share/fish", "config/sea.yaml")),
        entry_points={"swim": "fish.node:main", "dive": "fish.sea.node:main"},
    )


def test_packages_may_be_listed() -> None:
    listed = read(SETUP_PY.replace('find_packages(exclude=["test"])', "[name]"))
    assert listed is not None
    assert listed.packages == ("fish",)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('name = "fish"', 'name = "fish"\nprint(name)'),
        ('name = "fish"', 'name = "fish"\nif name:\n    name = "whale"'),
        ('name = "fish"', 'name = "Fish"'),
        ('name = "fish"', 'name = "fish"\nx = exec("print(name)")'),
        ('name = "fish"', 'name = "fish"\nx = [open("fish/node.py").read()]'),
        ('description="A fish"', 'description=open("fish/node.py").read()'),
        ('name = "fish"', "def setup(**_): pass"),
        ("import os", "from os import system as find_packages"),
        ("import os", "import setuptools as os"),
        ("import os", "import fish"),
        ("import os", "from . import os"),
        ('"0.1.0"', '"0.1.0-beta"'),
        ('"0.1.0"', "version()"),
        ('exclude=["test"]', 'where="src"'),
        ('exclude=["test"]', "exclude=tests"),
        ('find_packages(exclude=["test"])', '["whale"]'),
        ('find_packages(exclude=["test"])', "listed()"),
        ('["package.xml", "config/sea.yaml"]', 'glob("*.xml")'),
        ('["package.xml", "config/sea.yaml"]', "[]"),
        ('"config/sea.yaml"', '"../sea.yaml"'),
        ('os.path.join("share", name)', '"/share"'),
        ("fish.sea.node:main", "fish.sea.node:main [sea]"),
        ("fish.sea.node:main", "fish.sea.node"),
        ("dive=", "swim="),
        ('{"console_scripts"', '{"gui_scripts": ["a = fish:main"], "console_scripts"'),
        ('description="A fish"', 'package_dir={"": "src"}'),
        ('description="A fish"', "**more"),
    ],
)
def test_another_form_is_not_read(old: str, new: str) -> None:
    assert old in SETUP_PY
    assert read(SETUP_PY.replace(old, new)) is None


@pytest.mark.parametrize("more", ["[metadata]\n", "[options]\npackages = find:\n", "prefix=/tmp\n"])
def test_another_setup_cfg_is_not_read(more: str) -> None:
    assert read(setup_cfg=SETUP_CFG + more) is None
    assert read(setup_cfg=SETUP_CFG.replace("lib/fish", "lib/whale")) is None
