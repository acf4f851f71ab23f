"""The kernel "ROS 2 Jazzy (course)": a Python kernel with ROS 2 in its environment.

    python -m grader.notebook.kernel -f CONNECTION_FILE     what Jupyter runs

The environment is created at each start, so a ROS 2 that was installed or sourced in the meantime is found.
"""

from __future__ import annotations

import json
import os
import shutil
import sys
import tempfile
from pathlib import Path

from grader.common.interpreter import interpreter
from grader.common.system_errors import path_and_reason
from grader.errors import MachineError
from grader.ros.installation import made_for

NAME = "ros2-jazzy-course"
DISPLAY_NAME = "ROS 2 Jazzy (course)"
_AGAIN = "_GRADER_KERNEL_STARTED_AGAIN"


def main() -> None:
    """Replace this process with the kernel.

    If Jupyter was started without the ROS 2 that the course was set up for, that ROS 2 is sourced first. Without any
    ROS 2, the kernel is a plain Python kernel, in which `check` reports what is missing.
    """
    from grader.errors import GraderError
    from grader.notebook.simulator import environment

    try:
        env = environment()
    except GraderError as error:
        _source_and_start_again()
        print(error, file=sys.stderr)
        env = dict(os.environ)
    kernel = interpreter("-m", "ipykernel_launcher", *sys.argv[1:], env=env, searches=True)
    os.execve(kernel.argv[0], kernel.argv, kernel.env)


def _source_and_start_again() -> None:
    """Restart in a shell that sources the ROS 2 that the course was set up for.

    This function returns only if the restart is not possible.
    """
    prefix, bash = made_for(Path(sys.prefix)), shutil.which("bash", path="/usr/bin:/bin")
    if prefix is None or bash is None or _AGAIN in os.environ or not Path(prefix, "setup.bash").is_file():
        return
    again = interpreter("-m", "grader.notebook.kernel", *sys.argv[1:], env={**os.environ, _AGAIN: "1"})
    script = 'source "$1"; shift; exec "$@"'
    os.execve(bash, [bash, "-c", script, "bash", f"{prefix}/setup.bash", *again.argv], again.env)


def kernelspec() -> dict[str, object]:
    """Return the content of kernel.json as a dictionary."""
    return {
        "argv": interpreter("-m", "grader.notebook.kernel", "-f", "{connection_file}").argv,
        "display_name": DISPLAY_NAME,
        "language": "python",
        "metadata": {"debugger": True},
    }


def install(prefix: Path | None = None) -> Path:
    """Install the kernel for this user's Jupyter, or for the Jupyter in `prefix`. Return the folder of the kernel.

    Raises:
        MachineError: Jupyter is not installed, or the folder cannot be written.
    """
    try:
        from jupyter_client.kernelspec import KernelSpecManager
    except ImportError as error:
        message = "Jupyter is not installed. Run `make notebooks` to install Jupyter."
        raise MachineError(message) from error
    with tempfile.TemporaryDirectory() as folder:
        Path(folder).chmod(0o755)
        (Path(folder) / "kernel.json").write_text(json.dumps(kernelspec(), indent=1) + "\n", encoding="utf-8")
        try:
            placed: str = KernelSpecManager().install_kernel_spec(
                folder, NAME, user=prefix is None, prefix=str(prefix) if prefix else None
            )
        except OSError as error:
            path, reason = path_and_reason(error)
            message = f"The kernel could not be installed{f' in {path}' if path else ''}: {reason}."
            raise MachineError(message) from error
    return Path(placed)


if __name__ == "__main__":
    main()
