"""The command line of uv, the program that resolves and installs packages."""

from __future__ import annotations

import ssl
import sys
from pathlib import Path


def uv(*arguments: str) -> list[str]:
    """Return the command line of the uv in .venv.

    uv uses the certificates of the system, as other programs do. If the system has no certificates, uv uses its own
    certificates.
    """
    stores = ssl.get_default_verify_paths()
    has_certificates = stores.cafile or (stores.capath and any(Path(stores.capath).iterdir()))
    return [str(Path(sys.prefix, "bin", "uv")), *arguments, *(["--system-certs"] if has_certificates else [])]
