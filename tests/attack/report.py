"""The list of attacks, their order, and what became of each: printed as it goes, and as JUnit XML at the end."""
import time
import traceback
import xml.etree.ElementTree as ElementTree

ATTACKS = []  # (words, function), in the order in which the modules are imported


class Worked(Exception):
    """The attack did what it must not be able to do."""


class NotTried(Exception):
    """This machine cannot try the attack; the text says why."""


def attack(words):
    """Adds a function to the list. `words`: what the attacker tries, as a plain sentence."""
    def add(function):
        ATTACKS.append((words, function))
        return function
    return add


def expect(condition, what):
    """The attack has worked unless the condition holds. `what`: what was seen, for the report."""
    if not condition:
        raise Worked(what)


def outcome_of(function, world):
    """("held" | "WORKED" | "not tried" | "broke", text)"""
    try:
        world.begin_attack()
        try:
            function(world)
        finally:
            seen = world.end_attack()
    except Worked as worked:
        after = "; ".join(seen) if "seen" in locals() and seen else ""
        return "WORKED", f"{worked}{'; ' + after if after else ''}"
    except NotTried as why:
        return "not tried", str(why)
    except Exception:  # the suite itself failed: that is a failure too, told apart from an attack that worked
        return "broke", traceback.format_exc(limit=6)
    return ("WORKED", "; ".join(seen)) if seen else ("held", "")


class Report:
    def __init__(self, suite):
        self.suite, self.cases = suite, []

    def run(self, world, only=""):
        for words, function in ATTACKS:
            if only and only not in f"{function.__module__}.{function.__name__}":
                continue
            print(f"   {words} …", flush=True)
            began = time.monotonic()
            outcome, text = outcome_of(function, world)
            took_s = time.monotonic() - began
            self.cases.append((words, function.__module__, outcome, text, took_s))
            print(f"      {outcome} ({took_s:.1f} s){': ' + text if text else ''}", flush=True)

    def failed(self):
        return [case for case in self.cases if case[2] in ("WORKED", "broke")]

    def write(self, path):
        not_tried = sum(case[2] == "not tried" for case in self.cases)
        root = ElementTree.Element("testsuite", name=self.suite, tests=str(len(self.cases)), errors="0",
                                   failures=str(len(self.failed())), skipped=str(not_tried), disabled="0")
        for words, module, outcome, text, took_s in self.cases:
            case = ElementTree.SubElement(root, "testcase", name=words, classname=f"{self.suite}.{module}", time=f"{took_s:.3f}")
            if outcome == "not tried":
                ElementTree.SubElement(case, "skipped", message=text)
            elif outcome != "held":
                last = text.splitlines()[-1] if text else ""
                ElementTree.SubElement(case, "failure", message=printable(f"{outcome}: {last}")).text = printable(text)
        ElementTree.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)


def printable(text):
    """XML 1.0 has no control characters."""
    return "".join(c if c in "\n\t" or 32 <= ord(c) < 0xD800 or 0xE000 <= ord(c) < 0xFFFE else "?" for c in text)
