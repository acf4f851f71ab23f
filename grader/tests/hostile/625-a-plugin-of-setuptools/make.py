"""The folder of the package contains metadata with a plugin, which setuptools loads in setup.py."""

PLUGIN = """
import atexit
from pathlib import Path


def replace_the_module():
    for file in Path("/ws/install").glob("*/lib/python*/site-packages/*/draw_circle.py"):
        file.write_text("raise SystemExit('TRA' 'CE of another module')")


def finalize(distribution):
    atexit.register(replace_the_module)
"""


def make(package):
    metadata = package / "plugin-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: plugin\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text("[setuptools.finalize_distribution_options]\nplugin = plugin:finalize\n")
    (package / "plugin.py").write_text(PLUGIN)
