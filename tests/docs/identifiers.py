#!/usr/bin/env python3
"""Lists the words in the names of types, functions and files that are in no dictionary and not explained.

A name is read word by word (StructurePosterior: structure, posterior). A word is known when it stands in an English
dictionary (Debian: wamerican, wbritish), in the glossary (shared/doc/notation.md), or in abbreviations.txt beside this
script. Prints the unknown words with the places of their first use, most used first; exit status 1 when there are any.

    tests/docs/identifiers.py            the unknown words
    tests/docs/identifiers.py --counts   only how many names, words and unknown words there are
"""
import argparse
import collections
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
DICTIONARIES = [pathlib.Path("/usr/share/dict/american-english"), pathlib.Path("/usr/share/dict/british-english")]
SOURCES = {".cpp", ".hpp", ".ts", ".tsx"}
FOLDERS = ("db/", "server/", "shared/", "station/", "web/src/")
# What is declared: types, functions, constants; not locals, whose scope is their explanation.
DECLARED = [
    re.compile(r"\b(?:class|struct|enum class|enum|interface|type|using)\s+([A-Za-z_]\w+)"),
    re.compile(r"^\s*(?:[\w:<>,&*\[\]\s]+?[\s&*])([a-z]\w+)\([^;{}]*\)\s*(?:const)?\s*(?:noexcept)?\s*(?:override)?\s*[;{]", re.M),
    re.compile(r"\b(?:function|const)\s+([A-Za-z]\w+)\s*[=(:<]"),
    re.compile(r"\bconstexpr\s+[\w:<>]+\s+k([A-Z]\w+)"),
]
# Names of libraries and of the operating system, which are theirs to choose.
FOREIGN = re.compile(r"^(?:curl_|fmi2[A-Z]|sqlite3_|crypto_|posix_|pthread_|archive_|libusb_|clock_|gmtime|sig(?:empty|add|wait)|randombytes|"
                     r"async_|gl[A-Z]|vtk|GlewError|namespace$|alignas$|tuple$|llt$|ldlt$|svd$|noexcept$|mmap$|madvise$)")


def words_of(name):
    """The words of a name in CamelCase or snake_case, in lower case; digits and single letters left out."""
    parts = re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+", name)
    return [part.lower() for part in parts if len(part) > 2]


def known_words():
    known = set()
    for path in DICTIONARIES:
        if not path.exists():
            sys.exit(f"identifiers: {path} is missing: install Debian's wamerican and wbritish")
        known.update(re.sub("'s$", "", line).lower() for line in path.read_text().split())
    glossary = (ROOT / "shared/doc/notation.md").read_text()
    known.update(word.lower() for word in re.findall(r"[A-Za-z]{3,}", glossary))
    for line in (pathlib.Path(__file__).parent / "abbreviations.txt").read_text().splitlines():
        if line and not line.startswith("#"):
            known.add(line.split()[0])
    return known


def names():
    """Every declared name and every file's name, each with the file."""
    kept = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]  # new files too
    listed = subprocess.run([*kept, *FOLDERS], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    for path in listed.split():
        if pathlib.Path(path).suffix not in SOURCES or not (ROOT / path).is_file() or "/generated/" in path:
            continue
        yield pathlib.Path(path).stem, path
        text = (ROOT / path).read_text()
        for pattern in DECLARED:
            for found in pattern.finditer(text):
                yield found[1], path


def is_known(word, known):
    if word in known:
        return True
    for ending in ("s", "es", "ed", "d", "ing", "er", "ers", "able", "ly", "ness"):
        stem = word.removesuffix(ending)
        if stem != word and len(stem) > 2 and (stem in known or stem + "e" in known or (stem[-1] == stem[-2] and stem[:-1] in known)):
            return True
    return any(word.startswith(prefix) and word.removeprefix(prefix) in known for prefix in ("un", "re", "pre", "non", "sub", "multi"))


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--counts", action="store_true", help="only the sums")
    options = arguments.parse_args()
    known = known_words()
    unknown, first, seen = collections.Counter(), {}, set()
    for name, path in names():
        if FOREIGN.match(name):
            continue
        seen.add(name)
        for word in words_of(name):
            if not is_known(word, known):
                unknown[word] += 1
                first.setdefault(word, f"{name} in {path}")
    if not options.counts:
        for word, times in unknown.most_common():
            print(f"{word:20} {times:4}  {first[word]}")
    print(f"{len(seen)} names, {len(unknown)} words unknown")
    sys.exit(1 if unknown else 0)


main()
