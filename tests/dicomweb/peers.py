"""A real Orthanc with its DICOMweb plugin, and a PACS before it that asks for a token, and lies where a test tells it to."""
import base64
import http.server
import json
import ssl
import subprocess
import threading
import time
import urllib.error
import urllib.request
from pathlib import Path

from processes import ends_with_us, free_port, wait_until

PLUGIN = Path("/usr/share/orthanc/plugins/libOrthancDicomWeb.so")
USER, PASSWORD, TOKEN = "tractus", "a password of Orthanc", "a-token-of-the-PACS"
PIECE = bytes(1 << 20)


def basic(user, password):
    return "Basic " + base64.b64encode(f"{user}:{password}".encode()).decode()


class Orthanc:
    """Debian's orthanc and orthanc-dicomweb, on this machine alone, its data in a folder."""

    def __init__(self, folder):
        if not PLUGIN.exists():
            raise RuntimeError("Orthanc is missing: install Debian's orthanc and orthanc-dicomweb")
        self.folder, self.port = folder / "orthanc", free_port()
        self.folder.mkdir()
        self.base = f"http://127.0.0.1:{self.port}/dicom-web"
        self.settings = self.folder / "orthanc.json"
        self.settings.write_text(json.dumps({
            "Name": "test", "StorageDirectory": str(self.folder), "IndexDirectory": str(self.folder), "HttpPort": self.port,
            "DicomServerEnabled": False, "RemoteAccessAllowed": False, "AuthenticationEnabled": True, "RegisteredUsers": {USER: PASSWORD},
            "Plugins": [str(PLUGIN)], "DicomWeb": {"Enable": True, "Root": "/dicom-web/", "StowMaxInstances": 0, "StowMaxSize": 0}}))
        self.start()

    def start(self):
        with open(self.folder / "log", "ab") as log:
            self.process = subprocess.Popen(["Orthanc", str(self.settings)], stdout=log, stderr=log, preexec_fn=ends_with_us)
        wait_until(self.answers, 30, "Orthanc answers")

    def ask(self, path, data=None, headers=None, method=None):
        asked = urllib.request.Request(f"http://127.0.0.1:{self.port}{path}", data, {"Authorization": basic(USER, PASSWORD)} | (headers or {}),
                                       method=method)
        with urllib.request.urlopen(asked, timeout=30) as answer:
            return answer.headers.get("Content-Type", ""), answer.read()

    def answers(self):
        try:
            return self.ask("/dicom-web/studies") is not None
        except OSError:
            return False

    def store(self, files):
        for file in files:
            self.ask("/instances", file)

    def send(self, series_uid, base, token):
        """Sends a series by STOW-RS, whole in one request; the status and what Orthanc says of it."""
        self.ask("/dicom-web/servers/tractus", json.dumps({"Url": base, "HttpHeaders": {"Authorization": f"Bearer {token}"}}).encode(),
                 method="PUT")
        _, known = self.ask("/tools/find", json.dumps({"Level": "Series", "Query": {"SeriesInstanceUID": series_uid}}).encode())
        wish = json.dumps({"Resources": json.loads(known), "Synchronous": True}).encode()
        try:
            return 200, self.ask("/dicom-web/servers/tractus/stow", wish)[1]
        except urllib.error.HTTPError as refused:
            return refused.code, refused.read()

    def stop(self):
        self.process.terminate()
        self.process.wait(30)


