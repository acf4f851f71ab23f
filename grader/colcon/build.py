"""Build: the result of `colcon build`."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Build:
    """The result of `colcon build`, read from the install tree. None of its code runs for that.

    Paths are POSIX paths relative to install/<package>. `entry_points` are the installed console_scripts,
    name -> "module:attribute".
    """

    exit_code: int
    log: str
    """Standard output and standard error of colcon together, with a limit."""
    package: str | None = None
    """The name of the installed package; None if nothing was installed."""
    timed_out: bool = False
    out_of: str | None = None
    """The limit of the sandbox that was reached: "disk", "memory", ...; None if none was."""
    installed: tuple[str, ...] = ()
    executables: tuple[str, ...] = ()
    """The names of the files in lib/<package>, which `ros2 run` can start."""
    entry_points: dict[str, str] = field(default_factory=dict)
    seconds: float = 0.0
