"""HTTP/1.1 and WebSocket on a plain socket: every byte of a request can be wrong, and the source address is a parameter."""
import base64
import json
import os
import socket
import ssl
import struct

OWN_ADDRESS = "127.0.0.1"
MOST_ANSWER_BYTES = 256 << 20


class Answer:
    """What came back. Header names are in lower case; a header that came twice is joined by a newline."""

    def __init__(self, status, headers, body):
        self.status, self.headers, self.body = status, headers, body

    def json(self):
        return json.loads(self.body)

    def header(self, name):
        return self.headers.get(name, "")

    def __str__(self):
        return f"{self.status} {self.body[:200].decode(errors='replace')}"


class Target:
    """Where a server, or the proxy before it, answers."""

    def __init__(self, port, authority=None):
        self.port, self.authority = port, authority

    def connect(self, source=OWN_ADDRESS, patience_s=60):
        made = socket.create_connection(("127.0.0.1", self.port), patience_s, source_address=(source, 0))
        made.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        if not self.authority:
            return made
        context = ssl.create_default_context(cafile=self.authority)
        return context.wrap_socket(made, server_hostname="127.0.0.1")


def read_head(stream):
    line = stream.readline(65537)
    if not line.startswith(b"HTTP/1.1 "):
        return None
    headers = {}
    for _ in range(200):
        field = stream.readline(65537).rstrip(b"\r\n")
        if not field:
            return int(line[9:12]), headers
        name, _, value = field.decode("latin-1").partition(":")
        name, value = name.strip().lower(), value.strip()
        headers[name] = f"{headers[name]}\n{value}" if name in headers else value
    return None


def read_chunks(stream):
    out = b""
    while size := int(stream.readline(64).split(b";")[0] or b"0", 16):
        out += stream.read(size)
        stream.readline(8)
    stream.readline(8)
    return out


def read_answer(stream, method):
    """The next answer, or None when the other side closed without one."""
    head = read_head(stream)
    while head and head[0] == 100:
        head = read_head(stream)
    if head is None:
        return None
    status, headers = head
    if method == "HEAD" or status in (101, 204, 304):
        return Answer(status, headers, b"")
    if "chunked" in headers.get("transfer-encoding", ""):
        return Answer(status, headers, read_chunks(stream))
    size = headers.get("content-length")
    body = stream.read(min(int(size), MOST_ANSWER_BYTES)) if size else stream.read(MOST_ANSWER_BYTES)
    return Answer(status, headers, body)


class Line:
    """A connection that is kept for the next request, and made again when the other side closed it."""

    def __init__(self, target, source=OWN_ADDRESS, patience_s=60):
        self.target, self.source, self.patience_s = target, source, patience_s
        self.socket = self.stream = None

    def close(self):
        for held in (self.stream, self.socket):
            if held:
                held.close()
        self.socket = self.stream = None

    def exchange(self, raw, method="GET"):
        """Sends bytes as they are. None: closed without an answer."""
        for fresh in (self.socket is None, True):
            if not self._connected():
                return None
            answer = self._once(raw, method)
            if answer and "close" not in answer.header("connection").lower():
                return answer
            self.close()
            if answer or fresh:
                return answer
        return None

    def _connected(self):
        if self.socket is None:
            try:
                self.socket = self.target.connect(self.source, self.patience_s)
            except OSError:
                return False  # nobody listens any more
            self.stream = self.socket.makefile("rb")
        return True

    def _once(self, raw, method):
        try:
            self.socket.sendall(raw)
        except (OSError, ssl.SSLError):
            pass  # it may have answered before it closed
        try:
            return read_answer(self.stream, method)
        except (OSError, ValueError, ssl.SSLError):
            return None


def request_bytes(method, path, headers, body=b""):
    lines = [f"{method} {path} HTTP/1.1"] + [f"{name}: {value}" for name, value in headers.items()]
    if body or method in ("POST", "PUT", "PATCH"):
        lines.append(f"Content-Length: {len(body)}")
    return "\r\n".join(lines).encode("latin-1", "replace") + b"\r\n\r\n" + body


class Client:
    """Somebody with credentials, or nobody, at one address."""

    def __init__(self, target, credentials=None, source=OWN_ADDRESS, patience_s=60):
        self.credentials = credentials or {}
        self.line = Line(target, source, patience_s)

    def headers(self, more=None, kind="application/json"):
        host = {"Host": f"127.0.0.1:{self.line.target.port}", "X-Tractus": "1", "Content-Type": kind}
        return host | self.credentials | (more or {})

    def ask(self, method, path, body=None, kind="application/json", headers=None):
        """An answer always; status 0 when the connection closed without one."""
        data = b"" if body is None else body if isinstance(body, bytes) else json.dumps(body).encode()
        path = path if path.startswith("/api") else "/api/v1" + path
        answer = self.line.exchange(request_bytes(method, path, self.headers(headers, kind), data), method)
        return answer or Answer(0, {}, b"")

    def must(self, method, path, body=None, **more):
        """The JSON of an answer that has to be a success."""
        answer = self.ask(method, path, body, **more)
        if not 200 <= answer.status < 300:
            raise RuntimeError(f"{method} {path}: {answer}")
        return answer.json() if answer.body else None


def websocket(target, path, headers):
    """The connected socket after its handshake, or None when the server refused it."""
    made = target.connect()
    key = base64.b64encode(os.urandom(16)).decode()
    asked = headers | {"Connection": "Upgrade", "Upgrade": "websocket", "Sec-WebSocket-Version": "13", "Sec-WebSocket-Key": key}
    made.sendall(request_bytes("GET", path, {"Host": f"127.0.0.1:{target.port}"} | asked))
    head = read_head(made.makefile("rb", buffering=0))
    return made if head and head[0] == 101 else made.close()


def websocket_frame(payload):
    """A masked text frame (RFC 6455 section 5.2); the mask is zero, so that the payload stands as it is."""
    size = len(payload)
    if size < 126:
        length = bytes([0x80 | size])
    elif size < 65536:
        length = bytes([0x80 | 126]) + struct.pack(">H", size)
    else:
        length = bytes([0x80 | 127]) + struct.pack(">Q", size)
    return b"\x81" + length + bytes(4) + payload
