#!/usr/bin/env python3
"""An S3 server for tests: Ceph's RADOS gateway before a monitor and one OSD that holds its objects in memory.

    rados_gateway.py FOLDER PORT

Makes the cluster in FOLDER, which must not exist, with the user of AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY. Then each line of standard
input is a command, answered by "ready" and what it found:
    start      starts the gateway at 127.0.0.1:PORT, with the bucket "tractus": its process id. One that was killed is started again; what it
               stored is in the OSD
    etag KEY   what the cluster notes of an object, nothing if it is not there
    uploads    the number of uploads in parts that were begun and neither completed nor aborted
All ends with standard input, hence with the parent.
"""
import ctypes
import hashlib
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
import uuid
from pathlib import Path

PR_SET_PDEATHSIG = 1
LIBC = ctypes.CDLL(None)
PROGRAMS = ("ceph", "ceph-authtool", "ceph-mon", "ceph-osd", "monmaptool", "radosgw", "radosgw-admin", "curl")
BUCKET = "tractus"

CONFIGURATION = """
[global]
fsid = {fsid}
mon host = v2:127.0.0.1:{monitor_port}
mon initial members = a
public network = 127.0.0.0/8
ms bind ipv6 = false
keyring = {folder}/keyring
auth allow insecure global id reclaim = false
osd pool default size = 1
osd pool default min size = 1
osd pool default pg num = 8
osd pool default pgp num = 8
osd crush chooseleaf type = 0
osd objectstore = memstore
memstore device bytes = 8589934592
mon allow pool size one = true
mon max pg per osd = 1000
mon data avail crit = 1
mon data avail warn = 2
run dir = {folder}/run
crash dir = {folder}/run
admin socket = {folder}/run/$name.$pid.asok
log file = {folder}/$name.log
[mon.a]
mon data = {folder}/mon
[osd.0]
osd data = {folder}/osd
[client.rgw]
rgw data = {folder}/rgw
rgw frontends = beast endpoint=127.0.0.1:{port}
"""


def ends_with_us():
    LIBC.prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def free_port():
    with socket.socket() as tried:
        tried.bind(("127.0.0.1", 0))
        return tried.getsockname()[1]


class Cluster:
    def __init__(self, folder, port):
        self.folder, self.port, self.gateway, self.daemons = folder, port, None, []
        for name in ("mon", "osd", "rgw", "run"):
            (folder / name).mkdir(parents=True)
        self.monitor_port, self.fsid = free_port(), str(uuid.uuid4())
        self.configuration = folder / "ceph.conf"
        self.configuration.write_text(
            CONFIGURATION.format(folder=folder, port=port, monitor_port=self.monitor_port, fsid=self.fsid))

    def run(self, program, *words, **more):
        return subprocess.run([program, *map(str, words)], check=True, capture_output=True, text=True, timeout=120,
                              env={**os.environ, "CEPH_CONF": str(self.configuration)}, **more).stdout

    def daemon(self, program, *words):
        with open(self.folder / "daemons.log", "ab") as log:
            process = subprocess.Popen([program, "-c", self.configuration, "-f", *words], stdout=log, stderr=log,
                                       stdin=subprocess.DEVNULL, preexec_fn=ends_with_us)
        self.daemons.append(process)
        return process

    def make(self):
        keyring, monitors = self.folder / "keyring", self.folder / "monmap"
        self.run("ceph-authtool", "--create-keyring", keyring, "--gen-key", "-n", "mon.", "--cap", "mon", "allow *")
        for name in ("client.admin", "client.rgw"):
            self.run("ceph-authtool", keyring, "--gen-key", "-n", name, "--cap", "mon", "allow *", "--cap", "osd", "allow *")
        self.run("monmaptool", "--create", "--fsid", self.fsid, "--addv", "a", f"[v2:127.0.0.1:{self.monitor_port}]", monitors)
        self.run("ceph-mon", "-i", "a", "--mkfs", "--monmap", monitors, "--keyring", keyring)
        self.daemon("ceph-mon", "-i", "a")
        osd = str(uuid.uuid4())
        self.run("ceph", "osd", "new", osd)
        key = self.folder / "osd" / "keyring"
        key.write_text(self.run("ceph", "auth", "get-or-create", "osd.0", "mon", "allow *", "osd", "allow *"))
        self.run("ceph-osd", "-i", "0", "--mkfs", "--osd-uuid", osd, "--keyring", key)
        self.daemon("ceph-osd", "-i", "0", "--keyring", str(key))
        self.run("radosgw-admin", "-n", "client.rgw", "user", "create", "--uid", "tractus", "--display-name", "Tractus",
                 "--access-key", os.environ["AWS_ACCESS_KEY_ID"], "--secret-key", os.environ["AWS_SECRET_ACCESS_KEY"])

    def answers(self):
        try:
            urllib.request.urlopen(f"http://127.0.0.1:{self.port}/", timeout=5).close()
            return True
        except urllib.error.HTTPError:
            return True
        except OSError:
            return False

    def start_gateway(self):
        if self.gateway is not None:
            self.gateway.wait(60)  # whoever starts it again has killed it
        self.gateway = self.daemon("radosgw", "-n", "client.rgw")
        end = time.monotonic() + 120
        while not self.answers():
            if self.gateway.poll() is not None or time.monotonic() > end:
                raise RuntimeError(f"the gateway does not start: {self.folder}/client.rgw.log")
            time.sleep(0.05)
        self.request("PUT", f"/{BUCKET}")
        return self.gateway.pid

    def request(self, method, path):
        """A signed request without a body, by curl; the credentials by its standard input, where nobody else reads them."""
        user = f'user = "{os.environ["AWS_ACCESS_KEY_ID"]}:{os.environ["AWS_SECRET_ACCESS_KEY"]}"\n'
        return self.run("curl", "--silent", "--show-error", "--fail", "--config", "-", "--aws-sigv4", "aws:amz:us-east-1:s3", "--request", method,
                        "--header", f"x-amz-content-sha256: {hashlib.sha256().hexdigest()}", f"http://127.0.0.1:{self.port}{path}", input=user)

    def etag(self, key):
        found = subprocess.run(["radosgw-admin", "-c", self.configuration, "-n", "client.rgw", "object", "stat", f"--bucket={BUCKET}",
                                f"--object={key}"], capture_output=True, text=True, timeout=60)
        return json.loads(found.stdout)["etag"].rstrip("\0") if found.returncode == 0 else ""

    def uploads(self):
        return self.request("GET", f"/{BUCKET}?uploads=").count("<UploadId>")

    def answer(self, words):
        if words == ["start"]:
            return self.start_gateway()
        return self.etag(words[1]) if words[0] == "etag" else self.uploads()

    def stop(self):
        for process in reversed(self.daemons):
            process.kill()
            process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)


def main():
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("rados_gateway: ended by a signal"))  # nothing is left behind
    missing = [program for program in PROGRAMS if shutil.which(program) is None]
    if missing:
        sys.exit(f"rados_gateway: no {', '.join(missing)}: install the packages radosgw, ceph-mon, ceph-osd and curl")
    cluster = Cluster(Path(sys.argv[1]), int(sys.argv[2]))
    try:
        cluster.make()
        for line in sys.stdin:
            print("ready", cluster.answer(line.split()), flush=True)
    except subprocess.CalledProcessError as failure:
        sys.exit(f"rados_gateway: {' '.join(failure.cmd)}: {failure.stderr}")
    finally:
        cluster.stop()


if __name__ == "__main__":
    main()
