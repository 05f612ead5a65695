#!/usr/bin/env python3
"""Counts a JUnit report and keeps what failed in it.

    deploy/junit.py WORDS REPORT FAILURES

Prints "PASSED FAILED". The name of each failed test and the end of what it printed are appended to FAILURES, under WORDS.
A report that is missing, broken or empty is one failure, and says so there.
"""
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


def failed_cases(root):
    for case in root.iter("testcase"):
        if case.find("failure") is not None or case.find("error") is not None or case.get("status") == "fail":
            yield case


def count(root):
    number = {key: int(root.get(key) or 0) for key in ("tests", "failures", "errors", "skipped", "disabled")}
    bad = number["failures"] + number["errors"]
    return number["tests"] - bad - number["skipped"] - number["disabled"], bad


def main(words, report, failures):
    try:
        root = ElementTree.parse(report).getroot()
        passed, bad = count(root)
    except (OSError, ElementTree.ParseError, ValueError) as error:
        root, passed, bad = None, 0, 1
        note = f"{words}: no report to read ({error})"
    else:
        note = "" if passed + bad else f"{words}: the report holds no test"
        bad = bad if passed + bad else 1
    with open(failures, "a", encoding="utf-8") as out:
        if note:
            out.write(f"FAILED: {note}\n")
        for case in failed_cases(root) if root is not None else ():
            out.write(f"FAILED: {words}: {case.get('classname') or ''} {case.get('name')}\n{told(case)}\n")
    print(passed, bad)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__.strip())
    main(*sys.argv[1:])
