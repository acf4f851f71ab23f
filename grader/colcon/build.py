"""The data that the grader keeps about a build."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Build:
    """The result of `colcon build`, read from the install tree without running any of its code.

    Paths are POSIX paths relative to install/<package>. `entry_points` maps the names of the installed console_scripts
    to "module:attribute".
    """

    exit_code: int
    log: str
    """The combined standard output and standard error of colcon, limited in size."""
    package: str | None = None
    """The name of the installed package, or None if nothing was installed or the install tree had to be discarded."""
    timed_out: bool = False
    out_of: str | None = None
    """The limit that was reached, such as "disk" or "memory", or None."""
    installed: tuple[str, ...] = ()
    executables: tuple[str, ...] = ()
    """The names of the files in lib/<package>, where `ros2 run` looks for executables."""
    entry_points: dict[str, str] = field(default_factory=dict)
    seconds: float = 0.0
