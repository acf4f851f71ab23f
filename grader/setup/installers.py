"""The environment of the installers venv, pip and uv.

Of the user's settings for these installers, only those for the network, the package indexes and the caches are kept.

Like machine.py, this module runs under any Python from 3.6 on, before anything is installed, so it uses only the syntax
of Python 3.6.
"""

import configparser
import os
import re
from configparser import RawConfigParser
from contextlib import suppress
from pathlib import Path
from typing import Dict, List, Mapping

_SETTINGS = re.compile("(?:PIP|UV)_|PYTHON|VIRTUAL_ENV$|CONDA_|__PYVENV_LAUNCHER__$")
_KEPT = re.compile(
    "PIP_(?:INDEX_URL|EXTRA_INDEX_URL|FIND_LINKS|NO_INDEX|TRUSTED_HOST|PROXY|CERT|CLIENT_CERT|KEYRING_PROVIDER|"
    "(?:DEFAULT_)?TIMEOUT|CACHE_DIR|NO_CACHE_DIR|CONFIG_FILE)$|"
    "UV_(?:INDEX|DEFAULT_INDEX|INDEX_URL|EXTRA_INDEX_URL|INDEX_STRATEGY|INDEX_\\w+_(?:USERNAME|PASSWORD)|FIND_LINKS|"
    "OFFLINE|INSECURE_HOST|NATIVE_TLS|SYSTEM_CERTS|KEYRING_PROVIDER|HTTP_\\w+|REQUEST_TIMEOUT|CONCURRENT_\\w+|"
    "CACHE_DIR|NO_CACHE|CONFIG_FILE)$"
)
"""Variables that say where packages come from, how to reach the network, and where downloads are kept."""


def environment(env: Mapping[str, str]) -> Dict[str, str]:
    """Return the environment without variables that would mislead the installers.

    A sourced ROS 2, an active venv or conda, and the settings of pip and uv for other projects can send packages to
    another folder (PIP_TARGET), refuse them (UV_EXCLUDE_NEWER), or build all of them from source (PIP_NO_BINARY).
    """
    kept = {name: env[name] for name in env if _KEPT.match(name) or not _SETTINGS.match(name)}
    # This variable keeps the ROS 2 wheels from starting every interpreter twice.
    return {**kept, "_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1"}


def of_configuration(env: Mapping[str, str]) -> Dict[str, str]:
    """Return, as environment variables, the settings in pip's configuration files that the installers may use.

    The set-up runs pip with PIP_CONFIG_FILE=/dev/null, because these files can also contain settings that `environment`
    would remove.
    """
    read = RawConfigParser()
    for file in configuration_files(env):
        with suppress(OSError, ValueError, configparser.Error):  # pip itself would stop at a malformed file
            read.read_string(file.read_text(encoding="utf-8"))
    found = {}
    for section in ("global", "install"):
        for name, value in read.items(section) if read.has_section(section) else ():
            variable = "PIP_" + name.upper().replace("-", "_")
            if _KEPT.match(variable):
                found[variable] = value
    return found


def configuration_files(env: Mapping[str, str], root: Path = Path("/")) -> List[Path]:
    """Return the paths of the configuration files that pip reads if they exist. A later file overrides an earlier one.

    If PIP_CONFIG_FILE names a file that exists, pip does not read the files in the user's home.
    """
    chosen = env.get("PIP_CONFIG_FILE")
    if chosen == os.devnull:
        return []
    home = Path(env.get("HOME", "/nowhere"))
    shared = (env.get("XDG_CONFIG_DIRS") or "/etc/xdg").split(os.pathsep)
    own = Path(env.get("XDG_CONFIG_HOME") or home / ".config")
    files = [*(root / place[1:] / "pip/pip.conf" for place in shared), root / "etc/pip.conf"]
    if not (chosen and os.path.exists(chosen)):  # noqa: PTH110 - like pip, without an error for a closed folder
        files += [home / ".pip/pip.conf", own / "pip/pip.conf"]
    return files + ([Path(chosen)] if chosen else [])
