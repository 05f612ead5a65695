#!/usr/bin/env python3
"""Lets programs of the packages crash while they serve, and has gdb say where they were: by function, file and line of the packages of symbols.

    deploy/packages && tests/packages/symbols.py --packages build/packages

It needs gdb. The programs are unpacked, not installed."""
import argparse
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/packages"))
from bare_debian import check  # noqa: E402

SOURCES = "/usr/src/tractus/"  # where deploy/cmake/Tractus.cmake says that the sources are
WAIT_S = 60


def unpacked(packages, name, folder):
    for package in (f"tractus-{name}", f"tractus-{name}-dbgsym"):
        found = sorted(packages.glob(f"{package}_*.deb"))
        check(len(found) == 1, f"{package}: {found[0].stat().st_size / 1e6 if found else 0:.1f} MB")
        subprocess.run(["dpkg-deb", "-x", found[0], folder], check=True)
    return folder / "usr/bin", folder / "usr/lib/debug"


def sections(program):
    return subprocess.run(["readelf", "-S", "--wide", program], check=True, capture_output=True, text=True).stdout


def crashed(words, debug):
    """What gdb says of all threads of a program that gets a signal of a crash while it serves."""
    watcher = subprocess.Popen(["gdb", "-batch", "-nx", "-iex", f"set debug-file-directory {debug}", "-ex", "run",
                                "-ex", "thread apply all backtrace", "--args", *map(str, words)],
                               stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                               env=os.environ | {"DEBUGINFOD_URLS": ""})
    said = []
    reader = threading.Thread(target=lambda: said.extend(watcher.stdout), daemon=True)
    reader.start()
    end = time.monotonic() + WAIT_S
    while not any("127.0.0.1" in line for line in said):
        if time.monotonic() > end or watcher.poll() is not None:
            raise SystemExit(f"{words[0]} does not serve: {''.join(said)[-1500:]}")
        time.sleep(0.1)
    children = Path(f"/proc/{watcher.pid}/task/{watcher.pid}/children").read_text().split()
    os.kill(int(children[-1]), signal.SIGSEGV)
    watcher.wait(WAIT_S)
    reader.join()
    return "".join(said)


def line_of(function, text):
    """Place of a function in a backtrace: file and line, or nothing."""
    found = re.search(rf"\b{function} \([^\n]*\)(?:\n\s+)? at {SOURCES}(\S+):(\d+)", text)
    return (found[1], int(found[2])) if found else None


def tried(program, debug, words):
    check(".debug_line" not in sections(program) and ".symtab" not in sections(program), f"{program.name} itself holds no symbols")
    text = crashed([program, *words], debug)
    place = line_of("main", text)
    check(place is not None and "SIGSEGV" in text, f"{program.name}: the backtrace of a crash names main at {place}" + ("" if place else f"\n{text[-3000:]}"))
    file, line = place
    source = (ROOT / file).read_text().splitlines()
    begins = next(number for number, content in enumerate(source, 1) if re.match(r"int main\(", content))
    check(begins < line <= len(source), f"which is in {file}: {source[line - 1].strip()}")
    own = set(re.findall(rf"at {SOURCES}(\S+):\d+", text))
    print(f"        files of ours in it: {len(own)}, functions {len(re.findall(f' at {SOURCES}', text))}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--packages", type=Path, required=True, help="folder that deploy/packages made")
    packages = parser.parse_args().packages
    with tempfile.TemporaryDirectory(prefix="tractus-symbols-") as name:
        folder = Path(name)
        programs, debug = unpacked(packages, "station", folder)
        tried(programs / "tractus-rig", debug, ["--port", "0"])
        programs, debug = unpacked(packages, "server", folder)
        subprocess.run([programs / "tractus-server", "init", "--data", folder / "data"], check=True, capture_output=True)
        tried(programs / "tractus-server", debug, ["serve", "--data", folder / "data", "--listen", "127.0.0.1:0", "--plain"])
    return 0


if __name__ == "__main__":
    sys.exit(main())
