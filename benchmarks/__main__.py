"""One table and one figure of Flexapod and other tools; with names, those benchmarks in depth."""

from __future__ import annotations

import argparse
import contextlib
import io
import os
import sys
from importlib import import_module
from pathlib import Path

from benchmarks import _figure, _results
from benchmarks._contest import Plan, Record, take_turns
from benchmarks._machine import keep_to_one_core, machine

HERE = Path(__file__).parent
TASKS = ("startup", "sweep", "poses", "calls", "modes", "dynamics", "simulate", "optimise", "certify", "web")
TURNS = 9
os.environ.setdefault("EXUDYN_MODULE", "fast")  # its build without range checks, which is 1.3 times as quick


def main() -> None:
    given = arguments()
    if given.names:
        in_depth(given.names)
        return
    out = HERE if given.update else given.out
    out.mkdir(parents=True, exist_ok=True)
    results = _results.load(given.redraw) if given.redraw else compare(given.only or TASKS, given.quick)
    _results.save(results, out / "results.json")
    (out / "table.md").write_text(_results.markdown(results))
    _figure.save(results, out)
    if given.update:
        (out / "table.md").unlink()  # it is in README.md
        _results.update(out / "README.md", results)
    _results.on_terminal(results)
    print(f"results.json, table and figure are in {out}")


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser("python -m benchmarks", description=__doc__)
    parser.add_argument("names", nargs="*", help="benchmarks to run in depth, each with a report of its own")
    parser.add_argument("--only", nargs="+", choices=TASKS, help="parts of the table")
    parser.add_argument("--quick", action="store_true", help="a few seconds, only to see that everything works")
    parser.add_argument("--out", type=Path, default=Path("out/benchmarks"), help="directory (default: %(default)s)")
    parser.add_argument("--update", action="store_true", help="write into benchmarks/ and its README.md instead")
    parser.add_argument("--redraw", type=Path, metavar="JSON", help="from an earlier results.json, measuring nothing")
    given = parser.parse_args()
    if given.update and given.quick:
        parser.error("--update wants real numbers; leave out --quick")
    return given


def compare(tasks: list[str] | tuple[str, ...], quick: bool) -> _results.Results:
    """Run the contests of these benchmarks on one core, turn by turn."""
    plan, turns = Plan(quick), 1 if quick else TURNS
    core = keep_to_one_core()
    records: list[Record] = []
    for name in tasks:
        with contextlib.redirect_stdout(io.StringIO()):  # of what other tools say while they load
            for contest in import_module(f"benchmarks.{name}").contests(plan):
                print(f"{contest.task} ...", file=sys.stderr, flush=True)
                records += take_turns(contest, turns)
    return _results.Results(machine(), core is not None, quick, turns, sorted(plan.absent), records)


def in_depth(names: list[str]) -> None:
    """Run benchmarks one after the other, by module name."""
    found = sorted(path.stem for path in HERE.glob("*.py") if not path.stem.startswith("_"))
    found = [name for name in found if hasattr(import_module(f"benchmarks.{name}"), "main")]
    unknown = [name for name in names if name not in found]
    if unknown:
        sys.exit(f"no benchmark {', '.join(unknown)}; there are {', '.join(found)}")
    for name in names:
        module = import_module(f"benchmarks.{name}")
        print(f"== {name}: {(module.__doc__ or '').splitlines()[0]}", flush=True)
        module.main()


if __name__ == "__main__":
    main()
