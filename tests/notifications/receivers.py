"""A mail server (aiosmtpd) and a receiver of webhooks, both of this machine, whose behaviour a test sets while they run."""
import base64
import email
import email.policy
import hashlib
import hmac
import http.server
import json
import logging
import ssl
import subprocess
import threading
import time

from aiosmtpd.controller import Controller
from aiosmtpd.smtp import SMTP, AuthResult
from processes import free_port

logging.getLogger("mail.log").setLevel(logging.ERROR)  # it warns of its own attributes
USER, PASSWORD = "tractus", "a password of the mail server"


def certificate(folder):
    """A certificate for 127.0.0.1, by openssl: its file and its key's."""
    pem, key = folder / "mail.pem", folder / "mail.key"
    subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days", "2",
                    "-subj", "/CN=127.0.0.1", "-addext", "subjectAltName=IP:127.0.0.1", "-keyout", key, "-out", pem],
                   check=True, capture_output=True)
    return pem, key


class MailServer:
    """SMTP with STARTTLS and AUTH. `answer` is what it says to a message, `delay_s` how long it thinks before."""

    def __init__(self, folder):
        self.pem, key = certificate(folder)
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.load_cert_chain(self.pem, key)
        self.messages, self.attempts, self.answer, self.delay_s, self.logins = [], [], "250 taken", 0.0, []
        outer = self

        class Handler:
            async def handle_DATA(self, server, session, envelope):
                return await outer.take(session, envelope)

        class Listener(Controller):
            def factory(self):
                return SMTP(self.handler, tls_context=context, require_starttls=True, auth_required=True,
                            authenticator=outer.login, timeout=300)

        self.port = free_port()
        self.controller = Listener(Handler(), hostname="127.0.0.1", port=self.port)
        self.controller.start()

    def login(self, server, session, envelope, mechanism, data):
        right = (data.login.decode(), data.password.decode()) == (USER, PASSWORD)
        self.logins.append((right, session.ssl is not None))
        return AuthResult(success=right)

    async def take(self, session, envelope):
        import asyncio
        message = email.message_from_bytes(envelope.content, policy=email.policy.default)
        self.attempts.append((time.monotonic(), message["Message-ID"], envelope.rcpt_tos))
        await asyncio.sleep(self.delay_s)
        if self.answer.startswith("250"):
            self.messages.append({"from": envelope.mail_from, "to": envelope.rcpt_tos, "message": message})
        return self.answer

    def stop(self):
        self.controller.stop()


class Webhooks:
    """Takes calls. `status` is what it answers, by path; `delay_s` how long it thinks before."""

    def __init__(self):
        self.calls, self.status, self.delay_s = [], {}, {}
        outer = self

        class Handler(http.server.BaseHTTPRequestHandler):
            def do_POST(self):
                body = self.rfile.read(int(self.headers["Content-Length"]))
                outer.calls.append({"at_s": time.monotonic(), "path": self.path, "headers": dict(self.headers), "body": body})
                time.sleep(outer.delay_s.get(self.path, 0.0))
                self.send_response(outer.status.get(self.path, 204))
                self.send_header("Content-Length", "0")
                self.end_headers()

            def log_message(self, *words):
                pass

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.port = self.server.server_address[1]
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def of(self, path):
        return [one for one in self.calls if one["path"] == path]

    def stop(self):
        self.server.shutdown()


def is_signed(call, secret):
    """Standard Webhooks 1.0, "Verifying webhook authenticity": HMAC-SHA-256 of "id.timestamp.body" by the key after "whsec_"."""
    headers = {name.lower(): value for name, value in call["headers"].items()}
    text = f"{headers['webhook-id']}.{headers['webhook-timestamp']}.".encode() + call["body"]
    mac = hmac.new(base64.b64decode(secret.removeprefix("whsec_")), text, hashlib.sha256).digest()
    fresh = abs(int(headers["webhook-timestamp"]) - time.time()) < 300
    return fresh and hmac.compare_digest(headers["webhook-signature"], "v1," + base64.b64encode(mac).decode())


def settings_file(folder, mail, domains=()):
    (folder / "mail-password").write_text(PASSWORD + "\n")
    path = folder / "mail.json"
    path.write_text(json.dumps({
        "format": "tractus-mail/1", "server": f"smtp://127.0.0.1:{mail.port}", "from": "tractus@hospital.example",
        "base": "https://tractus.hospital.example", "user": USER, "password_file": "mail-password", "authority": str(mail.pem),
        "domains": list(domains)}))
    return path
