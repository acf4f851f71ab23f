"""Build: what colcon made of a submission."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Build:
    """The result of `colcon build`, read from the install tree without running anything of it.

    Paths are POSIX paths relative to install/<package>. `entry_points` are the console_scripts as installed,
    name -> "module:attribute".
    """

    exit_code: int
    log: str
    """stdout and stderr of colcon together, capped."""
    package: str | None = None
    """The name under which colcon installed it; None when nothing was installed."""
    timed_out: bool = False
    out_of: str | None = None
    """"disk", "memory", ... when a limit of the sandbox was hit."""
    installed: tuple[str, ...] = ()
    executables: tuple[str, ...] = ()
    """Names of the files in lib/<package>: what `ros2 run` can start."""
    entry_points: dict[str, str] = field(default_factory=dict)
    seconds: float = 0.0
