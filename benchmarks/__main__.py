"""`python -m benchmarks [name ...]`: run every benchmark here, or those named. Each is a module with a `main()`."""

import sys
from importlib import import_module
from pathlib import Path


def run(names: list[str]) -> None:
    """Run benchmarks one after the other, by module name."""
    here = Path(__file__).parent
    found = sorted(path.stem for path in here.glob("*.py") if not path.stem.startswith("_"))
    unknown = [name for name in names if name not in found]
    if unknown:
        sys.exit(f"no benchmark {', '.join(unknown)}; there are {', '.join(found)}")
    for name in names or found:
        module = import_module(f"benchmarks.{name}")
        if hasattr(module, "main"):
            print(f"== {name}: {(module.__doc__ or '').splitlines()[0]}", flush=True)
            module.main()


if __name__ == "__main__":
    run(sys.argv[1:])
