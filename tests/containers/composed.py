#!/usr/bin/env python3
"""Starts the composition of deploy/large in containers, has two stations hand over trials to it, and kills its parts one after the other.

    deploy/packages && sudo tests/containers/composed.py --packages build/packages

It needs root, a Debian mirror, podman, netavark, iptables, runc, docker-compose and mmdebstrap; images and volumes are in a scratch folder.
No registry is asked:
debian:bookworm-slim is made by mmdebstrap, postgres:15 and nginx:1.22 are the stand-ins beside this file. Exit status 77: this machine runs no
containers; the reason is printed."""
import argparse
import hashlib
import os
import re
import resource
import shutil
import signal
import ssl
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
for folder in ("attack", "upgrade", "packages"):
    sys.path.insert(0, str(ROOT / "tests" / folder))
from bare_debian import check, minimal_debian, remove  # noqa: E402
from processes import ends_with_us, free_port, wait_until  # noqa: E402
from record import PIN, Site  # noqa: E402
from rolling_test import Station  # noqa: E402
from wire import Client, Target  # noqa: E402

SKIPPED = 77
MOST_START_S = 120
SERVERS = ("server-1", "server-2")
SUBNET = "subnet: 172.28.84.0/24"  # as in compose.yaml
GATEWAY = "172.28.84.1"  # as whom the proxy sees callers from this machine


def said(*words, environment=None):
    ended = subprocess.run(list(map(str, words)), capture_output=True, text=True, env=environment, stdin=subprocess.DEVNULL)
    if ended.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, words))}: exit {ended.returncode}\n{ended.stdout[-1500:]}{ended.stderr[-1500:]}")
    return ended.stdout


class Engine:
    """Podman with images, containers, volumes and networks in a folder of its own."""

    def __init__(self, folder):
        self.folder = folder
        most = {name: min(resource.getrlimit(kind)[1], 4096) for name, kind in (("nofile", resource.RLIMIT_NOFILE), ("nproc", resource.RLIMIT_NPROC))}
        limits = ", ".join(f'"{name}={count}:{count}"' for name, count in most.items())
        files = {"CONTAINERS_STORAGE_CONF": f'[storage]\ndriver = "overlay"\ngraphroot = "{folder}/images"\nrunroot = "{folder}/run"\n',
                 "CONTAINERS_REGISTRIES_CONF": 'unqualified-search-registries = ["docker.io"]\n',
                 "CONTAINERS_CONF": f'[containers]\ndefault_ulimits = [{limits}]\n[engine]\nruntime = "runc"\ncgroup_manager = "cgroupfs"\n'
                                    f'events_logger = "file"\n[network]\nnetwork_backend = "netavark"\nnetwork_config_dir = "{folder}/networks"\n'}
        self.environment = os.environ | {"DOCKER_HOST": f"unix://{folder}/podman.socket"}
        for name, text in files.items():
            (folder / f"{name.lower()}").write_text(text)
            self.environment[name] = str(folder / name.lower())
        self.service = subprocess.Popen(["podman", "system", "service", "--time", "0", self.environment["DOCKER_HOST"]], env=self.environment,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, preexec_fn=ends_with_us)

    def run(self, *words):
        return said("podman", *words, environment=self.environment)

    def build(self, containerfile, context, image, *options):
        """In a chroot: containers that are built want limits above those of some machines."""
        self.run("build", "--isolation", "chroot", "--network", "host", "--pull-never", "-f", containerfile, "-t", image, *options, context)

    def end(self):
        self.service.terminate()
        self.service.wait(30)
        for words in (("rm", "--all", "--force", "--time", "5"), ("network", "prune", "--force"), ("volume", "prune", "--force")):
            subprocess.run(["podman", *words], env=self.environment, capture_output=True)
        subprocess.run(["umount", "-q", "--lazy", self.folder / "images/overlay"], check=False)  # what ended last may still hold it


def images(engine, packages):
    """The image of tractus-server as deploy/large makes it, and what stands in for those of a registry."""
    base = engine.folder / "base.tar"
    minimal_debian(base, "ca-certificates")
    engine.run("import", base, "docker.io/library/debian:bookworm-slim")
    base.unlink()
    refused = subprocess.run(["podman", "run", "--rm", "debian:bookworm-slim", "true"], env=engine.environment, capture_output=True, text=True)
    if refused.returncode != 0:
        print(f"left out: this machine runs no containers: {refused.stderr.strip().splitlines()[-1]}")
        raise SystemExit(SKIPPED)
    here = Path(__file__).resolve().parent
    for target, image in (("nginx", "docker.io/library/nginx:1.22"), ("postgres", "docker.io/library/postgres:15")):
        engine.build(here / "Containerfile", here, image, "--target", target)
    engine.build(ROOT / "deploy/large/Containerfile", packages, "tractus-server")
    holds = engine.run("run", "--rm", "--entrypoint", "sh", "tractus-server", "-c", "id -u; ls /usr/bin; ls -a /srv/tractus /var/lib")
    check(holds.split()[0] == "8480" and not re.search(r"^(gcc|cc|node|cmake|tractus)$", holds, re.M),
          "the image runs as user 8480 and holds no compiler, no Node.js and no data folder")
    size = int(engine.run("image", "inspect", "--format", "{{.Size}}", "tractus-server"))
    print(f"        {size / 1e6:.0f} MB, {size / 1e6 - int(engine.run('image', 'inspect', '--format', '{{.Size}}', 'debian:bookworm-slim')) / 1e6:.0f} MB "
          "of them above debian:bookworm-slim")


