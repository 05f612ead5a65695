#!/usr/bin/python3
"""Installs the packages on a bare Debian 12 that boots with systemd in a container, and uses them as an administrator would.

    deploy/packages && sudo tests/packages/bare_debian.py --packages build/packages

It needs root, mmdebstrap and systemd-nspawn (packages mmdebstrap, systemd-container) and a Debian mirror. Steps: install the server, wait
until it answers; install station and tools, do a simulated trial; upgrade while it runs; an upgrade whose check fails; remove; purge.
"""
import argparse
import contextlib
import json
import os
import re
import shutil
import signal
import sqlite3
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


def remove(folder):
    """Without what is still mounted in it: when mmdebstrap or Podman is killed, /dev/shm of this machine may be."""
    subprocess.run(["rm", "-rf", "--one-file-system", folder], check=False)


def minimal_debian(out, packages):
    """A minimal Debian 12 with some packages, as mmdebstrap makes it: a folder, or an archive if `out` ends in .tar."""
    words = ["mmdebstrap", "--variant=minbase", f"--include={packages}", "bookworm", str(out)]
    for part in sorted(Path("/etc/apt/apt.conf.d").glob("*")):  # how this machine reaches a mirror
        if "Acquire::" in part.read_text(errors="replace"):
            words.insert(1, f"--aptopt={part}")
    subprocess.run(words, check=True, capture_output=True)


def bare_root(folder, given):
    """A minimal Debian 12 that boots, made by mmdebstrap or copied from a folder that it made before."""
    root = folder / "root"
    if given:
        subprocess.run(["cp", "-a", given, root], check=True)  # with its device nodes
    else:
        minimal_debian(root, "systemd,systemd-sysv,dbus,ca-certificates")
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


LATER = "99"


def later(packages, folder):
    """A repository of the same packages as of a later version, whose settings differ in a comment."""
    folder.mkdir()
    for package in packages.glob("*.deb"):
        tree = folder / "tree"
        subprocess.run(["dpkg-deb", "-R", package, tree], check=True)
        control = tree / "DEBIAN/control"
        version = re.search(r"^Version: (.*)$", control.read_text(), re.M)[1]
        control.write_text(control.read_text().replace(f"Version: {version}", f"Version: {LATER}").replace(f"(= {version})", f"(= {LATER})"))
        for settings in tree.glob("etc/tractus/*.conf"):
            settings.write_text("# Later.\n" + settings.read_text())
        subprocess.run(["dpkg-deb", "--root-owner-group", "-Zgzip", "-z1", "-b", tree, folder], check=True, capture_output=True)
        shutil.rmtree(tree)
    listed = subprocess.run(["apt-ftparchive", "packages", "."], cwd=folder, check=True, capture_output=True)
    (folder / "Packages").write_bytes(listed.stdout)


def installs(machine, site):
    machine.must("cp /repository/tractus.gpg /usr/share/keyrings/ && sed 's#^URIs:.*#URIs: file:/repository#' /repository/tractus.sources "
                 ">/etc/apt/sources.list.d/tractus.sources")
    before = time.monotonic()
    machine.must("apt-get update")
    check("tractus-server" in machine.must("apt-cache show tractus-server"), "apt takes the signed repository")
    said = machine.must("apt-get install -y tractus-server 2>&1")
    site.wait()
    took_s = time.monotonic() - before
    check(took_s <= MOST_S, f"from `apt-get update` to a server that answers: {took_s:.0f} s")
    check("admin-password" in said, "the installation says where the first password is")
    check(machine.must("systemctl is-active tractus-server tractus-backup.timer").split() == ["active", "active"], "its units are active")
    check(machine.must("stat -c '%a %U' /etc/tractus/admin-password /var/lib/tractus /var/lib/tractus/data").split("\n")[:3]
          == ["600 root", "700 tractus", "700 tractus"], "password and data are their owners' alone")
    before = time.monotonic()
    machine.must("apt-get install -y tractus-station tractus-tools")
    took_s = time.monotonic() - before
    check(took_s <= MOST_S, f"station and tools: {took_s:.0f} s")
    there = machine.must("dpkg-query -W -f '${Package}\n'").split()
    foreign = [name for name in there if re.fullmatch(r"gcc|g\+\+|(gcc|g\+\+|clang|chromium|nodejs|cmake)(-[0-9]+)?", name)]
    check(not foreign, f"no compiler, Node.js or Chromium among {len(there)} packages {' '.join(foreign)}")


def is_used(machine, site, password):
    site.sign_in(password)
    check(site.ask("/api/v1/session")[0] == 200, "the administrator signs in with the first password")
    check(b"<html" in site.ask("/")[2], "the pages are served")
    site.ask("/api/v1/cohorts", {"name": "year 1"})
    check(json.loads(machine.must("journalctl -u tractus-server -o cat -g '{' | tail -1")), "the log is in the journal, an object a line")
    for program, package in (("tractus-server", "tractus-server"), ("tractus-station", "tractus-station"), ("tractus", "tractus-tools")):
        # A minimal Debian may leave documents out: what the package holds is asked of dpkg, what is said of the program itself.
        holds = machine.must(f"dpkg -L {package}").split()
        check({f"/usr/share/man/man1/{program}.1.gz", f"/usr/share/bash-completion/completions/{program}",
               f"/usr/share/doc/{package}/sbom.spdx.json", f"/usr/share/doc/{package}/copyright"} <= set(holds),
              f"{package}: manual, completion, list of components and licences")
    holds = machine.must("dpkg -L tractus-tools").split()
    check({f"/usr/lib/tractus/{name}" for name in ("tractus_model.so", "tractus_model_formulas.so", "licences.txt")} <= set(holds),
          "tractus-tools: what `tractus fmu` packs")
    machine.must("systemctl start tractus-backup.service")
    check(machine.must("ls /var/backups/tractus").strip() != "", "the nightly backup runs and is verified")
    trial = machine.must("runuser -u tractus-station -- tractus-station --device sim-rig --scenario soft --seed 1 --speed fast "
                         "--data /var/lib/tractus-station/data 2>&1")
    check("simulated" in trial.lower(), "a station does a trial on the simulated rig")
    check(machine.run("test -e /lib/udev/rules.d/70-tractus.rules -a -e /etc/security/limits.d/70-tractus.conf").returncode == 0,
          "udev rule and limits are there")


