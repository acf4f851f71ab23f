"""Mistakes in setup.py."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.tests.operators.operator import (
    Change,
    Make,
    Operator,
    Package,
    anywhere,
    misspelt,
    remove_line,
    replace,
)

if TYPE_CHECKING:
    import re
    from random import Random

    from grader.checks.diagnosis import Diagnosis
    from grader.tests.operators.operator import Replacement

FILE = "setup.py"
POINT = (
    r"(?P<quote>[\"'])(?P<name>\w+) *= *"
    r"(?P<folder>my_robot_controller)\.(?P<module>[\w.]+):(?P<function>\w+)(?P=quote)"
)


def _in_setup(name: str, pattern: str, by: Replacement, *says: Diagnosis, never: str = "") -> Operator:
    return Operator(name, replace(pattern, by, file=FILE), frozenset(says), never)


def _misspelt(part: str) -> Make:
    def make(package: Package, draw: Random) -> Change | None:
        def by(match: re.Match[str]) -> str:
            begin, end = match.start(part) - match.start(), match.end(part) - match.start()
            whole: str = match[0]
            return whole[:begin] + misspelt(whole[begin:end], draw) + whole[end:]

        change: Make = replace(POINT, by, file=FILE)
        return change(package, draw)

    return make


OPERATORS = (
    Operator("entry-point-left-out", remove_line(POINT, file=FILE), frozenset({"entry-point-missing"})),
    Operator("entry-point-name", _misspelt("name"), frozenset({"entry-point-name"})),
    Operator("entry-point-module", _misspelt("module"), frozenset({"entry-point-module"})),
    Operator("entry-point-function", _misspelt("function"), frozenset({"entry-point-function"})),
    Operator("entry-point-folder", _misspelt("folder"), frozenset({"entry-point-module"})),
    _in_setup("entry-point-without-folder", POINT, r'"\g<name> = \g<module>:\g<function>"', "entry-point-module"),
    _in_setup("entry-point-without-function", POINT, r'"\g<name> = \g<folder>.\g<module>"', "entry-point-no-function"),
    _in_setup("entry-point-py", POINT, r'"\g<name> = \g<folder>.\g<module>.py:\g<function>"', "entry-point-py"),
    _in_setup("entry-point-slash", POINT, r'"\g<name> = \g<folder>/\g<module>:\g<function>"', "entry-point-slash"),
    _in_setup("entry-point-dot", POINT, r'"\g<name> = \g<folder>.\g<module>.\g<function>"', "entry-point-no-function"),
    _in_setup("entry-point-colon", POINT, r'"\g<name>: \g<folder>.\g<module>:\g<function>"', "entry-point-format"),
    _in_setup("entry-point-commented", rf"(?m)^(\s*)({POINT},?)$", r"\1# \2", "entry-point-commented"),
    _in_setup("entry-point-without-quotes", POINT, r"\g<name> = \g<folder>.\g<module>:\g<function>", "setup-py-syntax"),
    _in_setup("entry-point-comma", rf"({POINT}),(?=\s*[\"'])", r"\1", "entry-point-comma"),
    _in_setup("group-misspelt", r"console_scripts(?=[\"'] *:)", "console_script", "entry-point-group"),
    Operator(
        "setup-py-other-name",
        replace(r"^package_name = .*$", 'package_name = "my_robot_controler"', file=FILE),
        frozenset({"package-name"}),
        also=frozenset({"data-file-missing"}),
    ),
    _in_setup("no-packages", r"packages=(?:find_packages\(.*\)|\[.*\])", "packages=[]", "nothing-installed"),
    _in_setup("marker-not-listed", r"^ *\(.*resource_index.*\),?$", "", "resource-marker"),
    _in_setup("package-xml-not-listed", r"^ *\(.*package\.xml.*\),?$", "", "package-xml-not-installed"),
    Operator("bracket-left-open", anywhere(replace(r"\],$", ",", file=FILE)), frozenset({"setup-py-syntax"})),
    _in_setup(
        "setup-py-comma-left-out", r"^( *(?:version|description|license|zip_safe)=.*),$", r"\1", "setup-py-syntax"
    ),
    _in_setup(
        "setup-py-quote-left-out",
        r"^( *(?:version|description|license)=[\"'][^\"']*)[\"'],$",
        r"\1,",
        "setup-py-syntax",
    ),
    Operator("import-left-out", remove_line(r"^from setuptools import", file=FILE), frozenset({"setup-py-raises"})),
    Operator("name-undefined", remove_line(r"^package_name = ", file=FILE), frozenset({"setup-py-raises"})),
    _in_setup("prints", r"^setup\(", 'print("building")\nsetup(', "setup-py-output"),
    _in_setup(
        "file-that-is-not-there", r"\[\"package\.xml\"\]", '["package.xml", "launch/all.py"]', "data-file-missing"
    ),
)
