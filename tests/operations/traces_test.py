#!/usr/bin/python3
"""Traces of uploads, from a station through nginx and two servers to the job, as a collector gets them.

    tests/operations/traces_test.py --bin build/release/bin

What is received is read by OpenTelemetry's own definitions (otlp/, protoc, python3-protobuf): a field that they do not know, or of another
type, fails the test. The server that is killed is killed by SIGKILL."""
import argparse
import base64
import hashlib
import http.server
import json
import os
import re
import secrets
import shutil
import signal
import ssl
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

from google.protobuf import json_format

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "attack"))
from processes import Proxy, Server, wait_until  # noqa: E402
from trial_file import SAMPLE, sealed, trial_bytes  # noqa: E402
from wire import Client, Target  # noqa: E402
from world import Setup, World  # noqa: E402

INTERNAL, SERVER, CLIENT, CONSUMER, ERROR = 1, 2, 3, 5, 2
UPLOAD = "/api/v1/uploads/{trial_id}"
EXAMPLE = "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01"
RUBBISH = ["", "00", "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7", EXAMPLE + "-", EXAMPLE.upper(), EXAMPLE.replace("00-4", "ff-4"),
           "00-" + "0" * 32 + "-00f067aa0ba902b7-01", f"{EXAMPLE}, {EXAMPLE}", "'; drop table jobs; --", "<script>", "%0d%0aX: y", "é" * 9, "0" * 9000]


def definitions():
    """The module of OTLP's service of traces, made by protoc."""
    folder = Path(tempfile.mkdtemp(prefix="tractus-otlp-"))
    files = sorted(str(path.relative_to(HERE / "otlp")) for path in (HERE / "otlp").rglob("*.proto"))
    subprocess.run(["protoc", f"--proto_path={HERE / 'otlp'}", f"--python_out={folder}", *files], check=True)
    sys.path.insert(0, str(folder))
    try:
        from opentelemetry.proto.collector.trace.v1 import trace_service_pb2
        return trace_service_pb2
    finally:
        shutil.rmtree(folder)


def read_strictly(service, body):
    """OTLP writes ids in hexadecimal where the JSON of protobuf has base64; all else is protobuf's."""
    told = json.loads(body)
    for resource in told["resourceSpans"]:
        for scope in resource["scopeSpans"]:
            for span in scope["spans"]:
                for name, size in (("traceId", 32), ("spanId", 16), ("parentSpanId", 16)):
                    if name in span:
                        if not re.fullmatch(f"[0-9a-f]{{{size}}}", span[name]):
                            raise ValueError(f"{name} {span[name]}")
                        span[name] = base64.b64encode(bytes.fromhex(span[name])).decode()
    return json_format.ParseDict(told, service.ExportTraceServiceRequest())


class Received:
    """A span, with the resource that it came with."""

    def __init__(self, span, resource):
        self.span, self.name, self.kind, self.start, self.end = span, span.name, span.kind, span.start_time_unix_nano, span.end_time_unix_nano
        self.trace, self.id, self.parent = span.trace_id.hex(), span.span_id.hex(), span.parent_span_id.hex()
        self.attributes = {one.key: one.value.int_value or one.value.string_value for one in span.attributes}
        self.resource = {one.key: one.value.string_value for one in resource.attributes}
        self.process = self.resource.get("test.process", "")