def completes(machine):
    machine.must("apt-get install -y bash-completion")
    said = machine.must("bash -ic '. /usr/share/bash-completion/completions/tractus-server; COMP_WORDS=(tractus-server se); COMP_CWORD=1; "
                        "_tractus; echo ${COMPREPLY[*]}; COMP_WORDS=(tractus-server serve --lis); COMP_CWORD=2; _tractus; echo ${COMPREPLY[*]}'")
    check(said.split() == ["serve", "--listen"], "the shell completes subcommands and options")


def database(machine, work):
    with contextlib.closing(sqlite3.connect(machine.root / "var/lib/tractus/data/tractus.db", timeout=10)) as connection:
        with connection:
            return work(connection)


def schema(connection):
    return connection.execute("select * from sqlite_master").fetchall(), connection.execute("select version from schema_versions").fetchall()


def upgrades(machine, site, folder):
    """First an upgrade whose migrations fail, then one that is done."""
    newest = database(machine, lambda it: it.execute("select * from schema_versions order by version desc limit 1").fetchone())
    database(machine, lambda it: it.execute("delete from schema_versions where version = ?", newest[:1]))  # its tables exist: it fails
    before = database(machine, schema)
    machine.must("echo '# ours' >>/etc/tractus/server.conf")
    shutil.copytree(folder / "later", machine.root / "srv/later")
    machine.must("echo 'deb [trusted=yes] file:/srv/later ./' >/etc/apt/sources.list.d/later.list && apt-get update")
    ended = machine.run("apt-get -y -o Dpkg::Options::=--force-confold upgrade 2>&1")
    check(ended.returncode != 0 and "the old version still runs" in ended.stdout, "an upgrade whose migrations fail says so")
    check(database(machine, schema) == before and site.answers() and b"year 1" in site.ask("/api/v1/cohorts")[2],
          "the data are as they were, and the old server answers")
    back = re.search(r"go back: (apt-get install .*)", ended.stdout)[1]
    database(machine, lambda it: it.execute(f"insert into schema_versions values ({','.join('?' * len(newest))})", newest))
    machine.must(back.replace("install", "install -y -o Dpkg::Options::=--force-confold", 1))
    site.wait()
    check(LATER not in machine.must("dpkg-query -W tractus-server").split() and b"year 1" in site.ask("/api/v1/cohorts")[2],
          "the command that it prints goes back to the version before")
    machine.must("apt-get -y -o Dpkg::Options::=--force-confold upgrade")
    site.wait()
    check(LATER in machine.must("dpkg-query -W tractus-server").split() and b"year 1" in site.ask("/api/v1/cohorts")[2],
          "an upgrade keeps data and sessions")
    settings = machine.must("cat /etc/tractus/server.conf")
    check("# ours" in settings and "# Later." not in settings and machine.run("grep -q Later /etc/tractus/server.conf.dpkg-dist").returncode == 0,
          "and the administrator's settings, with the new ones beside them")
    machine.must("systemctl disable --now tractus-server && apt-get install -y --reinstall tractus-server")
    check(machine.run("systemctl is-active tractus-server").returncode != 0, "a server that was switched off stays off")
    machine.must("systemctl enable --now tractus-server")
    site.wait()


def answer(package, delete):
    return f"echo '{package} {package}/delete-data boolean {delete}' | debconf-set-selections && "


def removes(machine, site, password):
    data = "test -e /var/lib/tractus/data/tractus.db"
    machine.must("apt-get remove -y tractus-server")
    check(not site.answers() and machine.run(data).returncode == 0, "removing it keeps the data")
    machine.must("apt-get purge -y tractus-server")
    check(machine.run(data).returncode == 0, "purging it without an answer keeps them too")
    machine.must("apt-get install -y tractus-server")
    site.wait()
    site.sign_in(password)
    check(b"year 1" in site.ask("/api/v1/cohorts")[2], "installed again, it goes on with them")
    machine.must(answer("tractus-server", "false") + "apt-get purge -y tractus-server")
    check(machine.run(data).returncode == 0, "purged with the answer to keep them, they are kept")
    machine.must("apt-get install -y tractus-server")
    machine.must(answer("tractus-server", "true") + "apt-get purge -y tractus-server")
    check(machine.run("test -e /var/lib/tractus -o -e /etc/tractus/admin-password").returncode != 0, "purged with the answer to delete them, they are gone")
    check(machine.must("ls /var/backups/tractus").strip() != "", "but for the backups")
    machine.must("apt-get purge -y tractus-station")
    check(machine.run("test -e /var/lib/tractus-station/data").returncode == 0, "a station's trials are kept the same way")


def run(machine, packages, folder):
    site = Site(machine)
    installs(machine, site)
    password = machine.must("cat /etc/tractus/admin-password").strip()
    is_used(machine, site, password)
    completes(machine)
    later(packages, folder / "later")
    upgrades(machine, site, folder)
    removes(machine, site, password)


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
        remove(folder)
    print("installed, upgraded, removed: as it should be")


if __name__ == "__main__":
    sys.exit(main())
