"""The processes that the suite starts: tractus-server, PostgreSQL, nginx. Each ends with this process."""
import ctypes
import os
import pwd
import shutil
import signal
import socket
import subprocess
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PR_SET_PDEATHSIG = 1
LIBC = ctypes.CDLL(None)


def free_port():
    with socket.socket() as tried:
        tried.bind(("127.0.0.1", 0))
        return tried.getsockname()[1]


def ends_with_us():
    LIBC.prctl(PR_SET_PDEATHSIG, signal.SIGTERM)


def wait_until(condition, seconds, what):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise RuntimeError(f"after {seconds} s still not: {what}")
        time.sleep(0.05)


def listens(port):
    with socket.socket() as tried:
        return tried.connect_ex(("127.0.0.1", port)) == 0


class Server:
    """One tractus-server on a data folder, at a port that it keeps when it is started again."""

    def __init__(self, binary, data, options, environment):
        self.binary, self.data, self.options, self.environment = binary, data, options, environment
        self.port, self.process = free_port(), None
        self.log = data.parent / f"{data.name}.log"

    def start(self):
        words = [self.binary, "serve", "--data", self.data, "--listen", f"127.0.0.1:{self.port}", *self.options]
        with open(self.log, "ab") as log:
            self.process = subprocess.Popen(list(map(str, words)), stdout=log, stderr=log, stdin=subprocess.DEVNULL,
                                            env=self.environment, preexec_fn=ends_with_us)
        wait_until(lambda: listens(self.port) or not self.alive(), 20, "the server listens")
        if not self.alive():
            raise RuntimeError(f"tractus-server does not start: {self.last_words()}")

    def alive(self):
        return self.process is not None and self.process.poll() is None

    def last_words(self):
        return self.log.read_bytes()[-600:].decode(errors="replace").strip() if self.log.exists() else ""

    def _status_bytes(self, field):
        for line in Path(f"/proc/{self.process.pid}/status").read_text().splitlines():
            if line.startswith(field):
                return int(line.split()[1]) * 1024
        return 0

    def resident_bytes(self):
        return self._status_bytes("VmRSS:")

    def peak_bytes(self):
        """The most memory since reset_peak (proc(5), clear_refs)."""
        return self._status_bytes("VmHWM:")

    def reset_peak(self):
        Path(f"/proc/{self.process.pid}/clear_refs").write_text("5")

    def stop(self, how=signal.SIGTERM):
        if self.alive():
            self.process.send_signal(how)
            try:
                self.process.wait(30)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()


class Postgres:
    """A cluster in a scratch folder, reached by a Unix socket alone, run by a user without privileges."""

    def __init__(self):
        found = sorted(Path("/usr/lib/postgresql").glob("*/bin/initdb"), key=lambda path: int(path.parts[-3]))
        if not found:
            raise RuntimeError("/usr/lib/postgresql holds none; install postgresql")
        self.programs, self.made = found[-1].parent, 0
        self.folder = Path(tempfile.mkdtemp(prefix="tractus-attack-pg-", dir="/tmp"))
        self.user = {}
        if os.geteuid() == 0:
            user = pwd.getpwnam("postgres")
            os.chown(self.folder, user.pw_uid, user.pw_gid)
            self.user = {"user": user.pw_uid, "group": user.pw_gid, "extra_groups": []}
        self._run("initdb", "-D", self.folder / "data", "-U", "tractus", "--auth=trust", "--encoding=UTF8", "--locale=C", "--no-sync")
        settings = {"listen_addresses": "", "unix_socket_directories": self.folder, "max_connections": 80, "fsync": "off",
                    "dynamic_shared_memory_type": "mmap", "log_min_messages": "warning"}
        words = [self.programs / "postgres", "-D", self.folder / "data"]
        for key, value in settings.items():
            words += ["-c", f"{key}={value}"]
        with open(self.folder.with_suffix(".log"), "wb") as log:
            self.process = subprocess.Popen(list(map(str, words)), stdout=log, stderr=log, preexec_fn=ends_with_us, **self.user)
        wait_until(lambda: self._psql("select 1", "postgres").returncode == 0, 30, "PostgreSQL answers")

    def _run(self, program, *words):
        ended = subprocess.run([self.programs / program, *map(str, words)], capture_output=True, text=True, cwd="/", **self.user)
        if ended.returncode != 0:
            raise RuntimeError(f"{program}: {ended.stderr.strip()}")

    def _psql(self, sql, database):
        return subprocess.run([self.programs / "psql", "-h", self.folder, "-U", "tractus", "-d", database, "-v", "ON_ERROR_STOP=1",
                               "-q", "-A", "-t", "-c", sql], capture_output=True, text=True, cwd="/")

    def run_sql(self, sql, database="postgres"):
        ended = self._psql(sql, database)
        if ended.returncode != 0:
            raise RuntimeError(f"psql: {sql[:80]}: {ended.stderr.strip()}")
        return [line.split("|") for line in ended.stdout.splitlines()]

    def add_database(self, template="template0"):
        self.made += 1
        name = f"attack_{self.made}"
        self.run_sql(f"create database {name} template {template}")
        return name

    def address(self, database):
        return f"postgresql:///{database}?host={self.folder}&user=tractus"

    def stop(self):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(30)
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.with_suffix(".log").unlink(missing_ok=True)


class Proxy:
    """nginx by the very configuration that deploy/large hands out."""

    def __init__(self, folder, server_ports, certificate_folder):
        self.port, self.folder = free_port(), folder
        folder.mkdir()
        servers = " ".join(f"127.0.0.1:{port}" for port in server_ports)
        settings = {"TRACTUS_SERVERS": servers, "TRACTUS_LISTEN": f"127.0.0.1:{self.port}", "TRACTUS_RUN": str(folder),
                    "TRACTUS_CERTIFICATE": str(certificate_folder / "server.pem"), "TRACTUS_KEY": str(certificate_folder / "server.key")}
        rendered = subprocess.run([ROOT / "deploy/large/render"], env=os.environ | settings, capture_output=True, check=True).stdout
        if os.geteuid() == 0:  # the workers of nginx are another user's; the scratch folder is root's alone
            rendered = b"user root;\n" + rendered
        (folder / "nginx.conf").write_bytes(rendered)
        words = ["nginx", "-e", folder / "start.log", "-p", folder, "-c", folder / "nginx.conf", "-g", "daemon off;"]
        self.process = subprocess.Popen(list(map(str, words)), preexec_fn=ends_with_us, stderr=subprocess.DEVNULL)
        wait_until(lambda: listens(self.port), 10, "nginx listens")

    def stop(self):
        self.process.terminate()
        self.process.wait(30)
