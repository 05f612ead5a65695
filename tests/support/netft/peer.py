"""A SIMULATED force/torque sensor and motion capture: plays a room of make_room.py. See README.md. Written from the vendor's
manual; shares no code with the product."""
import argparse
import http.server
import json
import pathlib
import socket
import struct
import subprocess
import sys
import threading
import time

PAGE = """<?xml version="1.0" encoding="ISO-8859-1"?><netft>
<prodname>SIMULATED Net F/T</prodname><setcfgsel>0</setcfgsel><cfgcalsn>SIM0001</cfgcalsn>
<cfgfu>{fu_code}</cfgfu><scfgfu>{fu}</scfgfu><cfgtu>{tu_code}</cfgtu><scfgtu>{tu}</scfgtu>
<cfgcpf>{cpf}</cfgcpf><cfgcpt>{cpt}</cfgcpt><comrdte>{rdt}</comrdte><comrdtrate>1000</comrdtrate><comrdtbsiz>1</comrdtbsiz>
</netft>"""


def page_server(page):
    class Page(http.server.BaseHTTPRequestHandler):
        def do_GET(self):
            body = page.encode() if self.path.split("?")[0] == "/netftapi2.xml" else b""
            self.send_response(200 if body else 404)
            self.send_header("Content-Type", "text/xml")
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, *_):
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Page)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return server.server_address[1]


class Sensor:
    """RDT: answers an 8-byte request (0x1234, command, count) with records of 36 bytes, high byte first."""

    def __init__(self, counts, drift, faults, on_start):
        self.counts, self.drift, self.faults, self.on_start = counts, drift, faults, on_start
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.setblocking(False)
        self.client, self.bias, self.started, self.sent, self.kept, self.dead = None, [0] * 6, None, 0, None, False
        self.log = {"starts": 0, "stops": 0, "biases": 0, "bad_requests": 0, "dropped": 0, "swapped": 0}

    def listen(self):
        while not self.dead:
            try:
                request, sender = self.socket.recvfrom(64)
            except BlockingIOError:
                return
            if len(request) != 8 or struct.unpack(">H", request[:2])[0] != 0x1234:
                self.log["bad_requests"] += 1
                continue
            command, count = struct.unpack(">HI", request[2:])
            if command == 0x0002 and self.client is None:
                self.client, self.started, self.sent = sender, time.monotonic_ns(), 0
                self.log["starts"] += 1
                self.on_start(self.started)
            elif command == 0x0000:
                self.client = None
                self.log["stops"] += 1
            elif command == 0x0042:
                self.bias = self.counts[0]
                self.log["biases"] += 1

    def due(self):
        """How many samples should have been sent by now: the sensor's clock runs fast by its drift."""
        return int((time.monotonic_ns() - self.started) * 1e-6 * (1 + self.drift)) + 1

    def status(self, n):
        fault = self.faults.get("status")
        if not fault:
            return 0
        begin, end, bits = fault.split(":")
        return int(bits, 16) if float(begin) * 1000 <= n < float(end) * 1000 else 0

    def send(self, datagram):
        self.socket.sendto(datagram, self.client)

    def play(self):
        if self.client is None:
            return
        while self.client and self.sent < self.due():
            n = self.sent
            self.sent += 1
            if "die" in self.faults and n > float(self.faults["die"]) * 1000:
                self.client = None  # as if its power were gone: it neither sends nor listens
                self.dead = True
                return
            if "stall" in self.faults and n > float(self.faults["stall"]) * 1000:
                return
            values = [c - b for c, b in zip(self.counts[min(n, len(self.counts) - 1)], self.bias)]
            record = struct.pack(">III6i", n + 1, 7 * n, self.status(n), *values)
            if "lose" in self.faults and (n + 1) % int(self.faults["lose"]) == 0:
                self.log["dropped"] += 1
                continue
            if "cut" in self.faults and (n + 1) % int(self.faults["cut"]) == 0:
                record = record[:20]
            if "swap" in self.faults and (n + 1) % int(self.faults["swap"]) == 0:
                self.kept = record
                self.log["swapped"] += 1
                continue
            self.send(record)
            if self.kept:
                self.send(self.kept)
                self.kept = None
            self.listen()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("room", type=pathlib.Path)
    parser.add_argument("--igtl", help="the program igtl_room")
    parser.add_argument("--type", default="TRANSFORM", choices=["TRANSFORM", "TDATA", "QTDATA"])
    parser.add_argument("--fault", action="append", default=[],
                        help="of the sensor: lose=N swap=N cut=N status=FROM:TO:HEX stall=S die=S rdt=Disabled fu=UNIT; of the "
                             "capture: damage=N close=S hush=S busy pictures=N")
    args = parser.parse_args()
    faults = dict(f.split("=", 1) if "=" in f else (f, "1") for f in args.fault)
    truth = json.loads((args.room / "truth.json").read_text())
    counts = [[int(v) for v in line.split(",")] for line in (args.room / "counts.csv").read_text().splitlines()]
    fu = faults.get("fu", "N")
    http_port = page_server(PAGE.format(fu=fu, fu_code=2, tu="Nm", tu_code=3, cpf=truth["counts"], cpt=truth["counts"],
                                        rdt=faults.get("rdt", "Enabled")))
    capture = None
    if args.igtl:
        own = [f for f in args.fault if f.split("=")[0] in ("damage", "close", "busy", "pictures", "hush")]
        capture = subprocess.Popen([args.igtl, str(args.room / "played.csv"), args.type, *own], stdin=subprocess.PIPE,
                                   stdout=subprocess.PIPE, text=True)
        igtl_port = int(capture.stdout.readline().split()[1])

    def begin(started_ns):
        if capture:
            capture.stdin.write(f"zero {started_ns + int(truth['ahead_s'] * 1e9)}\n")
            capture.stdin.flush()

    sensor = Sensor(counts, truth["drift"], faults, begin)
    print(json.dumps({"simulated": True, "http": http_port, "rdt": sensor.socket.getsockname()[1],
                      "igtl": igtl_port if capture else 0}), flush=True)
    threading.Thread(target=lambda: (sys.stdin.read(), setattr(sensor, "over", True)), daemon=True).start()
    try:
        while not getattr(sensor, "over", False):
            sensor.listen()
            sensor.play()
            time.sleep(0.0005)
    finally:
        sensor.listen()  # what was asked at the very end
        (args.room / "peer.json").write_text(json.dumps(sensor.log))
        if capture:
            capture.kill()


if __name__ == "__main__":
    main()
