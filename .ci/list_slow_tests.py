"""list_slow_tests.py SECONDS [FOLDER…]: tests/slow.txt anew, from the results of `./test --all` (default: build/test-results):
the tests that took more processor seconds, on a machine whose only Vulkan device is Mesa's CPU driver."""

import sys
from pathlib import Path

from test_results import cases_of, name_of, processor_seconds


def main():
    root = Path(__file__).parent.parent
    limit = float(sys.argv[1])
    folders = [Path(name) for name in sys.argv[2:]] or [root / "build" / "test-results"]
    names, all_seconds, left_out = set(), 0, 0
    for case in (c for folder in folders for file in sorted(folder.glob("*.xml")) for c in cases_of(file)):
        seconds, name = processor_seconds(case), name_of(case)
        all_seconds += seconds
        if seconds > limit and name not in names:
            left_out += seconds
            names.add(name)
    (root / "tests" / "slow.txt").write_text(
        f"# What ./test leaves out and ./test --all runs: tests that took more than {limit:g} processor seconds on Mesa's CPU driver,\n"
        f"# {left_out:.0f} of {all_seconds:.0f} in all. Made by .ci/list_slow_tests.py.\n"
        + "".join(f"{name}\n" for name in sorted(names)))


if __name__ == "__main__":
    main()
