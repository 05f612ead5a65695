#!/usr/bin/env python3
"""Reads a cohort from a Tractus server: trials, scores, dictionary, and the samples of one trial.

    TRACTUS_PASSWORD=... ./read_cohort.py https://sim.example.org:8480 --name rex --authority authority.pem [--study spine-1]
"""
import argparse, csv, getpass, io, json, os, ssl, urllib.parse, urllib.request

import numpy


class Server:
    def __init__(self, url, authority=None):
        self.url = url.rstrip("/") + "/api/v1"
        context = ssl.create_default_context(cafile=authority)
        self.opener = urllib.request.build_opener(urllib.request.HTTPSHandler(context=context), urllib.request.HTTPCookieProcessor())

    def sign_in(self, name, password):
        body = json.dumps({"name": name, "password": password}).encode()
        request = urllib.request.Request(self.url + "/session", body, {"Content-Type": "application/json"})
        # urllib keeps a Secure cookie for https alone; on plain loopback the server sends none that is Secure.
        self.opener.open(request).close()

    def bytes_of(self, path, **query):
        query = "?" + urllib.parse.urlencode(query) if query else ""
        with self.opener.open(self.url + path + query) as answer:
            return answer.read()

    def table(self, name, **query):
        """Rows as dictionaries; an empty cell is None."""
        text = self.bytes_of(f"/export/{name}.csv", **query).decode("utf-8")
        return [{k: (v if v != "" else None) for k, v in row.items()} for row in csv.DictReader(io.StringIO(text, newline=""))]

    def samples(self, trial, rate_Hz=100):
        """Array of doubles, a row per sample; its columns by dictionary.csv (table: the trial's rig)."""
        return numpy.load(io.BytesIO(self.bytes_of(f"/export/trials/{trial}/samples.npy", rate_Hz=rate_Hz)), allow_pickle=False)


def main():
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument("url"), asked.add_argument("--name", required=True)
    asked.add_argument("--authority"), asked.add_argument("--study")
    asked = asked.parse_args()
    server = Server(asked.url, asked.authority)
    server.sign_in(asked.name, os.environ.get("TRACTUS_PASSWORD") or getpass.getpass())
    of = {"study": asked.study} if asked.study else {}
    trials, scores, dictionary = server.table("trials", **of), server.table("scores", **of), server.table("dictionary")
    print(f"{len(trials)} trials of {len({t['participant'] for t in trials})} participants, {len(scores)} scores")
    for trial in trials[:1]:
        samples = server.samples(trial["trial"])
        columns = [row["column"] for row in dictionary if row["table"] == trial["rig"]]
        print(f"{trial['trial']} ({trial['rig']}): {samples.shape[0]} rows at 100 Hz of {', '.join(columns)}")
        assert samples.shape[1] == len(columns)


if __name__ == "__main__":
    main()
