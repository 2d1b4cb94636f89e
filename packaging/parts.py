"""What goes into the frozen program, and what stays out: read by build.spec and by tests."""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
NAME = "nep-studio"
ID = "org.nep.studio"
"""Its name among all programs, for AppStream and macOS."""

FOLDERS = ("resources", "examples")
"""Shipped as they are, beside the program's code."""

DOCUMENTATION = "documentation"
"""The folder of the program with the pages for a browser, which tools/build_site.py makes."""

NOT_SHIPPED = (
    *("__pycache__", "node_modules", ".ruff_cache", "build", "make_fonts.py", ".gitignore"),
)
"""What a checkout's folders hold that nobody needs: parts of paths."""

OURS = ("faults", "nep_core", "nodes", "robots", "nep_studio")
"""Collected whole: jobs, panels, transports and nodes are imported by their names."""

LATE = ("sklearn.ensemble", "bleak", "mcap.reader", "mcap.writer", "zeroconf", "spake2")
"""Imported by name, or so late that it is said here."""

NOT_FOR_PROGRAMS = {
    *("antigravity", "cgi", "cgitb", "crypt", "distutils", "ensurepip", "idlelib", "imp"),
    *("lib2to3", "msilib", "nis", "nntplib", "ossaudiodev", "pydoc_data", "spwd", "telnetlib"),
    *("test", "this", "tkinter", "turtle", "turtledemo", "venv"),
}
"""Of the standard library: what needs files that are not here, or is on its way out."""

NEVER_USED = [
    *("tkinter", "PIL", "matplotlib", "IPython", "pandas", "pytest", "_pytest", "hypothesis"),
    *("mypy", "hatchling", "setuptools", "pkg_resources", "pip", "qi", "zenoh"),
    *("PySide6.QtTest", "PySide6.QtQml", "PySide6.QtQuick", "pyqtgraph.examples"),
    *("pyqtgraph.opengl", "pyqtgraph.jupyter"),
    # scikit-learn's forests need no more of SciPy and of itself than is left
    *("scipy.cluster", "scipy.io", "scipy.signal", "scipy.odr", "scipy.fftpack", "scipy.datasets"),
    *("sklearn.datasets", "sklearn.manifold", "sklearn.gaussian_process", "sklearn.inspection"),
]
"""Libraries take these when they find them; we never ask. The program says how to add zenoh."""

UNWANTED_FILES = (
    # GTK brings its libraries for native file dialogs; the rest are screens without windows
    *("libqgtk3", "libgtk-3", "libgdk-3", "libqeglfs", "egldeviceintegrations", "libqlinuxfb"),
    *("libqvnc", "libqminimal", "libQt6Egl", "plugins/generic", "plugins/networkinformation"),
    *("libatk-1", "libatk-bridge", "libatspi", "libcairo", "libepoxy", "libgdk_pixbuf", "libpango"),
    *("libpixman", "libharfbuzz", "libgraphite2", "libfribidi", "libthai", "libdatrie", "libgio-2"),
    *("libXcomposite", "libXcursor", "libXdamage", "libXi.", "libXinerama", "libXrandr"),
    *("libXext.", "libXfixes.", "libXrender.", "libgobject-2", "libgmodule-2", "libmount."),
    *("libblkid.", "libselinux.", "/libjpeg.", "libXau.", "libXdmcp.", "/libbsd.", "/libmd."),
    # whoever prints has CUPS; without it pages still become a PDF
    *("/libcups.", "/libavahi-", "/libgnutls", "/libp11-kit", "/libidn2", "/libunistring"),
    *("/libtasn1", "/libnettle", "/libhogweed", "/libgmp."),
    # a driver of the screen may need a newer one than that of the oldest system
    *("/libstdc++.so.6", "/libgcc_s.so.1"),
    *("sklearn/datasets", "sklearn/tests", "/tests/", "zstandard/_cffi"),
    "/direct_url.json",  # names a folder of the computer on which it was frozen
)
"""Parts of the paths of libraries and data that the recipes of others bring."""

WITH_DEBUG_DATA = ("libpython3*", "zstandard/*.so", "aiohttp/*.so", "lz4/**/*.so", "multidict/*.so")
"""Libraries that come with 40 MB of what only debuggers read; NumPy's may not be stripped."""

PROGRAMS = {
    "linux": {NAME: False},  # "nep" is a link to it there
    "darwin": {NAME: False},
    # a program with windows cannot write into a terminal there
    "win32": {"NEP Studio": False, NAME: True, "nep": True},
}
"""By system: the programs, which are one and the same, and whether each is for a terminal."""

TRANSLATIONS_KEPT = "qtbase_"
"""Of Qt's own translations: buttons of dialogs; the others are of parts that are not here."""

MACOS_PROPERTIES = {
    "NSHighResolutionCapable": True,
    "NSRequiresAquaSystemAppearance": False,
    "NSBluetoothAlwaysUsageDescription": "NEP Studio hears watches by Bluetooth.",
    "NSLocalNetworkUsageDescription": "NEP Studio reaches robots, phones and watches.",
    "CFBundleDocumentTypes": [
        {
            "CFBundleTypeName": "NEP Studio project",
            "CFBundleTypeExtensions": ["nep"],
            "CFBundleTypeRole": "Editor",
            "LSHandlerRank": "Owner",
        }
    ],
}
"""What macOS is told: why it asks for rights, and which files the program opens."""


def for_programs() -> list[str]:
    """The standard library, for programs made with blocks or by hand: no file of ours names it."""
    return sorted(
        name
        for name in sys.stdlib_module_names
        if not name.startswith("_") and name not in NOT_FOR_PROGRAMS
    )


def data_files() -> list[tuple[str, str]]:
    """Our own files: where each is, and the folder of the program in which it will be."""
    found = [path for folder in FOLDERS for path in (ROOT / folder).rglob("*")]
    # a node's code is shown to developers, and its manifest names it
    found += [path for path in (ROOT / "nodes").rglob("*") if path.suffix in (".py", ".toml")]
    return [
        (str(path), str(path.parent.relative_to(ROOT)))
        for path in sorted(found)
        if path.is_file() and is_shipped(path.relative_to(ROOT))
    ]


def made_files(folder: Path, goal: str) -> list[tuple[str, str, str]]:
    """What was made for the program: where it goes, where it is, and what PyInstaller calls it."""
    paths = sorted(path for path in folder.rglob("*") if path.is_file())
    return [(str(Path(goal, path.relative_to(folder))), str(path), "DATA") for path in paths]


def is_shipped(path: Path) -> bool:
    """Whether one of our files belongs into the program; ``path``: where in the checkout."""
    return not any(part in NOT_SHIPPED for part in path.parts)


def is_wanted(place: str) -> bool:
    """Whether a file that a recipe brings belongs into the program; ``place``: where in it."""
    path = "/" + place.replace("\\", "/")
    if "/translations/" in path and "PySide6" in path:
        return path.rsplit("/", 1)[1].startswith(TRANSLATIONS_KEPT)
    return not any(part in path for part in UNWANTED_FILES)
