"""Command lines for a Python that never imports from the current folder, which may belong to a student.

`python -m` and `python -c` put the current folder first on sys.path, and empty or relative entries in PYTHONPATH also
refer to the current folder or a folder below it. A `numpy.py` or a package `grader` in the folder where a user typed a
command would run with that user's rights. Therefore, this module builds every command line for an interpreter, and a
test fails if another module builds such a command line.

Like machine.py, this module runs under any Python from 3.6 on, before anything is installed, so it uses only the syntax
of Python 3.6.
"""

import os
import sys
from pathlib import Path
from typing import Dict, List, Mapping, NamedTuple, Optional

SEARCHED = (
    *("PATH", "PYTHONPATH", "LD_LIBRARY_PATH", "AMENT_PREFIX_PATH", "CMAKE_PREFIX_PATH", "COLCON_PREFIX_PATH"),
    *("CMAKE_MODULE_PATH", "PKG_CONFIG_PATH", "PYTHONHOME", "PYTHONUSERBASE", "PYTHONPYCACHEPREFIX", "PYTHONSTARTUP"),
)
"""Environment variables with a path or a list of paths from which programs, libraries or modules are loaded."""
OF_ANOTHER_PYTHON = ("_PYTHON_SYSCONFIGDATA_NAME", "_PYTHON_HOST_PLATFORM", "_PYTHON_PROJECT_BASE")
"""Environment variables that make sysconfig use the build data of another Python. Most Python installations do not have
this data. conda's compilers and tools for cross-compilation set the variables."""
_CODE = "import sys; sys.path[:] = filter(None, sys.path)\n"
"""Code that removes the current folder from sys.path. The option -P of Python 3.11 does the same, but with -P, IPython
does not let the cells of a notebook import modules from the notebook's folder."""
_RUN = "import runpy; runpy.run_module(sys.argv[0], run_name='__main__', alter_sys=True)\n"
_MODULE = _CODE + "del sys.argv[0]; " + _RUN
_MODULE_BELOW = "import sys; sys.path.insert(0, sys.argv[1]); del sys.argv[:2]; " + _RUN


class Start(NamedTuple):
    """A command line and its environment."""

    argv: List[str]
    env: Dict[str, str]


def interpreter(
    *arguments: str,
    python: str = sys.executable,
    env: Optional[Mapping[str, str]] = None,
    searches: bool = False,
    root: Optional[Path] = None,
) -> Start:
    """Return the command that starts Python with `-m MODULE ...`, `-c CODE ...` or the absolute path of a script.

    `python` is the path of the interpreter. `env` defaults to the caller's environment. With `searches`, Python uses
    PYTHONPATH, which programs that import rclpy need. Without `searches`, the interpreter is isolated (-I). `root` is
    the folder that contains the module's package, if the package is not installed yet. With `root`, only `-m` is
    possible, and the interpreter is isolated.

    Raises:
        ValueError: the script's path is relative.

    Example:
        >>> start = interpreter("-m", "compileall", "lib", python="/usr/bin/python3")
        >>> subprocess.call(start.argv, env=start.env)  # doctest: +SKIP
    """
    kind = arguments[0]
    if not kind.startswith("-") and not Path(kind).is_absolute():
        message = f"a script needs an absolute path, not {kind!r}"
        raise ValueError(message)
    if root is not None:
        argv = [python, "-I", "-c", _MODULE_BELOW, str(root), *arguments[1:]]
    elif not searches:
        argv = [python, "-I", *arguments]
    elif not kind.startswith("-"):
        argv = [python, *arguments]  # the script's folder comes first on sys.path, and it belongs to the grader
    elif kind == "-m":
        argv = [python, "-c", _MODULE, *arguments[1:]]
    else:
        argv = [python, "-c", _CODE + arguments[1], *arguments[2:]]
    return Start(argv, clean(os.environ if env is None else env))


def clean(env: Mapping[str, str]) -> Dict[str, str]:
    """Return the environment without the entries in search paths that depend on the current folder.

    These are empty and relative entries. The variables in OF_ANOTHER_PYTHON are also removed.
    """
    cleaned = {name: value for name, value in env.items() if name not in OF_ANOTHER_PYTHON}
    for name in SEARCHED:
        if name in cleaned:
            cleaned[name] = os.pathsep.join(entry for entry in cleaned[name].split(os.pathsep) if entry.startswith("/"))
            if not cleaned[name]:
                del cleaned[name]
    return cleaned


def clean_own() -> None:
    """Clean the environment of this process, which its child processes inherit."""
    cleaned = clean(os.environ)
    for name in [name for name in os.environ if name not in cleaned]:
        del os.environ[name]
    os.environ.update(cleaned)
