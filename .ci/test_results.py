"""What GoogleTest's XML files of a folder hold: for count_tests.py and list_slow_tests.py."""

import xml.etree.ElementTree as xml


def cases_of(file):
    """The tests in a file; raises OSError or xml.ParseError."""
    return list(xml.parse(file).iter("testcase"))


def name_of(case):
    """As tests/slow.txt has it."""
    return f"{case.get('classname')}.{case.get('name')}"


def processor_seconds(case):
    return sum(float(p.get("value")) for p in case.iter("property") if p.get("name") == "processor_seconds")


def slow_tests(root):
    """The names in tests/slow.txt."""
    lines = (root / "tests" / "slow.txt").read_text().splitlines()
    return {line for line in lines if not line.startswith("#")}
