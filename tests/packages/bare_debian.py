#!/usr/bin/python3
"""Installs the packages on a bare Debian 12 that boots with systemd in a container, and uses them as an administrator would.

    deploy/packages && sudo tests/packages/bare_debian.py --packages build/packages

It needs root, mmdebstrap and systemd-nspawn (packages mmdebstrap, systemd-container) and a Debian mirror. Steps: install the server, wait
until it answers; install station and tools, do a simulated trial; upgrade while it runs; an upgrade whose check fails; remove; purge.
"""
import argparse
import json
import os
import shutil
import signal
import ssl
import subprocess
import sys
import tempfile
import time
import urllib.request
from pathlib import Path

MOST_S = 120  # from `apt install` to a server that answers
PORT = 8480


def check(holds, what):
    print(("  ok    " if holds else "  WRONG ") + what, flush=True)
    if not holds:
        raise SystemExit(1)


class Machine:
    """A container: systemd as its first process, the network of this machine."""

    def __init__(self, root, packages):
        self.root = root
        self.log = open(root.parent / "console.log", "wb")
        self.process = subprocess.Popen(
            ["systemd-nspawn", "--quiet", "--register=no", "--keep-unit", f"--bind-ro={packages}:/repository", "-bD", str(root)],
            stdin=subprocess.DEVNULL, stdout=self.log, stderr=self.log)
        self.leader = self._leader()
        self.wait("systemctl is-system-running --wait | grep -qE 'running|degraded'", 120)

    def _leader(self):
        """Process 1 of the container: the child of systemd-nspawn's child."""
        end = time.monotonic() + 60
        while time.monotonic() < end:
            for child in subprocess.run(["pgrep", "-P", str(self.process.pid)], capture_output=True, text=True).stdout.split():
                if Path(f"/proc/{child}/comm").read_text().strip() == "systemd":
                    return child
            time.sleep(0.2)
        raise SystemExit(f"the container does not boot: {self.log.name}")

    def run(self, script, environment=()):
        words = ["nsenter", "--target", self.leader, "--mount", "--uts", "--ipc", "--pid", "--root", "--wd", "env", "-i",
                 "PATH=/usr/sbin:/usr/bin:/sbin:/bin", "DEBIAN_FRONTEND=noninteractive", "LC_ALL=C.UTF-8", *environment, "sh", "-c", script]
        return subprocess.run(words, capture_output=True, text=True)

    def must(self, script):
        ended = self.run(script)
        if ended.returncode != 0:
            raise SystemExit(f"{script}: exit {ended.returncode}\n{ended.stdout[-2000:]}{ended.stderr[-2000:]}")
        return ended.stdout

    def wait(self, script, seconds):
        end = time.monotonic() + seconds
        while self.run(script).returncode != 0:
            if time.monotonic() > end:
                raise SystemExit(f"after {seconds} s still not: {script}")
            time.sleep(0.5)

    def stop(self):
        os.kill(int(self.leader), signal.SIGRTMIN + 4)  # systemd(1): power off
        try:
            self.process.wait(60)
        except subprocess.TimeoutExpired:
            self.process.kill()


def bare_root(folder, given):
    """A minimal Debian 12, made by mmdebstrap or copied from a folder that it made before."""
    root = folder / "root"
    if given:
        shutil.copytree(given, root, symlinks=True)
        return root
    words = ["mmdebstrap", "--variant=minbase", "--include=systemd,systemd-sysv,dbus,ca-certificates", "bookworm", str(root)]
    for part in sorted(Path("/etc/apt/apt.conf.d").glob("*")):  # how this machine reaches a mirror
        if "Acquire::" in part.read_text(errors="replace"):
            words.insert(1, f"--aptopt={part}")
    subprocess.run(words, check=True, capture_output=True)
    return root


class Site:
    """The server in the machine, as a browser reaches it."""

    def __init__(self, machine):
        self.machine = machine
        self.cookie = None

    def ask(self, path, body=None):
        authority = self.machine.root / "var/lib/tractus/data/tls/authority.pem"
        context = ssl.create_default_context(cafile=str(authority))
        context.check_hostname = False
        headers = {"X-Tractus": "1", "Content-Type": "application/json"} | ({"Cookie": self.cookie} if self.cookie else {})
        request = urllib.request.Request(f"https://127.0.0.1:{PORT}{path}", headers=headers,
                                         data=None if body is None else json.dumps(body).encode())
        with urllib.request.urlopen(request, context=context, timeout=10) as answer:
            return answer.status, answer.headers, answer.read()

    def answers(self):
        try:
            return self.ask("/api/v1/health")[0] == 200
        except OSError:
            return False

    def wait(self, seconds=60):
        end = time.monotonic() + seconds
        while not self.answers():
            if time.monotonic() > end:
                raise SystemExit("the server does not answer: " + self.machine.run("journalctl -u tractus-server -o cat | tail -5").stdout)
            time.sleep(0.2)

    def sign_in(self, password):
        _, headers, _ = self.ask("/api/v1/session", {"name": "admin", "password": password})
        self.cookie = headers["Set-Cookie"].split(";")[0]


def repacked(packages, into, version, break_it=False):
    """tractus-server as of a later version; with `break_it`, one that finds that the data cannot be taken over."""
    into.mkdir()
    for name in ("tractus-server", "tractus-web"):
        tree = into / name
        subprocess.run(["dpkg-deb", "-R", next(packages.glob(f"{name}_*.deb")), tree], check=True)
        control = tree / "DEBIAN/control"
        text = control.read_text()
        old = next(line.split()[1] for line in text.splitlines() if line.startswith("Version:"))
        control.write_text(text.replace(f"Version: {old}", f"Version: {version}").replace(f"(= {old})", f"(= {version})"))
        if break_it and name == "tractus-server":
            program = tree / "usr/bin/tractus-server"
            program.write_text("#!/bin/sh\necho 'tractus-server: the database has schema 99' >&2\nexit 2\n")
        subprocess.run(["dpkg-deb", "--root-owner-group", "-b", tree, into], check=True, capture_output=True)
        shutil.rmtree(tree)


