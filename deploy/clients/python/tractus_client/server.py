"""A Tractus server, asked with a personal token. Standard library alone."""
import http.client
import json
import os
import ssl
import time
import urllib.error
import urllib.parse
import urllib.request

from .arrays import parse_npy
from .errors import TractusError
from .tables import COHORT_TEXTS, kinds_in, parse_table

_PIECE = 1 << 20
_MOST_MAKING_S = 900  # for samples at 100 Hz the server reads every trial before its first byte
_MOST_STALLED = 5  # connections in a row that bring nothing


class Server:
    """@param url    address of the server, "https://tractus.example"
    @param token  personal token; without it, the environment variable TRACTUS_TOKEN
    @param ca_file  PEM file of the authority that signed the server's certificate; none: the system's authorities
    """

    def __init__(self, url, token=None, ca_file=None, timeout_s=60):
        token = (token or os.environ.get("TRACTUS_TOKEN", "")).strip()
        if not token or not token.isascii() or any(c.isspace() for c in token):
            raise TractusError("no token: pass token=… or set the environment variable TRACTUS_TOKEN; the account page makes tokens")
        if urllib.parse.urlsplit(url).scheme not in ("http", "https"):
            raise TractusError(f"{url}: an address beginning with https:// (or http://) is expected")
        self.url, self.timeout_s = url.rstrip("/"), timeout_s
        self._headers = {"Authorization": f"Bearer {token}"}
        self._tls = ssl.create_default_context(cafile=ca_file) if url.startswith("https") else None
        self._kinds = None

    # --- asking ---

    def _open(self, method, path, query=None, body=None, timeout_s=None, more_headers=None):
        given = {key: value for key, value in (query or {}).items() if value is not None}
        address = f"{self.url}/api/v1{path}" + (f"?{urllib.parse.urlencode(given)}" if given else "")
        data = None if body is None else json.dumps(body).encode()
        headers = {**self._headers, **({"Content-Type": "application/json"} if data is not None else {}), **(more_headers or {})}
        request = urllib.request.Request(address, data=data, headers=headers, method=method)
        try:
            return urllib.request.urlopen(request, timeout=timeout_s or self.timeout_s, context=self._tls)
        except urllib.error.HTTPError as error:
            raise _refusal(method, path, error) from None
        except urllib.error.URLError as error:
            raise TractusError(f"{self.url} cannot be reached: {error.reason}") from None
        except (OSError, http.client.HTTPException) as error:
            raise TractusError(f"{self.url}: the connection broke: {error}") from None

    def ask(self, method, path, query=None, body=None):
        """The answer of a route as Python values (JSON), or None; `path` without /api/v1."""
        content = self._bytes(path, query, method, body)
        return json.loads(content) if content else None

    def _bytes(self, path, query=None, method="GET", body=None):
        with self._open(method, path, query, body) as answer:
            try:
                return answer.read()
            except (OSError, http.client.HTTPException) as reason:  # IncompleteRead among them
                raise TractusError(f"{method} {path}: the connection broke: {reason}") from None

    def _text(self, path, query=None):
        return self._bytes(path, query).decode("utf-8")

    # --- tables ---

    def _table(self, name, study):
        self._kinds = self._kinds or kinds_in(self._text("/export/dictionary.csv"))
        return parse_table(self._text(f"/export/{name}.csv", {"study": study}),
                           lambda column: self._kinds.get((name, column), "text"))

    def studies(self):
        """All studies, as the server lists them."""
        return list(self._pages("/studies", "studies"))

    def _pages(self, path, key, **query):
        cursor = None
        while True:
            page = self.ask("GET", path, {**query, "cursor": cursor})
            yield from page[key]
            cursor = page.get("next")
            if not cursor:
                return

    def summary(self, study=None):
        """Table: a row per participant, study and rig."""
        return self._table("summary", study)

    def trials(self, study=None, **wanted):
        """Table: a row per released trial; `wanted` are values of columns, for example rig="probing"."""
        return self._table("trials", study).where(**wanted)

    def scores(self, study=None, **wanted):
        """Table: a row per trial and score."""
        return self._table("scores", study).where(**wanted)

    def cohort_table(self, study=None):
        """Table: a row per scored trial with its scores as columns, as analyses use it."""
        return parse_table(self._text("/cohort/table", {"study": study}),
                           lambda column: "text" if column in COHORT_TEXTS else "number")

    # --- samples ---

    def samples(self, trial, rate_Hz=100):
        """The samples of a trial, by its pseudonym: an array, a row per sample. rate_Hz=0: every sample."""
        path = f"/export/trials/{urllib.parse.quote(trial, safe='')}/samples.npy"
        return parse_npy(self._bytes(path, {"rate_Hz": rate_Hz}), f"trial {trial}")

    def stream(self, study=None, rate_Hz=100, **wanted):
        """Yields (row of the trial, samples), one trial after the other: the memory is that of one trial. A trial whose
        participant did not consent to samples of this rate is passed over."""
        for trial in self.trials(study, **wanted):
            try:
                samples = self.samples(trial["trial"], rate_Hz)
            except TractusError as refusal:
                if refusal.status in (403, 404):
                    continue
                raise
            yield trial, samples

    # --- a whole cohort ---

    def cohort(self, to, study=None, tier="metrics", progress=None):
        """Downloads a zip of the tables and, for the tiers reduced and full, the samples to the file `to`, which appears when it
        is whole; `read_cohort` reads it. Goes on where a connection broke, and begins anew when the cohort is another one by then.
        @param progress  called with the share that has come, 0 to 1"""
        download = _Download(f"{to}.part", progress)
        try:
            while not download.is_whole():
                download.wait()
                try:
                    with self._open("GET", "/export/cohort.zip", {"study": study, "tier": tier}, timeout_s=_MOST_MAKING_S,
                                    more_headers=download.headers()) as answer:
                        download.take(answer)
                except TractusError as error:
                    if error.status is not None or download.tag is None:
                        raise
                    download.stalled += 1
                if download.is_stuck():
                    raise TractusError(f"{to}: the connection broke after {download.done} of {download.size} bytes: ask again, "
                                       "or for one study or a lower tier")
            os.replace(download.part, to)
        finally:
            if os.path.exists(download.part):
                os.remove(download.part)

    # --- analyses ---

    def plans(self):
        """The locked analysis plans."""
        return self.ask("GET", "/cohort/plans")["plans"]

    def lock_plan(self, plan, study=None, data_seen=False):
        """Locks a plan (tractus-plan/1, a dictionary) and returns its row."""
        return self.ask("POST", "/cohort/plans", body={"plan": plan, "data_seen": data_seen, **({"study": study} if study else {})})

    def run_plan(self, plan_id, snapshot=None):
        """Runs a locked plan on the present data, or on those of an earlier run, and waits; returns the result."""
        return self._analysed({"plan": plan_id, **({"snapshot": snapshot} if snapshot else {})})

    def analyse(self, method, formula, study=None, **options):
        """Runs one method without a plan (see `tractus stats`) and waits; returns the result."""
        return self._analysed({"method": method, "formula": formula, "options": options, **({"study": study} if study else {})})

    def analysis(self, analysis_id):
        """A run as it is now; `result` is None until it is done."""
        return self.ask("GET", f"/cohort/analyses/{analysis_id}")

    def stop_analysis(self, analysis_id):
        """Stops a run that is queued or running; one that is done stays as it is."""
        return self.ask("POST", f"/cohort/analyses/{analysis_id}/stop")

    def _analysed(self, body):
        run = self.ask("POST", "/cohort/analyses", body=body)
        try:
            while run["state"] in ("queued", "running"):
                time.sleep(0.2)
                run = self.analysis(run["id"])
        except KeyboardInterrupt:
            self.stop_analysis(run["id"])
            raise
        if run["state"] == "cancelled":
            raise TractusError(f"the analysis was {run['error']}")
        if run["state"] != "done":
            raise TractusError(f"the analysis failed: {run['error']}")
        return self.analysis(run["id"])


