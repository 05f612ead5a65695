"""A provider of identities of the suite's own (OpenID Connect, code flow), signing by the program openssl."""
import base64
import http.server
import json
import subprocess
import threading
import time
import urllib.parse


def base64url(data):
    return base64.urlsafe_b64encode(data).rstrip(b"=").decode()


class Provider:
    """Vouches for one person, whom it calls `subject`."""

    def __init__(self, folder):
        self.key, self.subject, self.nonce = folder / "provider.pem", "person@provider", ""
        subprocess.run(["openssl", "genrsa", "-out", self.key, "2048"], check=True, capture_output=True)
        told = subprocess.run(["openssl", "rsa", "-in", self.key, "-noout", "-modulus"], check=True, capture_output=True, text=True).stdout
        modulus = bytes.fromhex(told.strip().split("=")[1])
        self.keys = {"keys": [{"kty": "RSA", "use": "sig", "alg": "RS256", "kid": "1", "n": base64url(modulus), "e": "AQAB"}]}
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), self._handler())
        self.issuer = f"http://127.0.0.1:{self.server.server_port}"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def description(self):
        return {"issuer": self.issuer, "authorization_endpoint": self.issuer + "/authorize", "token_endpoint": self.issuer + "/token",
                "jwks_uri": self.issuer + "/keys", "response_types_supported": ["code"], "subject_types_supported": ["public"],
                "id_token_signing_alg_values_supported": ["RS256"]}

    def vouch(self, address):
        """What the browser brings back from the authorization address: the callback's query."""
        asked = dict(urllib.parse.parse_qsl(urllib.parse.urlsplit(address).query))
        self.nonce = asked["nonce"]
        return urllib.parse.urlencode({"code": "code", "state": asked["state"], "iss": self.issuer})

    def id_token(self):
        now = int(time.time())
        claims = {"iss": self.issuer, "sub": self.subject, "aud": "tractus", "nonce": self.nonce, "iat": now, "exp": now + 300}
        parts = [base64url(json.dumps(part).encode()) for part in ({"alg": "RS256", "kid": "1", "typ": "JWT"}, claims)]
        message = ".".join(parts).encode()
        signature = subprocess.run(["openssl", "dgst", "-sha256", "-sign", self.key], input=message, check=True, capture_output=True).stdout
        return message.decode() + "." + base64url(signature)

    def _handler(self):
        provider = self

        class Handler(http.server.BaseHTTPRequestHandler):
            def _answer(self, value):
                body = json.dumps(value).encode()
                self.send_response(200)
                self.send_header("Content-Type", "application/json")
                self.send_header("Content-Length", str(len(body)))
                self.end_headers()
                self.wfile.write(body)

            def do_GET(self):
                self._answer(provider.keys if self.path.startswith("/keys") else provider.description())

            def do_POST(self):
                self.rfile.read(int(self.headers.get("Content-Length", 0)))
                self._answer({"access_token": "a", "token_type": "Bearer", "id_token": provider.id_token()})

            def log_message(self, *_):
                pass
        return Handler

    def stop(self):
        self.server.shutdown()
