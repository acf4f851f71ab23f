"""A folder full of traps: if a program loads a trap, the trap writes its name into a file outside the folder."""

from __future__ import annotations

import os
import sys
from importlib import metadata
from pathlib import Path

SEARCHED = ("PYTHONPATH", "LD_LIBRARY_PATH", "AMENT_PREFIX_PATH", "CMAKE_PREFIX_PATH", "COLCON_PREFIX_PATH")
PROGRAMS = (
    "bwrap",
    "prlimit",
    "setpriv",
    "choom",
    "cmake",
    "make",
    "ninja",
    "c++",
    "g++",
    "cc",
    "git",
    "python3",
    "sh",
)
GROUPS = (
    *("console_scripts", "colcon_core.extension_point", "colcon_core.verb", "colcon_core.environment_variable"),
    *("colcon_core.package_identification", "colcon_core.task.build", "jupyter_client.kernel_provisioners"),
    *("nbconvert.exporters", "nbgrader.plugins", "distributed.preloads", "matplotlib.backend", "pygments.lexers"),
    *("setuptools.finalize_distribution_options", "distutils.commands", "dask.backends"),
)
CONFIGURATIONS = (
    "nbgrader_config.py",
    "jupyter_config.py",
    "ipython_config.py",
    "ipython_kernel_config.py",
    "conftest.py",
)


class Traps:
    """Fills `folder` with traps. `touched` contains the names of the traps that have been loaded or run."""

    def __init__(self, folder: Path, marker: Path) -> None:
        self.folder, self._marker = folder, marker
        folder.mkdir(parents=True, exist_ok=True)
        mark = f"open({str(marker)!r}, 'a').write({{name!r}} + '\\n')\n"
        for name in sorted(_modules()):
            (folder / f"{name}.py").write_text(mark.format(name=name))
        for package in ("grader", "lib", "site-packages"):
            (folder / package).mkdir()
            (folder / package / "__init__.py").write_text(mark.format(name=package))
        for name in CONFIGURATIONS:
            (folder / name).write_text(mark.format(name=name))
        for kind in ("egg-info", "dist-info"):
            self._distribution(folder / f"trap-1.0.{kind}")
        (folder / "trap.pth").write_text(f"import sys; {mark.format(name='trap.pth')}")
        (folder / "pyvenv.cfg").write_text("home = .\ninclude-system-site-packages = true\n")
        (folder / "setup.cfg").write_text("[options.entry_points]\ncolcon_core.verb =\n    trap = trap:main\n")
        (folder / "defaults.yaml").write_text("build:\n  base-paths: [nowhere]\n")
        (folder / "matplotlibrc").write_text("backend: module://trap\n")
        for name in PROGRAMS:
            (folder / name).write_text(f"#!/bin/bash\necho program {name} >> '{marker}'\nexit 1\n")
            (folder / name).chmod(0o755)

    @property
    def touched(self) -> list[str]:
        return sorted(set(self._marker.read_text().splitlines())) if self._marker.exists() else []

    @staticmethod
    def _distribution(folder: Path) -> None:
        folder.mkdir()
        about = "Metadata-Version: 2.1\nName: trap\nVersion: 1.0\n"
        (folder / ("PKG-INFO" if folder.name.endswith("egg-info") else "METADATA")).write_text(about)
        groups = "".join(f"[{group}]\ntrap = trap:main\n" for group in GROUPS)
        (folder / "entry_points.txt").write_text(groups)


def careless() -> dict[str, str]:
    """Return the variables of a shell whose search paths contain the current folder."""
    # The value after `export PYTHONPATH=$PYTHONPATH:...` if the variable was empty before.
    listed = {name: f":{os.environ.get(name, '')}:relative" for name in SEARCHED}
    places = {"PYTHONSTARTUP": "trap.py", "PYTHONUSERBASE": ".", "PYTHONPYCACHEPREFIX": "cache"}
    ours = {name: value for name, value in os.environ.items() if name not in ("CI", "GITHUB_ACTIONS")}
    return {**ours, **listed, **places, "PATH": f"{Path(sys.executable).parent}::{os.environ['PATH']}"}


def _modules() -> set[str]:
    """Return the names of all modules that the course's programs may import, including installed packages."""
    installed = {name.partition("/")[0].partition(".")[0] for name in metadata.packages_distributions()}
    known = {*sys.stdlib_module_names, *installed, "sitecustomize", "usercustomize", "trap", "turtlesim"}
    return {name for name in known if name.isidentifier()} - {"grader"}