def run(machine, packages, folder):
    machine.must("cp /repository/tractus.gpg /usr/share/keyrings/ && sed 's#^URIs:.*#URIs: file:/repository#' /repository/tractus.sources "
                 ">/etc/apt/sources.list.d/tractus.sources")
    machine.must("apt-get update")
    check("tractus-server" in machine.must("apt-cache show tractus-server"), "apt takes the signed repository")
    before = time.monotonic()
    said = machine.must("apt-get install -y --no-install-recommends tractus-server 2>&1")
    site = Site(machine)
    site.wait()
    took_s = time.monotonic() - before
    check(took_s <= MOST_S, f"from `apt install tractus-server` to an answer: {took_s:.0f} s")
    check("admin-password" in said, "the installation says where the first password is")
    there = machine.must("dpkg-query -W -f '${Package}\n'").split()
    check(not {"gcc", "g++", "nodejs", "chromium", "cmake"} & set(there), f"no compiler, Node.js or Chromium among {len(there)} packages")
    password = machine.must("cat /etc/tractus/admin-password").strip()
    check(machine.must("stat -c '%a %U' /etc/tractus/admin-password /var/lib/tractus /var/lib/tractus/data").split("\n")[:3]
          == ["600 root", "700 tractus", "700 tractus"], "password and data are their owners' alone")
    site.sign_in(password)
    check(site.ask("/api/v1/session")[0] == 200, "the administrator signs in with it")
    check(b"<html" in site.ask("/")[2], "the pages are served")
    check(json.loads(machine.must("journalctl -u tractus-server -o cat -g '{' | tail -1")), "its log is in the journal, an object a line")
    check(machine.run("test -e /usr/share/man/man1/tractus-server.1.gz -a -e /usr/share/bash-completion/completions/tractus-server "
                      "-a -e /usr/share/doc/tractus-server/sbom.spdx.json -a -e /usr/share/doc/tractus-server/copyright").returncode == 0,
          "manual, completion, list of components and licence are there")
    machine.must("systemctl start tractus-backup.service")
    check(machine.must("ls /var/backups/tractus").strip() != "", "the nightly backup runs and is verified")

    machine.must("apt-get install -y --no-install-recommends tractus-station tractus-tools")
    check("simulated" in machine.must("runuser -u tractus-station -- tractus-station --device sim-rig --scenario soft --seed 1 --speed fast "
                                      "--data /var/lib/tractus-station/data 2>&1; tractus --version").lower(), "a station does a trial on the simulated rig")
    check(machine.run("test -e /lib/udev/rules.d/70-tractus.rules -a -e /etc/security/limits.d/70-tractus.conf").returncode == 0, "udev rule and limits are there")

    site.ask("/api/v1/cohorts", {"name": "year 1"})
    repacked(packages, folder / "next", "0.1.1~later")
    shutil.copytree(folder / "next", machine.root / "root/next")
    machine.must("dpkg -i /root/next/*.deb")
    site.wait()
    check(b"year 1" in site.ask("/api/v1/cohorts")[2], "an upgrade keeps data and sessions")
    repacked(packages, folder / "broken", "0.1.2~later", break_it=True)
    shutil.copytree(folder / "broken", machine.root / "root/broken")
    ended = machine.run("dpkg -i /root/broken/*.deb")
    check(ended.returncode != 0 and "the old version still runs" in ended.stderr, "an upgrade that cannot be done says so")
    check(site.answers() and b"year 1" in site.ask("/api/v1/cohorts")[2], "and the old version still answers")
    machine.must("dpkg -i /root/next/*.deb")
    site.wait()
    check(b"year 1" in site.ask("/api/v1/cohorts")[2], "the version before is installed again over it")

    machine.must("apt-get remove -y tractus-server")
    check(not site.answers() and machine.run("test -e /var/lib/tractus/data/tractus.db").returncode == 0, "removing it keeps the data")
    machine.must("apt-get purge -y tractus-server")
    check(machine.run("test -e /var/lib/tractus/data/tractus.db").returncode == 0, "purging it without an answer keeps them too")
    machine.must("apt-get install -y --no-install-recommends tractus-server")
    site.wait()
    site.sign_in(password)
    check(b"year 1" in site.ask("/api/v1/cohorts")[2], "installed again, it goes on with them")
    machine.must("apt-get install -y debconf-utils && echo 'tractus-server tractus-server/delete-data boolean true' | debconf-set-selections "
                 "&& apt-get purge -y tractus-server")
    check(machine.run("test -e /var/lib/tractus").returncode != 0, "purged with the answer to delete them, they are gone")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--packages", type=Path, required=True, help="folder that deploy/packages made")
    parser.add_argument("--root", type=Path, help="a minimal Debian 12 with systemd, copied instead of made")
    options = parser.parse_args()
    folder = Path(tempfile.mkdtemp(prefix="tractus-bare-", dir="/var/tmp"))
    machine = None
    try:
        machine = Machine(bare_root(folder, options.root), options.packages.resolve())
        run(machine, options.packages.resolve(), folder)
    finally:
        if machine:
            machine.stop()
        shutil.rmtree(folder, ignore_errors=True)
    print("installed, upgraded, removed: as it should be")


if __name__ == "__main__":
    sys.exit(main())