class Composition:
    """deploy/large, as its compose.yaml says how to start it, at a free port."""

    def __init__(self, engine, packages):
        self.engine, self.port, self.folder = engine, free_port(), engine.folder / "site/deploy/large"
        (engine.folder / "site/build").mkdir(parents=True)
        (engine.folder / "site/build/packages").symlink_to(packages)
        shutil.copytree(ROOT / "deploy/large", self.folder)
        # docker-compose 1.29 takes Podman's note of how addresses are given out for a change of the network.
        (self.folder / "podman.yaml").write_text(f"networks: {{default: {{ipam: {{config: [{{{SUBNET}}}], options: {{driver: host-local}}}}}}}}\n")
        secrets = self.folder / "secrets"
        secrets.mkdir()
        password = os.urandom(24).hex()
        (secrets / "database-password").write_text(password)
        (secrets / "pgpass").write_text(f"database:5432:*:tractus:{password}\n")
        (secrets / "pgpass").chmod(0o600)
        os.chown(secrets / "pgpass", 8480, 8480)
        self.certificate = secrets / "certificate.pem"
        said("openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days", "2", "-subj", "/CN=sim",
             "-addext", "subjectAltName=IP:127.0.0.1", "-keyout", secrets / "certificate.key", "-out", self.certificate)
        self.environment = engine.environment | {"TRACTUS_PORT": str(self.port)}
        self.target = Target(self.port, str(self.certificate))
        self.over = threading.Event()
        threading.Thread(target=self.checks_health, daemon=True).start()

    def compose(self, *words):
        files = ("-f", self.folder / "compose.yaml", "-f", self.folder / "podman.yaml")
        return said("docker-compose", "--project-directory", self.folder, *files, *words, environment=self.environment)

    def checks_health(self):
        """Podman leaves the rhythm of health checks to systemd, which a container or a small machine may lack."""
        while not self.over.wait(1):
            subprocess.run(["podman", "healthcheck", "run", self.name("database")], env=self.environment, capture_output=True)

    def name(self, service):
        return f"large_{service}_1"

    def inside(self, service, *words):
        return self.engine.run("exec", self.name(service), *words)

    def state(self, service, field="{{.State.Pid}}"):
        return self.engine.run("inspect", "--format", field, self.name(service)).strip()

    def kill(self, service):
        """Its first process dies, as by the kernel when memory is short; nobody told Podman to stop it."""
        os.kill(int(self.state(service)), signal.SIGKILL)

    def answers(self):
        try:
            return Client(self.target, patience_s=5).ask("GET", "/health").status == 200
        except (OSError, ssl.SSLError):
            return False

    def served_by(self, from_line):
        """Addresses of the servers that answered a request with less than 500, by the proxy's log."""
        log = self.inside("proxy", "cat", "/tmp/nginx-access.log").splitlines()[from_line:]
        return {line.split()[-1] for line in log if re.search(r'" [1-4]\d\d \d', line)}

    def shares_work(self, what):
        so_far = len(self.inside("proxy", "cat", "/tmp/nginx-access.log").splitlines())
        wait_until(lambda: len(self.served_by(so_far)) == len(SERVERS), 60, what)
        check(True, f"{what}: {sorted(self.served_by(so_far))}")

    def sql(self, text):
        said_lines = self.inside("database", "setpriv", "--reuid=postgres", "--clear-groups", "psql", "-U", "tractus", "-d", "tractus", "-qAtc", text)
        return [line.split("|") for line in said_lines.splitlines()]

    def start(self):
        before = time.monotonic()
        made = self.compose("run", "--rm", "-T", "server-1", "init", "--data", "/srv/tractus/data", "--database",
                            "postgresql://tractus@database/tractus")
        self.compose("up", "--no-build", "-d")
        wait_until(self.answers, MOST_START_S, "a server answers through the proxy")
        print(f"        from images to a server that answers: {time.monotonic() - before:.0f} s")
        return re.search(r"shown only now: (\S+)", made)[1]


