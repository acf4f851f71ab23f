"""Parse command lines of colcon with colcon's own parser, without running them.

`python -m grader.authoring.parse_colcon` reads a JSON list of command lines (lists of words after `colcon`). It prints
a JSON list with one string for each command line: an error message, or "" if colcon accepts the command line. A
separate process is necessary, because colcon changes the logging and other settings of the process in which it runs.
"""

from __future__ import annotations

import importlib
import json
import os
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from typing import TYPE_CHECKING

from grader.common.interpreter import interpreter

if TYPE_CHECKING:
    from collections.abc import Sequence


def colcon_faults(commands: Sequence[Sequence[str]]) -> list[str]:
    """Return one error message per command line, or an empty string if colcon accepts the command line.

    Paths need not exist. If colcon cannot start, every command line counts as accepted.
    """
    own = {name: value for name, value in os.environ.items() if not name.startswith("COLCON_")}
    start = interpreter("-m", "grader.authoring.parse_colcon", env={**own, "COLCON_HOME": os.devnull})
    given = json.dumps([list(words) for words in commands])
    done = subprocess.run(start.argv, env=start.env, input=given, capture_output=True, text=True, check=False)
    return list(json.loads(done.stdout)) if done.returncode == 0 else [""] * len(commands)


def _fault(words: list[str]) -> str:
    printed = StringIO()
    main = importlib.import_module("colcon_core.command").main
    with redirect_stderr(printed), redirect_stdout(StringIO()):
        try:
            failed = main(argv=["--log-base", os.devnull, *words])
        except SystemExit as error:
            failed = error.code
    fault = printed.getvalue().partition("error: ")[2].strip() if failed else ""
    return "" if fault.endswith("does not exist") else fault


def _main() -> None:
    importlib.import_module("colcon_core.command").verb_main = lambda *_: 0  # type: ignore[attr-defined]
    print(json.dumps([_fault(words) for words in json.load(sys.stdin)]))


if __name__ == "__main__":
    _main()
