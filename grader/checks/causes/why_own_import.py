"""Explain why an import from the student's own package failed: a folder is not installed, or imports are circular."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.common.words import nearest, shorten
from grader.submission.code import import_path, imported_files, module_file
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Collection

    from grader.checks.causes.crash_scene import CrashScene
    from grader.evidence.evidence import Evidence

CIRCULAR = re.compile(r"cannot import name '(?P<name>\w+)' from partially initialized module '(?P<module>[\w.]+)'")


def why_no_own_module(scene: CrashScene, name: str) -> Cause | None:
    """Return the cause if the module is in a folder of this package that the build does not install, else None."""
    files = scene.evidence.submission.files
    path = name.replace(".", "/")
    package = name.partition(".")[0]
    if "." in name and _has_modules(package, files) and not _has_modules(name, files):
        guess = nearest(name, [import_path(each).removesuffix(".py").replace("/", ".") for each in files], alike=0.8)
        if guess is None and module_file(name, files) is None:
            return Cause("module-missing", f"The package has no file {shorten(path)}.py.")
    # Python names the first part that it cannot import. If this part is a folder, the folder is not installed.
    setup = scene.evidence.setup_py
    if "." not in name or not _has_modules(name, files) or setup is None or setup.packages_line is None:
        return None
    if not setup.finds_packages:
        text = (
            f"The build does not install the folder {shorten(path)}. The packages argument of setup() lists the "
            "folders to install."
        )
        return Cause("module-not-installed", text, Where("setup.py", setup.packages_line))
    return without_init(scene.evidence, f"{path}/")


def without_init(evidence: Evidence, file: str) -> Cause | None:
    """Return the cause if find_packages leaves out the folder of the file, since it has no __init__.py, else None."""
    setup = evidence.setup_py
    if setup is None or not setup.finds_packages:
        return None
    known = {import_path(each) for each in evidence.submission.files}
    parts = import_path(file).split("/")[:-1]
    folders = ("/".join(parts[: end + 1]) for end in range(len(parts)))
    folder = next((each for each in folders if f"{each}/__init__.py" not in known), None)
    if folder is None:
        return None
    text = f"The folder {shorten(folder)} has no file __init__.py, so the build does not install it."
    return Cause("missing-init", text)


def _has_modules(folder: str, files: Collection[str]) -> bool:
    path = folder.replace(".", "/")
    return any(import_path(each).startswith(f"{path}/") and each.endswith(".py") for each in files)


def why_circular(scene: CrashScene) -> Cause | None:
    """Return the cause if two modules of this package import each other, or a module imports itself, else None."""
    found = CIRCULAR.search(scene.crash.message)
    file = module_file(found["module"], scene.evidence.submission.files) if found is not None else None
    if found is None or file is None or scene.module is None:
        return None
    here = scene.module.file
    name = file.rpartition("/")[2]
    if here == file:
        text = f"{name} imports itself. Remove this import: the names of a file can be used in it without an import."
        return Cause("name-too-early", text)
    other, files = scene.module_of(file), scene.evidence.submission.files
    how = "" if other is not None and here in imported_files(other, files) else " through other files"
    text = (
        f"{here.rpartition('/')[2]} and {name} import each other{how}, so {found['name']} does not exist yet when this "
        f"line needs it. Remove one of these imports, for example by moving {found['name']} to a separate file."
    )
    return Cause("name-too-early", text)
