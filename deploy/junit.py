#!/usr/bin/env python3
"""Counts a JUnit report and keeps what failed in it.

    deploy/junit.py WORDS REPORT FAILURES [PROGRAMS]

Prints "PASSED FAILED". The name of each failed test and the end of what it printed are appended to FAILURES, under WORDS.
A test of REPORT that is a whole program counts by its cases, if it wrote PROGRAMS/<its name>.xml. A program that failed
although each of its cases passed (it crashed at its end) is one more failure. A report that is missing, broken or empty is
one failure, and says so there.
"""
import os
import re
import sys
import xml.etree.ElementTree as ElementTree

LAST_LINES, LAST_CHARACTERS = 25, 2500  # of a failed test's output: enough for what was asked and what came


def told(case):
    """What a failed test case printed, its end."""
    parts = [part for tag in ("system-out", "system-err", "failure", "error") for part in case.iter(tag)]
    text = "\n".join(filter(None, (f"{part.get('message') or ''}\n{part.text or ''}".strip() for part in parts)))
    lines = re.sub(r"\x1b\[[0-9;]*m", "", text).splitlines()
    return "\n".join("   " + line for line in lines[-LAST_LINES:])[-LAST_CHARACTERS:]


def failed(case):
    return case.find("failure") is not None or case.find("error") is not None or case.get("status") == "fail"


def count(root):
    number = {key: int(root.get(key) or 0) for key in ("tests", "failures", "errors", "skipped", "disabled")}
    bad = number["failures"] + number["errors"]
    return number["tests"] - bad - number["skipped"] - number["disabled"], bad


def with_programs(root, programs):
    """Passed, failed, and the failed cases, of the report and of the programs that wrote their own."""
    passed, bad = count(root)
    faults = []
    for case in root.iter("testcase"):
        path = os.path.join(programs, f"{case.get('name')}.xml") if programs else ""
        if not os.path.exists(path):
            faults += [case] if failed(case) else []
            continue
        own = list(ElementTree.parse(path).getroot().iter("testcase"))
        own_faults = [one for one in own if failed(one)]
        own_passed = sum(one.get("result") == "completed" for one in own) - len(own_faults)
        if failed(case) and not own_faults:
            own_faults = [case]
        passed, bad = passed + own_passed - (not failed(case)), bad + len(own_faults) - failed(case)
        faults += own_faults
    return passed, bad, faults


def main(words, report, failures, programs=None):
    faults, note = [], ""
    try:
        passed, bad, faults = with_programs(ElementTree.parse(report).getroot(), programs)
    except (OSError, ElementTree.ParseError, ValueError) as error:
        passed, bad = 0, 1
        note = f"{words}: no report to read ({error})"
    else:
        note = "" if passed + bad else f"{words}: the report holds no test"
        bad = bad if passed + bad else 1
    with open(failures, "a", encoding="utf-8") as out:
        if note:
            out.write(f"FAILED: {note}\n")
        for case in faults:
            out.write(f"FAILED: {words}: {case.get('classname') or ''} {case.get('name')}\n{told(case)}\n")
    print(passed, bad)


if __name__ == "__main__":
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__.strip())
    main(*sys.argv[1:])
