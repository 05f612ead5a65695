#!/usr/bin/env python3
"""Checks what the documents promise: every citation and every decision record can be found.

    tests/docs/documents_test.py            runs the checks; exit 1 when one fails

A citation is a word such as Horn1987 (author and year) in code or documents; it must be a key of shared/doc/bibliography.md.
A decision record is shared/doc/adr/NNNN-name.md; its number is unique, its first line is "# ADR-NNNN title", and
shared/doc/adr/README.md lists it. A relative link in a Markdown file must lead to a file.
"""
import pathlib
import re
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
ADR = ROOT / "shared/doc/adr"
TEXT = {".hpp", ".cpp", ".md", ".py", ".ts", ".tsx"}


def tracked(suffixes):
    kept = ["git", "-C", ROOT, "ls-files", "--cached", "--others", "--exclude-standard"]  # new files too
    listed = subprocess.run(kept, capture_output=True, text=True, check=True).stdout.splitlines()
    return [ROOT / name for name in listed if pathlib.Path(name).suffix in suffixes and (ROOT / name).exists()]


def text_of(path):
    return path.read_text(encoding="utf-8", errors="replace")


class Citations(unittest.TestCase):
    def test_every_citation_is_a_key_of_the_bibliography(self):
        bibliography = ROOT / "shared/doc/bibliography.md"
        keys = set(re.findall(r"^\| ([A-Za-z]+\d{4}[a-z]?) \|", text_of(bibliography), re.MULTILINE))
        self.assertGreater(len(keys), 30)
        unknown = {}
        for path in tracked(TEXT):
            if path in (bibliography, pathlib.Path(__file__).resolve()):
                continue
            for key in re.findall(r"\b([A-Z][A-Za-z]+(?:19|20)\d\d[a-z]?)\b", text_of(path)):
                if key not in keys:
                    unknown.setdefault(key, str(path.relative_to(ROOT)))
        self.assertEqual(unknown, {})


class DecisionRecords(unittest.TestCase):
    def records(self):
        return sorted(path for path in ADR.glob("*.md") if path.name != "README.md")

    def test_each_number_is_used_once(self):
        numbers = [path.name[:4] for path in self.records()]
        self.assertGreater(len(numbers), 20)
        self.assertEqual(sorted(numbers), sorted(set(numbers)))

    def test_each_first_line_has_number_and_title(self):
        for path in self.records():
            self.assertRegex(text_of(path).splitlines()[0], rf"^# ADR-{path.name[:4]} \S", path.name)

    def test_the_index_lists_each(self):
        listed = re.findall(r"\]\((\d{4}-[a-z0-9-]+\.md)\)", text_of(ADR / "README.md"))
        self.assertEqual(listed, [path.name for path in self.records()])

    def test_each_reference_to_a_record_resolves(self):
        numbers = {path.name[:4] for path in self.records()}
        unknown = {}
        for path in tracked(TEXT | {".sh", ".sql", ".txt"}):
            for number in re.findall(r"ADR-(\d{4})\b", text_of(path)):
                if number not in numbers:
                    unknown.setdefault(number, str(path.relative_to(ROOT)))
        self.assertEqual(unknown, {})


class Links(unittest.TestCase):
    def test_each_relative_link_leads_to_a_file(self):
        broken = []
        for path in tracked({".md"}):
            for target in re.findall(r"\]\(([^)#\s]+)", text_of(path)):
                if "://" not in target and not target.startswith("mailto:") and not (path.parent / target).exists():
                    broken.append(f"{path.relative_to(ROOT)}: {target}")
        self.assertEqual(broken, [])


class Paths(unittest.TestCase):
    def test_each_path_that_the_guides_name_exists(self):
        missing = []
        for name in ("CONTRIBUTING.md", "README.md", "shared/doc/architecture.md"):
            for path in re.findall(r"`((?:shared|server|station|db|web|tests|deploy)/[\w./-]+)`", text_of(ROOT / name)):
                if "NNNN" not in path and not (ROOT / path).exists():
                    missing.append(f"{name}: {path}")
        self.assertEqual(missing, [])


if __name__ == "__main__":
    unittest.main()