class _Download:
    """A file that comes over as many connections as it takes."""

    def __init__(self, part, progress):
        self.part, self._progress = part, progress
        self.tag, self.done, self.size = None, 0, None
        self.stalled = 0  # connections in a row that brought nothing

    def is_whole(self):
        return self.done == self.size

    def is_stuck(self):
        """Without a tag nothing says that what follows belongs to what has come."""
        return not self.is_whole() and (self.tag is None or self.stalled >= _MOST_STALLED)

    def wait(self):
        time.sleep(self.stalled)

    def headers(self):
        return {"Range": f"bytes={self.done}-", "If-Range": self.tag} if self.done else {}

    def take(self, answer):
        if answer.status != 206:
            self.done = 0
        before, self.tag = self.done, answer.headers["ETag"]
        self.size = self.done + int(answer.headers["Content-Length"])
        with open(self.part, "ab" if self.done else "wb") as file:
            try:
                while piece := answer.read(_PIECE):
                    file.write(piece)
                    self.done += len(piece)
                    if self._progress:
                        self._progress(self.done / self.size)
            except http.client.IncompleteRead as cut:
                file.write(cut.partial)
                self.done += len(cut.partial)
            except (OSError, http.client.HTTPException):
                pass  # the size tells
        self.stalled = 0 if self.done > before else self.stalled + 1


def _refusal(method, path, error):
    """In words: what the server said, and what to do about it."""
    try:
        said = json.loads(error.read())
    except (OSError, ValueError):
        said = {}
    what = said.get("error") if isinstance(said, dict) else None
    advice = {401: "; the token is unknown, revoked or expired: make a new one on the account page",
              403: "; ask an administrator if you need this"}.get(error.code, "")
    return TractusError(f"{method} {path}: {what or error.reason}{advice}", error.code, said.get("code") if isinstance(said, dict) else None)
