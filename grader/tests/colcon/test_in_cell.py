"""colcon in a sandbox cell: a fork that runs setup.py behaves like a new interpreter."""

from __future__ import annotations

import io
import re
import shutil
import subprocess
import tarfile
from typing import TYPE_CHECKING

import pytest

from grader.colcon.runner import IN_CELL
from grader.ros.installation import environment
from grader.tests.waiting import HANG_S

if TYPE_CHECKING:
    from pathlib import Path

    from grader.ros.installation import Ros
    from grader.tests.in_ros import InRos

BUILD = ("build", "--base-paths", "src", "--executor", "sequential", "--event-handlers", "console_direct+")
PLAIN = "import sys; from colcon_core.command import main; sys.argv[0] = '-c'; sys.exit(main())"
PACKAGE_XML = """<package format="3">
  <name>fish</name><version>0.1.0</version><description>a</description><maintainer email="a@b.c">a</maintainer>
  <license>MIT</license><export><build_type>ament_python</build_type></export>
</package>
"""
SETUP_PY = """import atexit, os, sys, sysconfig, warnings
IN_A_FORK = "distutils.command.sdist" in sys.modules
from setuptools import find_packages, setup
{before}
setup(
    name="fish", version="0.1.0", packages=find_packages(), install_requires=["setuptools"], tests_require=["pytest"],
    data_files=[("share/ament_index/resource_index/packages", ["resource/fish"]), ("share/fish", ["package.xml"])],
    entry_points={{"console_scripts": ["swim = fish.node:main"]}}, cmdclass={commands},
)
{after}
"""
TELLS = """
told = [__name__, __file__, __doc__, sys.argv, sys.path, sys.prefix, sys.exec_prefix, sys.flags, sys.stdin.read()]
told += [os.getcwd(), sorted(os.environ.items()), sysconfig.get_path("purelib"), sysconfig.get_config_var("prefix")]
told += [sys.executable, sys.warnoptions, sorted(globals())]
print(*map(repr, told), sep="\\n", file=sys.stderr)
warnings.warn("beware")
atexit.register(print, "the end", file=sys.stderr)
"""
FAILS = """
if "install" in sys.argv:
    try:
        {}["swim"]
    except KeyError:
        print(1 / 0)
"""
LEAVES = """
class Fish:
    def __del__(self):
        print("released", file=sys.stderr)

if "install" in sys.argv:
    import helper, threading, weakref
    fish = Fish()
    weakref.finalize(fish, print, "finalized", file=sys.stderr)
    threading.Timer(0.05, print, ["from a thread"], {"file": sys.stderr}).start()
"""
"""Code that leaves things for the end of the interpreter."""
HELPER = """
left_open = [open(f"{number}.log", "a") for number in range(8)]
for file in left_open:
    file.write("helped")
"""
OWN_COMMAND = """
from setuptools import Command
class Greet(Command):
    description, user_options = "says hello", []
    initialize_options = finalize_options = run = lambda self: None
"""
OWN_COMMANDS = "fish.egg-info/entry_points.txt"
IN_A_FORK = "sys.stderr.write(f'in a fork: {IN_A_FORK}\\n')"


def package(
    *, before: str = "", after: str = "", commands: str = "{}", more: dict[str, str] | None = None
) -> dict[str, str]:
    """Return the files of a package whose setup.py does something before and after it calls setup."""
    return {
        "package.xml": PACKAGE_XML,
        "setup.py": SETUP_PY.format(before=before, after=after, commands=commands),
        "setup.cfg": "[develop]\nscript-dir=$base/lib/fish\n[install]\ninstall_scripts=$base/lib/fish\n",
        "resource/fish": "",
        "fish/__init__.py": "",
        "fish/node.py": "def main() -> None:\n    pass\n",
        **(more or {}),
    }


def with_depend(attribute: str) -> str:
    """Return a package.xml with a second <depend> tag that has this attribute."""
    return PACKAGE_XML.replace("<export>", f"<depend>rclpy</depend><depend {attribute}>unknown</depend><export>")