class Department(Site):
    """Accounts, assignments and two stations, all of whom know the proxy alone."""

    def __init__(self, composition, password):
        self.at, self.clients, self.passwords = composition, {}, {}
        self.server = composition.target
        self.sign_in("admin", password)
        self.add("fay", "faculty")
        self.stations = [self.at_work(number, name) for number, name in enumerate(("tom", "zoe"))]

    def nobody(self):
        return Client(self.at.target)

    def at_work(self, number, trainee):
        self.add(trainee, "trainee", badge=f"B-{number}", pin=PIN)
        cohort = self.clients["fay"].must("POST", "/cohorts", {"name": trainee})["id"]
        self.clients["admin"].must("POST", f"/cohorts/{cohort}/people", {"name": trainee})
        kinds = ("hard", "soft", "lateral_breach", "in_out_in")
        for week in range(4):
            self.clients["fay"].must("POST", "/assignments", {
                "title": f"{trainee} {week}", "cases": [{"scenario": {"tuned": kind}} for kind in kinds], "repeats": 20, "seed": week,
                "release": "at_once", "cohort": cohort})
        return Station([self.at.target], self.station(f"station-{number}").token, f"B-{number}", 1000 * number)

    def acknowledged(self):
        return self.stations[0].acknowledged | self.stations[1].acknowledged

    def wrong(self):
        return self.stations[0].wrong + self.stations[1].wrong

    def trains(self, more, what):
        goal = [len(station.acknowledged) + more for station in self.stations]
        before = time.monotonic()
        wait_until(lambda: self.wrong() or all(len(station.acknowledged) >= least for station, least in zip(self.stations, goal)), 120, what)
        check(not self.wrong(), f"{what}: {more} more trials of each station after {time.monotonic() - before:.1f} s {self.wrong()}")

    def ends(self):
        for station in self.stations:
            station.over.set()
        for station in self.stations:
            station.join(120)
        check(not self.wrong(), f"the stations end {self.wrong()}")


def loses_parts(at, department):
    for station in department.stations:
        station.start()
    department.trains(3, "with all parts")
    at.shares_work("both servers answer")
    for service in (*SERVERS, "database", "proxy"):
        pid = at.state(service)
        at.kill(service)
        wait_until(lambda: at.state(service) not in (pid, "0"), 60, f"{service} is started again")
        department.trains(3, f"{service} killed")
        if service in SERVERS:
            at.shares_work(f"{service} answers again behind the proxy")
    at.engine.run("stop", "--time", "40", at.name("server-2"))
    department.trains(3, "server-2 stopped")
    at.engine.run("start", at.name("server-2"))
    at.shares_work("server-2 answers again after it was started")
    department.ends()


def keeps_all(at, department):
    wait_until(lambda: at.sql("select count(*) from jobs where state <> 'done'") == [["0"]], 120, "every job is done")
    acknowledged = department.acknowledged()
    check(dict(at.sql("select id, sha256 from trials where state = 'assessed'")) == acknowledged,
          f"all {len(acknowledged)} trials that were acknowledged are there, no other, and assessed")
    folder = Path(at.engine.run("volume", "inspect", "--format", "{{.Mountpoint}}", "large_data").strip()) / "data/objects"
    check(all(hashlib.sha256((folder / sha[:2] / sha[2:]).read_bytes()).hexdigest() == sha for sha in acknowledged.values()), "byte by byte")
    at.inside("server-1", "tractus-server", "verify", "--data", "/srv/tractus/data")
    check(True, "verify, in a container: database, files, audit trail hold")
    refusals = sum(len(station.refusals) for station in department.stations)
    print(f"        answers of 500 and more that stations got and asked again after: {refusals}")


def keeps_out(at):
    nobody = Client(at.target)
    check(nobody.ask("GET", "/server/metrics").status == 404, "the proxy keeps a server's own figures to itself")
    check(nobody.ask("GET", "/session").header("strict-transport-security") == "max-age=31536000", "browsers are told to use HTTPS")
    check(b"<html" in nobody.line.exchange(b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n").body, "the pages are served")
    tries = [Client(at.target).ask("POST", "/session", {"name": "admin", "password": "wrong password"}, headers={"X-Forwarded-For": f"203.0.113.{i}"})
             for i in range(12)]
    peers = at.sql("select distinct peer from audit where what = 'signIn'")
    check(peers == [[GATEWAY]], f"the audit trail has the callers' address, not the proxy's: {peers}")
    check(tries[-1].status == 429, "who guesses passwords is kept out, whatever address the caller claims to have")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--packages", type=Path, required=True, help="folder that deploy/packages made")
    packages = parser.parse_args().packages.resolve()
    if os.geteuid() != 0:
        print("left out: containers with a network of their own need root")
        return SKIPPED
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("ended by a signal"))  # containers outlive this program otherwise
    folder = Path(tempfile.mkdtemp(prefix="tractus-containers-", dir="/var/tmp"))
    engine = Engine(folder)
    try:
        images(engine, packages)
        at = Composition(engine, packages)
        department = Department(at, at.start())
        loses_parts(at, department)
        keeps_all(at, department)
        keeps_out(at)
    finally:
        engine.end()
        remove(folder)
    print("composed, killed in parts, complete: as it should be")
    return 0


if __name__ == "__main__":
    sys.exit(main())