class Collector(http.server.ThreadingHTTPServer):
    """Takes spans, refuses them, or does not answer, as `state` says."""
    daemon_threads = True

    def __init__(self, service, certificate=None):
        super().__init__(("127.0.0.1", 0), Handler)
        self.scheme = "https" if certificate else "http"
        if certificate:
            context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
            context.load_cert_chain(certificate)
            self.socket = context.wrap_socket(self.socket, server_side=True)
        self.service, self.state, self.spans, self.bodies, self.wrong, self.keys = service, "takes", [], b"", [], set()
        threading.Thread(target=self.serve_forever, daemon=True).start()

    def environment(self, process, **more):
        return os.environ | {"OTEL_EXPORTER_OTLP_ENDPOINT": f"{self.scheme}://127.0.0.1:{self.server_port}", "OTEL_BSP_SCHEDULE_DELAY": "50",
                             "OTEL_EXPORTER_OTLP_HEADERS": "api-key=a%20secret", "OTEL_RESOURCE_ATTRIBUTES": f"test.process={process}"} | more

    def take(self, path, headers, body):
        if path != "/v1/traces" or headers["Content-Type"] != "application/json":
            raise ValueError(f"{path} {headers['Content-Type']}")
        self.keys.add(headers["api-key"])
        told = read_strictly(self.service, body)
        self.bodies += body
        self.spans += [Received(span, resource.resource) for resource in told.resource_spans for scope in resource.scope_spans for span in scope.spans]

    def of(self, trace):
        return [span for span in self.spans if span.trace == trace]

    def roots(self, process):
        return [span for span in self.spans if not span.parent and span.process == process]


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def log_message(self, *_):
        pass

    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        while self.server.state == "hangs":
            time.sleep(0.05)
        status = 503 if self.server.state == "refuses" else 200
        if status == 200:
            try:
                self.server.take(self.path, self.headers, body)
            except Exception as failure:  # noqa: BLE001  # told by the test
                self.server.wrong.append(f"{failure}: {body[:400]}")
        self.send_response(status)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", "2")
        self.end_headers()
        try:
            self.wfile.write(b"{}")
        except OSError:
            pass


def long_trial(trial, case, count):
    """A trial in many frames; the whole is `count` samples of 64 bytes."""
    parts, tick = [], 0
    while tick < count:
        size = min(10_000, count - tick)
        rows = b"".join(SAMPLE.pack(at * 1e-3, 5e-5 * (at % 500), 1e-3, 5e-3, 1.0, 100.0, 0.0, 0.0, 0.0, 0.0, 0.0, at, 0, 1, 0)
                        for at in range(tick, tick + size))
        parts.append((b"SAMP", size.to_bytes(4, "little") + rows))
        tick += size
    header = {"format": "tractus-trial/2", "id": trial, "case_id": case, "station": "station", "operator": "Olive Operator", "simulated": False,
              "device": "sim-rig", "started_utc_us": 1_770_000_000_000_000, "rate_Hz": 1000.0, "probe": {"travel_m": 0.028}, "extra": {},
              "rig": "probing"}
    end_s = count * 1e-3
    answer = {"t_s": end_s, "kind": "answer", "detail": {"breach": True, "wall": None, "confidence": 0.75, "depth_m": 0.021}}
    return sealed([(b"HEAD", json.dumps(header).encode()), (b"EVNT", b'{"t_s":0.0,"kind":"start","detail":{}}'), *parts,
                   (b"EVNT", json.dumps(answer).encode()), (b"EVNT", json.dumps({"t_s": end_s, "kind": "end", "detail": {}}).encode())], count)