class Front:
    """Hands requests with the right token on to Orthanc. `lie` names what it does instead."""

    def __init__(self, orthanc, tls=None):
        self.orthanc, self.lie, self.asked, self.silent = orthanc, "", [], threading.Event()
        outer = self

        class Handler(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def do_GET(self):
                self.close_connection = True
                outer.asked.append((self.path, self.headers.get("Authorization", "")))
                try:
                    outer.answer(self)
                except OSError:
                    pass  # the other side had enough

            def log_message(self, *words):
                pass

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.port = self.server.server_address[1]
        if tls:
            context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
            context.load_cert_chain(*tls)
            self.server.socket = context.wrap_socket(self.server.socket, server_side=True)
        self.base = f"{'https' if tls else 'http'}://127.0.0.1:{self.port}/dicom-web"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def answer(self, handler):
        if handler.headers.get("Authorization") != f"Bearer {TOKEN}":
            return self.say(handler, 401)
        if self.lie:
            return getattr(self, self.lie)(handler)
        kind, body = self.orthanc.ask(handler.path, headers={"Accept": handler.headers["Accept"]})
        return self.say(handler, 200, kind, body)

    def say(self, handler, status, kind="text/plain", body=b"", **headers):
        handler.send_response(status)
        for name, value in {"Content-Type": kind, "Content-Length": len(body), "Connection": "close"}.items() | headers.items():
            handler.send_header(name, str(value))
        handler.end_headers()
        handler.wfile.write(body)

    def begin(self, handler, kind):
        handler.send_response(200)
        handler.send_header("Content-Type", kind)
        handler.send_header("Connection", "close")
        handler.end_headers()

    # --- what it does instead -------------------------------------------------------------------------------------------------

    def fails(self, handler):
        self.say(handler, 500, body=b"out of cheese")

    def redirects(self, handler):
        self.say(handler, 302, Location=f"http://127.0.0.1:{self.orthanc.port}{handler.path}")

    def sends_a_page(self, handler):
        self.say(handler, 200, "text/html", b"<html>Sign in to the hospital's portal</html>")

    def sends_an_object(self, handler):
        self.say(handler, 200, "application/dicom+json", b'{"no": "list"}')

    def sends_no_json(self, handler):
        self.say(handler, 200, "application/dicom+json", b"[{")

    def sends_an_endless_list(self, handler):
        self.begin(handler, "application/dicom+json")
        while True:
            handler.wfile.write(b"[" + b" " * 65536)

    def whole(self, handler):
        """The true answer: its type, its boundary, its body."""
        kind, body = self.orthanc.ask(handler.path, headers={"Accept": handler.headers["Accept"]})
        return kind, kind.partition("boundary=")[2], body

    def has_another_boundary(self, handler):
        kind, boundary, body = self.whole(handler)
        self.say(handler, 200, kind.replace(boundary, "another"), body)

    def has_no_boundary(self, handler):
        _, _, body = self.whole(handler)
        self.say(handler, 200, 'multipart/related; type="application/dicom"', body)

    def ends_too_early(self, handler):
        kind, _, body = self.whole(handler)
        self.say(handler, 200, kind, body[:len(body) // 2])

    def closes_too_early(self, handler):
        kind, _, body = self.whole(handler)
        handler.send_response(200)
        handler.send_header("Content-Type", kind)
        handler.send_header("Content-Length", str(len(body)))
        handler.end_headers()
        handler.wfile.write(body[:len(body) // 2])

    def sends_other_parts(self, handler):
        kind, _, body = self.whole(handler)
        self.say(handler, 200, kind, body.replace(b"application/dicom", b"image/jpeg"))

    def sends_rubbish_as_dicom(self, handler):
        kind, boundary, _ = self.whole(handler)
        self.say(handler, 200, kind, f"--{boundary}\r\nContent-Type: application/dicom\r\n\r\nhello\r\n--{boundary}--\r\n".encode())

    def sends_no_part(self, handler):
        kind, boundary, _ = self.whole(handler)
        self.say(handler, 200, kind, f"--{boundary}--\r\n".encode())

    def falls_silent(self, handler):
        """In the middle of a file; whoever waits is let go after a while."""
        kind, _, body = self.whole(handler)
        self.begin(handler, kind)
        handler.wfile.write(body[:len(body) // 2])
        handler.wfile.flush()
        self.silent.set()
        time.sleep(10)

    def sends_endless_headers(self, handler):
        kind, boundary, _ = self.whole(handler)
        self.begin(handler, kind)
        handler.wfile.write(f"--{boundary}\r\n".encode())
        while True:
            handler.wfile.write(b"X-Word: " + b"a" * 65536 + b"\r\n")

    def sends_endless_parts(self, handler):
        kind, boundary, _ = self.whole(handler)
        self.begin(handler, kind)
        part = f"--{boundary}\r\nContent-Type: application/dicom\r\n\r\nDICM\r\n".encode()
        while True:
            handler.wfile.write(part * 256)

    def sends_an_endless_part(self, handler):
        kind, boundary, _ = self.whole(handler)
        self.begin(handler, kind)
        handler.wfile.write(f"--{boundary}\r\nContent-Type: application/dicom\r\n\r\n".encode())
        while True:
            handler.wfile.write(PIECE)

    def stop(self):
        self.server.shutdown()
        self.server.server_close()