def build(
    ros: Ros, workspace: Path, files: dict[str, str], *, forks: bool
) -> tuple[int, tuple[str, str], dict[str, bytes]]:
    """Build the files, with forks or with plain colcon. Return the exit code, both output streams, and the files.

    The streams are separate, because the order of lines in different streams depends on when colcon reads them.
    """
    shutil.rmtree(workspace, ignore_errors=True)
    (workspace / "src").mkdir(parents=True)
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w") as tar:
        for name, text in files.items():
            member = tarfile.TarInfo(f"fish/{name}")
            member.size = len(text.encode())
            tar.addfile(member, io.BytesIO(text.encode()))
    if not forks:
        subprocess.run(["tar", "-x", "-C", workspace / "src"], input=packed.getvalue(), check=True)
    done = subprocess.run(
        [ros.python, *([IN_CELL] if forks else ["-c", PLAIN]), *BUILD],
        input=packed.getvalue() if forks else b"",
        env=environment(ros, home=workspace),
        cwd=workspace,
        capture_output=True,
        timeout=HANG_S,
        check=False,
    )
    stdout, stderr = (re.sub(r"\d+\.\d+s", "TIME", stream.decode()) for stream in (done.stdout, done.stderr))
    stderr = stderr.removeprefix("colcon-is-ready\n")
    if done.returncode:  # the order of the output of a run that failed and of colcon's message about it depends on luck
        stderr = "\n".join(sorted(stderr.splitlines()))
    made = [*sorted((workspace / "install").rglob("*")), *sorted((workspace / "src").rglob("*.log"))]
    contents = {str(path): path.read_bytes() for path in made if path.is_file() and path.suffix != ".pyc"}
    return done.returncode, (stdout, stderr), contents


@pytest.mark.parametrize(
    "files",
    [
        pytest.param(package(before=TELLS), id="tells"),
        pytest.param(package(after=LEAVES, more={"helper.py": HELPER}), id="leaves"),
        pytest.param(package(more={"package.xml": with_depend('condition="$ROS_VERSION == 1"')}), id="condition"),
        pytest.param(package(more={"package.xml": with_depend('condition="1 =="')}), id="no condition"),
        pytest.param(package(before=FAILS), id="fails"),
        pytest.param(package(after="sys.exit('install' in sys.argv and 3)"), id="exits", marks=pytest.mark.exhaustive),
        pytest.param(package(after="sys.exit('no')"), id="exits with words", marks=pytest.mark.exhaustive),
        pytest.param(package(after="sys.exit(2**40)"), id="exits oddly", marks=pytest.mark.exhaustive),
        pytest.param(package(after="sys.stdout.close()"), id="closes its output", marks=pytest.mark.exhaustive),
        pytest.param(package(after="os.kill(os.getpid(), 9)"), id="killed", marks=pytest.mark.exhaustive),
        pytest.param(package(before="def"), id="syntax", marks=pytest.mark.exhaustive),
        pytest.param(package(before="os.close(1)"), id="closes", marks=pytest.mark.exhaustive),
        pytest.param(package(before="if os.fork() == 0: os._exit(0)"), id="forks", marks=pytest.mark.exhaustive),
        pytest.param(package(more={"json.py": "print('mine')"}), id="own json", marks=pytest.mark.exhaustive),
        pytest.param(
            package(more={"fish.egg-info/entry_points.txt": "[distutils.commands]\nbuild = fish.node:main\n"}),
            id="own commands",
            marks=pytest.mark.exhaustive,
        ),
    ],
)
def test_a_fork_does_what_a_new_interpreter_does(in_ros: InRos, tmp_path: Path, files: dict[str, str]) -> None:
    assert build(in_ros.ros, tmp_path / "ws", files, forks=True) == build(
        in_ros.ros, tmp_path / "ws", files, forks=False
    )


@pytest.mark.parametrize("more", [{}, {"json.py": "from_here = True"}], ids=["plain", "own json"])
def test_setup_py_runs_in_a_fork_unless_its_folder_hides_a_module(
    in_ros: InRos, tmp_path: Path, more: dict[str, str]
) -> None:
    code, (stdout, stderr), _ = build(in_ros.ros, tmp_path / "ws", package(before=IN_A_FORK, more=more), forks=True)
    assert code == 0, stdout + stderr
    assert set(re.findall("in a fork: (.*)", stderr)) == {str(not more)}


@pytest.mark.parametrize(
    "files",
    [
        pytest.param(package(), id="plain"),
        pytest.param(package(before=OWN_COMMAND, commands="{'greet': Greet, 'clean': Greet}"), id="own class"),
        pytest.param(package(commands="{'greet': None}"), id="no class"),
        pytest.param(package(more={OWN_COMMANDS: "[distutils.commands]\ngreet = fish.node:main\n"}), id="own folder"),
        pytest.param(package(more={OWN_COMMANDS: "[distutils.commands]\nbuild = fish.node:no\n"}), id="nothing there"),
        pytest.param(package(more={"docutils.py": "1 / 0"}), id="own docutils"),
    ],
)
def test_colcon_reads_the_same_commands_as_in_a_new_interpreter(
    in_ros: InRos, tmp_path: Path, files: dict[str, str]
) -> None:
    def commands(*, forks: bool) -> tuple[int, list[list[str]]]:
        code, _, _ = build(in_ros.ros, tmp_path / "ws", files, forks=forks)
        log = (tmp_path / "ws" / "log" / "latest_build" / "logger_all.log").read_text()
        return code, [sorted(names.split(", ")) for names in re.findall("Available setuptools commands: (.*)", log)]

    assert commands(forks=True) == commands(forks=False)