class Station:
    """A station's data folder with one trial that waits, and the program that hands it over."""

    def __init__(self, test, name, samples):
        self.test, self.folder, self.trial = test, test.folder / name, secrets.token_hex(16)
        client = test.world.station(name)
        self.token = client.credentials["Authorization"].split()[1]
        for part in ("outbox", "trials"):
            (self.folder / part).mkdir(parents=True)
        (self.folder / "token").write_text(self.token)
        data = long_trial(self.trial, test.case, samples) if samples > 10_000 else trial_bytes(self.trial, test.case, "Olive Operator", samples)
        (self.folder / "trials" / f"{self.trial}.ttrial").write_bytes(data)
        entry = {"trial_id": self.trial, "case_id": test.case, "size_bytes": len(data), "sha256": hashlib.sha256(data).hexdigest(),
                 "offset_bytes": 0, "state": "queued", "reason": ""}
        (self.folder / "outbox" / f"{self.trial}.json").write_text(json.dumps(entry))

    def begin(self, environment):
        words = [self.test.bin / "tractus-station", "upload", "--data", self.folder, "--server", f"https://127.0.0.1:{self.test.proxy.port}",
                 "--authority", self.test.world.data / "tls/authority.pem", "--token-file", self.folder / "token", "--wait", "60", "--json"]
        self.process = subprocess.Popen(list(map(str, words)), env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def end(self):
        out, errors = self.process.communicate(timeout=120)
        self.test.assertEqual((self.process.returncode, json.loads(out)["handed_over"]), (0, 1), out + errors)
        return errors


class Traces(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="tractus-traces-"))
        self.addCleanup(shutil.rmtree, self.folder, True)
        self.collector = Collector(self.service)
        self.addCleanup(self.collector.shutdown)
        self.setup = Setup(self.bin, self.folder, "postgresql", "nothing")
        self.addCleanup(self.setup.stop)

    def serve(self, environments):
        """Two servers on one database behind nginx, with what each has in its environment."""
        self.setup.environment = environments[0]
        options = ["--job-lease-seconds", "1"]
        self.world = World(self.setup, front="proxy", options=options)
        self.one = self.world.server
        self.two = Server(self.setup.binary, self.world.data, self.one.options, environments[1])
        self.two.log = self.folder / "two.log"
        self.two.start()
        self.addCleanup(self.one.stop)
        self.addCleanup(self.two.stop)
        self.case = self.world.published_case()
        self.proxy = Proxy(self.folder / "nginx", [self.one.port, self.two.port], self.world.data / "tls")
        self.addCleanup(self.proxy.stop)

    def serve_traced(self):
        self.serve([self.collector.environment("one"), self.collector.environment("two")])

    def sql(self, text):
        return self.setup.postgres.run_sql(text, self.world.database)

    def assessed(self, trial):
        wait_until(lambda: self.sql(f"select state from trials where id = '{trial}'") == [["assessed"]], 60, "the trial is assessed")

    def trace_of_upload(self, process):
        """The one trace that this station's process began, whole: its job has been received."""
        wait_until(lambda: self.collector.wrong or self.collector.roots(process), 20, "the station's span is received")
        self.assertEqual(self.collector.wrong, [])
        roots = self.collector.roots(process)
        self.assertEqual([(root.name, root.kind) for root in roots], [("upload trial", INTERNAL)])
        wait_until(lambda: [span for span in self.collector.of(roots[0].trace) if span.kind == CONSUMER], 20, "the job's span is received")
        return roots[0], self.collector.of(roots[0].trace)

    def holds_as_a_tree(self, root, spans):
        """Parents, kinds and times; returns the client spans, the servers', the jobs'."""
        by_id = {span.id: span for span in spans}
        self.assertEqual(len(by_id), len(spans))
        kinds = {kind: [span for span in spans if span.kind == kind] for kind in (CLIENT, SERVER, CONSUMER)}
        self.assertEqual(1 + sum(map(len, kinds.values())), len(spans))
        for span in spans:
            self.assertLessEqual(span.start, span.end)
        for span in kinds[CLIENT]:
            self.assertEqual(span.parent, root.id)
            self.assertLessEqual((root.start, span.end), (span.start, root.end))
        for span in kinds[SERVER]:
            asked = by_id[span.parent]
            self.assertEqual((asked.kind, asked.name), (CLIENT, span.name))
            self.assertTrue(asked.start <= span.start and span.end <= asked.end, (span.name, asked.start, span.start, span.end, asked.end))
        for span in kinds[CONSUMER]:
            queued_by = by_id[span.parent]
            self.assertEqual((queued_by.kind, queued_by.name, span.name), (SERVER, f"POST {UPLOAD}/commit", "job metrics"))
            self.assertLessEqual(queued_by.start, span.start)
        return kinds[CLIENT], kinds[SERVER], kinds[CONSUMER]

    def test_an_upload_is_one_tree_and_names_nobody(self):
        self.serve_traced()
        station = Station(self, "Ward Seven", 40_000)  # 2.6 MB: three pieces
        station.begin(self.collector.environment("station"))
        station.end()
        self.assessed(station.trial)
        root, spans = self.trace_of_upload("station")
        asked, served, jobs = self.holds_as_a_tree(root, spans)
        steps = [f"PUT {UPLOAD}", *[f"PATCH {UPLOAD}"] * 3, f"POST {UPLOAD}/commit"]
        self.assertEqual([span.name for span in sorted(asked, key=lambda span: span.start)], steps)
        self.assertEqual([span.name for span in sorted(served, key=lambda span: span.start)], steps)
        self.assertEqual(len(jobs), 1)
        self.assertEqual({span.span.status.code for span in spans}, {0})
        self.assertEqual({span.attributes["http.response.status_code"] for span in asked + served}, {200})
        self.assertEqual({span.resource["service.name"] for span in served}, {"tractus-server"})
        self.assertEqual(root.resource["service.name"], "tractus-station")
        self.assertEqual(self.collector.keys, {"a secret"})
        behind = Client(Target(self.proxy.port, str(self.world.data / "tls/authority.pem")))
        self.assertEqual(behind.ask("GET", "/health", headers={"traceparent": EXAMPLE + "-rubbish"}).status, 200)
        log = self.proxy.folder / "nginx-access.log"
        wait_until(lambda: "/health" in log.read_text(), 5, "nginx logs the request")
        self.assertIn(f" {root.trace} 127.0.0.1:", log.read_text())
        self.assertRegex(log.read_text().splitlines()[-1], r'health" 200 \d+ [\d.]+ - 127.0.0.1:\d+$')
        logs = self.one.log.read_text() + self.two.log.read_text()
        for secret in (station.trial, station.token, self.case, "Ward Seven", "Olive", "admin", "127.0.0.1", "a secret"):
            self.assertNotIn(secret.encode(), self.collector.bodies.replace(b"api-key", b""))
        self.assertNotIn("a secret", logs)

    def test_a_server_killed_amid_an_upload_leaves_its_spans_and_the_upload_goes_on(self):
        self.serve_traced()
        station = Station(self, "station", 400_000)  # 26 MB: 25 pieces
        station.begin(self.collector.environment("station"))
        both = {"one", "two"}
        wait_until(lambda: {span.process for span in self.collector.spans if span.kind == SERVER} >= both, 60, "both servers take pieces")
        station.process.send_signal(signal.SIGSTOP)
        self.assertNotEqual(self.sql("select state from uploads"), [["complete"]], "the upload was over before a server was killed")
        self.one.stop(signal.SIGKILL)
        station.process.send_signal(signal.SIGCONT)
        station.end()
        self.assessed(station.trial)
        root, spans = self.trace_of_upload("station")
        asked, served, jobs = self.holds_as_a_tree(root, spans)
        self.assertEqual({span.process for span in served}, both)
        self.assertEqual([span.process for span in jobs], ["two"])
        after = [span for span in asked if span.attributes.get("http.response.status_code") == 200]
        self.assertGreaterEqual(len(after), 27)
        self.assertEqual(root.span.status.code, 0)

    def test_a_job_whose_server_died_goes_on_at_another_in_the_same_trace(self):
        self.serve_traced()
        station = Station(self, "station", 600)
        station.begin(self.collector.environment("station"))
        station.end()
        self.assessed(station.trial)
        root, spans = self.trace_of_upload("station")
        first = self.holds_as_a_tree(root, spans)[2][0].process
        died = {"one": self.one, "two": self.two}[first]
        died.stop(signal.SIGKILL)
        # As if it had died before it was done: claimed, with a lease that is over.
        self.sql("update jobs set state = 'claimed', lease_until_utc_us = 1 where kind = 'metrics'")
        wait_until(lambda: len([span for span in self.collector.of(root.trace) if span.kind == CONSUMER]) == 2, 30, "the job is done once more")
        jobs = self.holds_as_a_tree(root, self.collector.of(root.trace))[2]
        self.assertEqual([(job.process == first, job.attributes["tractus.job.attempt"]) for job in jobs], [(True, 1), (False, 2)])

    def test_without_the_environment_nothing_is_traced_whatever_a_client_asks(self):
        self.serve([os.environ.copy(), os.environ.copy()])
        station = Station(self, "station", 600)
        station.begin(self.collector.environment("station"))  # its own spans alone are sent
        station.end()
        self.assessed(station.trial)
        wait_until(lambda: self.collector.roots("station"), 20, "the station's span is received")
        self.assertEqual({span.process for span in self.collector.spans}, {"station"})
        self.assertEqual(self.sql("select distinct traceparent from jobs"), [[""]])
        self.assertNotIn("trace_id", self.one.log.read_text())

    def test_a_collector_is_trusted_by_its_certificate_alone(self):
        pem = self.folder / "collector.pem"
        subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days", "2", "-subj",
                        "/CN=127.0.0.1", "-addext", "subjectAltName=IP:127.0.0.1", "-keyout", pem, "-out", pem.with_suffix(".crt")],
                       check=True, capture_output=True)
        pem.write_text(pem.read_text() + pem.with_suffix(".crt").read_text())
        self.collector = Collector(self.service, pem)
        self.addCleanup(self.collector.shutdown)
        self.serve([os.environ.copy(), os.environ.copy()])
        stranger = Station(self, "stranger", 600)
        stranger.begin(self.collector.environment("stranger"))
        self.assertRegex(stranger.end(), "warning: traces are not sent: .*certificate")
        station = Station(self, "station", 600)
        station.begin(self.collector.environment("station", OTEL_EXPORTER_OTLP_CERTIFICATE=str(pem.with_suffix(".crt"))))
        self.assertEqual(station.end(), "")
        wait_until(lambda: self.collector.roots("station"), 20, "the station's span is received")
        self.assertEqual({span.process for span in self.collector.spans}, {"station"})

    def test_a_wrong_variable_is_named_and_all_else_goes_on(self):
        self.serve([self.collector.environment("one", OTEL_EXPORTER_OTLP_PROTOCOL="grpc")] * 2)
        self.assertIn("OTEL_EXPORTER_OTLP_PROTOCOL", self.one.log.read_text())
        station = Station(self, "station", 600)
        station.begin(self.collector.environment("station", OTEL_EXPORTER_OTLP_ENDPOINT="collector:4317"))
        self.assertIn("OTEL_EXPORTER_OTLP_ENDPOINT", station.end())
        self.assertEqual(self.collector.spans, [])

    def test_a_traceparent_is_believed_only_if_it_is_one_and_of_a_station(self):
        self.serve_traced()
        station = self.world.station("station")
        unknown = f"/uploads/{secrets.token_hex(16)}"
        for text in RUBBISH:
            answer = station.ask("GET", unknown, headers={"traceparent": text})
            self.assertEqual(answer.status, 404, text[:80])
        wait_until(lambda: len(self.collector.spans) >= len(RUBBISH), 20, "each request began a trace of its own")
        self.assertEqual(len({span.trace for span in self.collector.spans}), len(RUBBISH))
        self.assertEqual({(span.parent, span.span.status.code) for span in self.collector.spans}, {("", 0)})
        self.assertNotIn(EXAMPLE[3:35], {span.trace for span in self.collector.spans})
        so_far = len(self.collector.spans)
        for client, path in ((self.world.nobody(), unknown), (self.world.admin, unknown), (station, "/health")):
            client.ask("GET", path, headers={"traceparent": EXAMPLE})
        station.ask("GET", unknown, headers={"traceparent": EXAMPLE[:-1] + "0"})
        station.ask("GET", unknown, headers={"traceparent": EXAMPLE})
        wait_until(lambda: len(self.collector.spans) > so_far, 20, "a station's own is believed")
        time.sleep(0.3)
        self.assertEqual([(span.trace, span.parent) for span in self.collector.spans[so_far:]], [(EXAMPLE[3:35], EXAMPLE[36:52])])

    def test_a_collector_that_is_away_delays_nothing_and_what_is_dropped_is_counted(self):
        self.serve_traced()
        station = self.world.station("station")
        for state in ("hangs", "refuses"):
            self.collector.state = state
            began = time.monotonic()
            for _ in range(3500):  # over the queue and the request that is under way
                station.ask("GET", f"/uploads/{'0' * 32}", headers={"traceparent": EXAMPLE})
            print(f"\n  a collector that {state}: {(time.monotonic() - began) / 3500 * 1e3:.2f} ms a request", flush=True)
            metrics = station.ask("GET", "/server/metrics").body.decode()
            self.assertGreater(int(re.search(r"^tractus_spans_dropped_total (\d+)", metrics, re.M)[1]), 900)
        self.collector.state = "hangs"
        handing = Station(self, "other", 600)
        began = time.monotonic()
        handing.begin(self.collector.environment("station"))
        handing.end()
        self.assertLess(time.monotonic() - began, 8)  # its last try takes 1 to 2 s
        began = time.monotonic()
        self.one.stop()
        self.assertLess(time.monotonic() - began, 15)
        self.assertIn('"what":"traces"', self.one.log.read_text())
        self.collector.state = "takes"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=Path, required=True, help="folder of the programs")
    at, others = parser.parse_known_args()
    Traces.bin, Traces.service = at.bin.resolve(), definitions()
    unittest.main(argv=[sys.argv[0], *others], verbosity=2, warnings="ignore")  # sockets of clients that the tests leave open
