"""The limit on the number of files that the conductor may open.

The conductor keeps at least two files open for each thread of a node.
"""

from __future__ import annotations

import errno
import resource

from grader.common.system_errors import sentence

LEAST = 256
"""With a lower limit, the conductor could not even run an ordinary node."""
_USUAL = 1024


def raise_limit() -> None:
    """If the limit of this process is low, raise it to the usual limit on Linux, as far as the system allows this."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if soft != resource.RLIM_INFINITY and soft < LEAST:
        highest = _USUAL if hard == resource.RLIM_INFINITY else min(hard, _USUAL)
        resource.setrlimit(resource.RLIMIT_NOFILE, (highest, hard))


def lack(error: BaseException) -> str | None:
    """Return a message if `error` means that the machine allows too few open files, or else None."""
    if not isinstance(error, OSError) or error.errno not in (errno.EMFILE, errno.ENFILE):
        return None
    low = resource.getrlimit(resource.RLIMIT_NOFILE)[0] < LEAST
    return sentence(error.errno) if low or error.errno == errno.ENFILE else None
