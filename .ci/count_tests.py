"""count_tests.py STATUS FOLDER: sums the GoogleTest XML files of a folder; suites.json there (ctest --show-only=json-v1)
says which suites must have left one.

Prints the failed tests with what they said, then one line `N passed, N failed[, N skipped]`. Exits with 1 on a failed test, on no test at
all, on a suite that left no results (it crashed or ran out of time), and where STATUS, of all that ran, is not 0. With
IRAD_TEST_QUICK set the tests of tests/slow.txt did not run, and it says how many those are; a run of all groups without it
fails where a name there is no test's.
"""

import json
import os
import sys
from pathlib import Path
from xml.etree.ElementTree import ParseError

from test_results import cases_of, name_of, slow_tests


def main():
    status, folder = int(sys.argv[1]), Path(sys.argv[2])
    quick = "IRAD_TEST_QUICK" in os.environ
    slow = slow_tests(Path(__file__).parent.parent)
    missing = set(slow)
    grouped = False
    passed = failed = skipped = 0
    for suite in [test["name"] for test in json.loads((folder / "suites.json").read_text())["tests"]]:
        try:
            cases = cases_of(folder / f"{suite}.xml")
        except (OSError, ParseError) as error:
            cases = []
            print(f"{suite}: no results ({error})")
        grouped |= suite.startswith("group_")
        missing -= set(map(name_of, cases))
        if not cases and not (quick and (folder / f"{suite}.xml").exists()):
            print(f"{suite}: FAILED, not one test ran")
            failed += 1
        for case in cases:
            failures = case.findall("failure") + case.findall("error")
            if failures:
                print(f"{suite}: FAILED {name_of(case)}")
                for failure in failures[:3]:
                    print("    " + (failure.text or failure.get("message")).strip()[:2000].replace("\n", "\n    "))
                failed += 1
            elif case.get("status") == "notrun" or case.get("result") in ("skipped", "suppressed"):
                skipped += 1
            else:
                passed += 1
    if grouped and not quick:
        for name in sorted(missing):
            print(f"tests/slow.txt: {name}: FAILED, there is no such test")
            failed += 1
    if quick:
        print(f"{len(slow)} slow tests (tests/slow.txt) were left out: ./test --all runs them, as CI does")
    if status != 0 and failed == 0:
        print(f"a step ended with status {status} although no test reported a failure")
        failed += 1
    if passed + failed == 0:
        print("no test ran")
        failed += 1
    print(f"{passed} passed, {failed} failed" + (f", {skipped} skipped" if skipped else ""))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
