"""Make sure that Blender's Python module finds the system libraries it links to, and say what to do where it does not.

On Debian and Ubuntu, missing libraries are fetched with the system's own package manager and unpacked into
``.venv/system-libraries``: no root rights needed, nothing installed on the machine. Elsewhere the names are printed.
"""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

FOLDER = Path(sys.prefix) / "system-libraries"

PACKAGES = {
    "libX11.so.6": ["libx11-6", "libxcb1", "libxau6", "libxdmcp6", "libbsd0", "libmd0"],
    "libXrender.so.1": ["libxrender1"],
    "libXfixes.so.3": ["libxfixes3"],
    "libXi.so.6": ["libxi6", "libxext6"],
    "libXext.so.6": ["libxext6"],
    "libXxf86vm.so.1": ["libxxf86vm1", "libxext6"],
    "libXt.so.6": ["libxt6"],
    "libxkbcommon.so.0": ["libxkbcommon0"],
    "libSM.so.6": ["libsm6", "libice6", "libuuid1"],
    "libICE.so.6": ["libice6"],
    "libuuid.so.1": ["libuuid1"],
    "libGL.so.1": ["libgl1", "libglvnd0", "libglx0"],
    "libGLX.so.0": ["libglx0", "libglvnd0"],
    "libGLdispatch.so.0": ["libglvnd0"],
    "libgomp.so.1": ["libgomp1"],
    "libstdc++.so.6": ["libstdc++6"],
}


def missing_libraries() -> list[str]:
    """Return the names of the shared libraries that Blender's module needs and the loader does not find."""
    found = importlib.util.find_spec("bpy")
    if found is None or found.origin is None:
        raise SystemExit("Blender's Python module (bpy) is not installed in this environment.")
    if shutil.which("ldd") is None:
        return []
    folder = Path(found.origin).parent
    names: set[str] = set()
    for library in folder.glob("*.so"):  # the plug-ins in lib/ need drivers that only some machines have
        text = subprocess.run(["ldd", str(library)], capture_output=True, text=True, check=False).stdout
        names.update(line.split()[0] for line in text.splitlines() if line.rstrip().endswith("not found"))
    return sorted(names)


def packages_for(names: list[str]) -> list[str]:
    """Return the Debian packages that hold the named libraries and what these need in turn."""
    return sorted({package for name in names for package in PACKAGES.get(name, [])})


def unpack(packages: list[str]) -> bool:
    """Fetch Debian packages without root rights and copy their libraries into the environment; tell whether it went."""
    if not packages or shutil.which("apt-get") is None or shutil.which("dpkg-deb") is None:
        return False
    print("Blender needs system libraries that this machine lacks; fetching into", FOLDER, *packages, sep="\n  ")
    with tempfile.TemporaryDirectory() as temporary:
        root = Path(temporary)
        for folder in ("lists/partial", "cache/archives/partial", "unpacked"):
            (root / folder).mkdir(parents=True)
        apt = ["apt-get", "-qq", "-o", f"Dir::State::lists={root / 'lists'}", "-o", f"Dir::Cache={root / 'cache'}"]
        if os.geteuid() == 0:
            apt += ["-o", "APT::Sandbox::User=root"]
        for command in ([*apt, "update"], [*apt, "download", *packages]):
            if subprocess.run(command, cwd=root, check=False).returncode:
                return False
        for package in root.glob("*.deb"):
            subprocess.run(["dpkg-deb", "-x", str(package), str(root / "unpacked")], check=True)
        FOLDER.mkdir(parents=True, exist_ok=True)
        for library in (root / "unpacked").rglob("*.so.*[0-9]"):
            shutil.copy2(library, FOLDER / library.name, follow_symlinks=True)
    return True


def main() -> int:
    """Check, mend where possible, and return 0 when Blender's module can be imported."""
    search = os.environ.get("LD_LIBRARY_PATH", "")
    if str(FOLDER) not in search.split(os.pathsep):
        os.environ["LD_LIBRARY_PATH"] = os.pathsep.join(filter(None, [str(FOLDER), search]))
    names = missing_libraries()
    if names and unpack(packages_for(names)):
        names = missing_libraries()
    if names:
        print(
            f"Blender's Python module cannot start: {', '.join(names)} not found on this machine.\n"
            "Install the libraries and try again. Debian, Ubuntu:\n"
            f"  apt-get install -y --no-install-recommends {' '.join(packages_for(names)) or 'libgl1 libsm6 libxi6'}",
            file=sys.stderr,
        )
        return 1
    trial = subprocess.run([sys.executable, "-c", "import bpy"], capture_output=True, text=True, check=False)
    if trial.returncode:
        print(f"Blender's Python module cannot start:\n{trial.stderr}", file=sys.stderr)
    return trial.returncode


if __name__ == "__main__":
    raise SystemExit(main())
