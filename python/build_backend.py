"""What pip asks for a wheel (PEP 517): builds the module with CMake and packs it. In the tree, because scikit-build-core is not in Debian 12, and a wheel is a zip with three texts.

    pip install .                                               builds in build/wheel: some minutes the first time
    pip install . --config-settings=build-dir=build/release     takes what scripts/build has built already
"""

import base64
import hashlib
import os
import re
import subprocess
import sysconfig
import sys
import tarfile
import tempfile
import tomllib
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def _project() -> dict:
    with (ROOT / "pyproject.toml").open("rb") as file:
        project = tomllib.load(file)["project"]
    project["version"] = re.search(r"project\(feldspar VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")).group(1)
    return project


def _metadata(project: dict, numpy: str = "numpy") -> str:
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {project['version']}", f"Summary: {project['description']}", f"License: {project['license']['text']}",
             f"Requires-Python: {project['requires-python']}"]
    lines += [f"Requires-Dist: {numpy if name == 'numpy' else name}" for name in project["dependencies"]]
    for extra, names in project["optional-dependencies"].items():
        lines += [f"Provides-Extra: {extra}"] + [f'Requires-Dist: {name} ; extra == "{extra}"' for name in names]
    return "\n".join(lines) + "\n\n" + "Documentation: docs/python.md in the repository.\n"


def _cmake(*arguments: str) -> None:
    # pip hides the installed packages from a build; CMake asks Python for none of them, but for where it is.
    environment = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "PYTHONNOUSERSITE")}
    subprocess.run(["cmake", *arguments], check=True, cwd=ROOT, env=environment)


def _configured(config_settings) -> Path:
    """The build directory, configured: some seconds."""
    build = (ROOT / (config_settings or {}).get("build-dir", "build/wheel")).resolve()
    if not (build / "CMakeCache.txt").exists():
        _cmake("-S", str(ROOT), "-B", str(build), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DFELDSPAR_TESTS=OFF", "-DFELDSPAR_BENCHMARKS=OFF", "-DFELDSPAR_PYTHON=ON", f"-DPython_EXECUTABLE={sys.executable}")
    return build


def _build(build: Path, prefix: str) -> None:
    _cmake("--build", str(build), "--parallel", str(len(os.sched_getaffinity(0))), "--target", "feldspar_python")
    _cmake("--install", str(build), "--component", "python", "--prefix", prefix, "--strip")


def _numpy_for(build: Path) -> str:
    """Which NumPy the module can be used with: pybind11 knows that of version 2 from 2.12 on, and Debian 12 has 2.10."""
    config = re.search(r"^pybind11_DIR:PATH=(/.+)$", (build / "CMakeCache.txt").read_text(encoding="utf-8"), re.MULTILINE)
    if not config:
        raise RuntimeError(f"{build} was configured without pybind11, so it has no Python module: scripts/install-dependencies, or another build-dir")
    version = re.search(r'set\(PACKAGE_VERSION "(\d+)\.(\d+)', (Path(config.group(1)) / "pybind11ConfigVersion.cmake").read_text(encoding="utf-8"))
    return "numpy" if (int(version.group(1)), int(version.group(2))) >= (2, 12) else "numpy<2"


def _tag() -> str:
    interpreter = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{interpreter}-{interpreter}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"


def _texts(project: dict, build: Path) -> dict:
    """What stands in the .dist-info directory of a wheel."""
    return {"METADATA": _metadata(project, _numpy_for(build)), "WHEEL": f"Wheel-Version: 1.0\nGenerator: feldspar build_backend\nRoot-Is-Purelib: false\nTag: {_tag()}\n"}


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    """Without it pip would build everything while it says that it prepares metadata."""
    project = _project()
    directory = Path(metadata_directory) / f"{project['name']}-{project['version']}.dist-info"
    directory.mkdir()
    for text, content in _texts(project, _configured(config_settings)).items():
        (directory / text).write_text(content, encoding="utf-8")
    return directory.name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    project = _project()
    build = _configured(config_settings)
    stem = f"{project['name']}-{project['version']}"
    texts = _texts(project, build)
    name = f"{stem}-{_tag()}.whl"
    with tempfile.TemporaryDirectory() as prefix:
        _build(build, prefix)
        files = {str(file.relative_to(prefix)): file.read_bytes() for file in sorted(Path(prefix).rglob("*")) if file.is_file()}
    if not any(file.endswith(sysconfig.get_config_var("EXT_SUFFIX")) for file in files):
        raise RuntimeError(f"{build} has no module for this Python ({sys.executable}): build with another build-dir")
    files |= {f"{stem}.dist-info/{text}": content.encode() for text, content in texts.items()}
    record = ""
    with zipfile.ZipFile(Path(wheel_directory) / name, "w", zipfile.ZIP_DEFLATED) as wheel:
        for file, content in files.items():
            info = zipfile.ZipInfo(file)   # without the time of day: the same tree gives the same wheel
            info.compress_type, info.external_attr = zipfile.ZIP_DEFLATED, (0o755 if ".so" in file else 0o644) << 16
            wheel.writestr(info, content)
            record += f"{file},sha256={base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b'=').decode()},{len(content)}\n"
        wheel.writestr(zipfile.ZipInfo(f"{stem}.dist-info/RECORD"), record + f"{stem}.dist-info/RECORD,,\n")
    return name


def build_sdist(sdist_directory, config_settings=None):
    project = _project()
    stem = f"{project['name']}-{project['version']}"
    tracked = subprocess.run(["git", "ls-files", "-z"], check=True, cwd=ROOT, capture_output=True).stdout.decode().split("\0")
    with tarfile.open(Path(sdist_directory) / f"{stem}.tar.gz", "w:gz") as archive:
        for file in filter(None, tracked):
            archive.add(ROOT / file, f"{stem}/{file}")
        with tempfile.NamedTemporaryFile("w", suffix="PKG-INFO") as metadata:
            metadata.write(_metadata(project))
            metadata.flush()
            archive.add(metadata.name, f"{stem}/PKG-INFO")
    return f"{stem}.tar.gz"
