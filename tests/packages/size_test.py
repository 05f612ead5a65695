#!/usr/bin/env python3
"""Strips a copy of each program, as its package does, and holds its size against the largest that is allowed.

    tests/packages/size_test.py --bin build/release/bin"""
import argparse
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

MOST_BYTES = {"tractus-server": 20_000_000}


def stripped_bytes(program):
    with tempfile.TemporaryDirectory() as folder:
        copy = shutil.copy(program, folder)
        subprocess.run(["strip", copy], check=True)
        return Path(copy).stat().st_size


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=Path, required=True, help="folder of the programs")
    folder, wrong = parser.parse_args().bin, 0
    for name, most in MOST_BYTES.items():
        size = stripped_bytes(folder / name)
        wrong += size > most
        print(f"{name}: {size / 1e6:.1f} MB stripped, at most {most / 1e6:.0f} MB{'' if size <= most else ': TOO LARGE'}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
