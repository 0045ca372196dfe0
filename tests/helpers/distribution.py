"""Do the two files of a release hold what they must, and no more?

python tests/helpers/distribution.py DIRECTORY
"""

import sys
import tarfile
import zipfile
from pathlib import Path, PurePosixPath

ROOT = Path(__file__).resolve().parents[2]
LARGEST = 5e6  # bytes
STRANGERS = (".git", ".github", ".ci", "node_modules", "__pycache__", "build", "out", "site")


def sources(*patterns: str) -> set[str]:
    """Files of the project that git would know: no caches, no compiled files."""
    found = [path for pattern in patterns for path in ROOT.glob(pattern)]
    kept = [path for path in found if path.is_file() and "__pycache__" not in path.parts and path.suffix != ".so"]
    return {path.relative_to(ROOT).as_posix() for path in kept}


def check(archive: Path, names: set[str], needed: set[str]) -> None:
    missing = sorted(needed - names)
    strange = sorted(name for name in names if set(PurePosixPath(name).parts) & set(STRANGERS))
    size = archive.stat().st_size
    if missing or strange or size > LARGEST:
        sys.exit(f"{archive.name} of {size} bytes (at most {LARGEST:.0f}). Missing: {missing}. Not wanted: {strange}.")
    print(f"{archive.name}: {len(names)} files, {size} bytes")


def main(directory: Path) -> None:
    (sdist,), (wheel,) = directory.glob("*.tar.gz"), directory.glob("*.whl")
    package = sources("src/flexapod/**/*")
    with tarfile.open(sdist) as file:
        names = {name.partition("/")[2] for name in file.getnames()}
    build = sources("src/core/**/*", "tests/**/*.py", "tests/data/*", "web/src/**/*")
    build |= {"CMakeLists.txt", "pyproject.toml"}
    check(sdist, names, package | build | {"LICENSE", "README.md", "CHANGELOG.md", "CITATION.cff"})
    with zipfile.ZipFile(wheel) as file:
        names = set(file.namelist())
    version = wheel.name.split("-")[1]
    check(
        wheel,
        names,
        {name.removeprefix("src/") for name in package} | {f"flexapod-{version}.dist-info/licenses/LICENSE"},
    )
    if not any(name.startswith("flexapod/_core.") and not name.endswith(".pyi") for name in names):
        sys.exit(f"{wheel.name} has no compiled core")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
