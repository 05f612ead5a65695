#!/usr/bin/env python3
"""Holds deploy/operations against a real server: each metric and route that an alert rule or a panel names is one that it exposes.

    tests/operations/operations_test.py --bin build/release/bin

Where promtool is installed (Debian: prometheus), the rules are checked and tried on the series of alerts_test.yml too."""
import argparse
import json
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.request
from pathlib import Path

OPERATIONS = Path(__file__).resolve().parents[2] / "deploy/operations"
METRIC = re.compile(r"\btractus_\w+")
ROUTE = re.compile(r'route="(\w+)"')


def exposed(binary, folder):
    """The samples' names in what a new server answers to Prometheus, after a few requests."""
    data, token = folder / "data", folder / "token"
    subprocess.run([binary, "init", "--data", data], check=True, capture_output=True)
    subprocess.run([binary, "enrol", "--data", data, "--name", "prometheus", "--out", token], check=True, capture_output=True)
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    server = subprocess.Popen([binary, "serve", "--data", data, "--plain", "--listen", f"127.0.0.1:{port}"],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        asked = urllib.request.Request(f"http://127.0.0.1:{port}/api/v1/server/metrics",
                                       headers={"Authorization": f"Bearer {token.read_text().strip()}"})
        end, answers = time.monotonic() + 120, 0
        while answers < 2:  # the first one is counted in the second
            try:
                with urllib.request.urlopen(asked, timeout=60) as answer:
                    text = answer.read().decode()
                answers += 1
            except OSError:
                if time.monotonic() > end:
                    raise
                time.sleep(0.1)
        return set(re.findall(r"^(tractus_\w+)[{ ]", text, re.MULTILINE))
    finally:
        server.terminate()
        server.wait()


def rules():
    """The text of each rule's expression: each is one line in alerts.yml."""
    return re.findall(r"^\s+expr: (.+)$", (OPERATIONS / "alerts.yml").read_text(), re.MULTILINE)


def panels():
    return [target["expr"] for panel in json.loads((OPERATIONS / "dashboard.json").read_text())["panels"] for target in panel["targets"]]


class Operations(unittest.TestCase):
    def test_each_metric_that_a_rule_or_a_panel_names_is_exposed(self):
        self.assertEqual((len(rules()) > 5, len(panels()) > 10), (True, True))
        with tempfile.TemporaryDirectory() as folder:
            names = exposed(self.binary, Path(folder))
        for expression in rules() + panels():
            if "up{" not in expression:  # Prometheus' own
                self.assertTrue(METRIC.search(expression), expression)
            self.assertLessEqual(set(METRIC.findall(expression)), names, expression)

    def test_each_route_that_a_rule_names_is_one_of_the_servers(self):
        printed = subprocess.run([self.binary, "openapi"], check=True, capture_output=True, text=True).stdout
        routes = {operation["operationId"] for path in json.loads(printed)["paths"].values() for operation in path.values()
                  if isinstance(operation, dict) and "operationId" in operation}
        named = {route for expression in rules() for route in ROUTE.findall(expression)}
        self.assertTrue(named)
        self.assertLessEqual(named, routes)

    def test_each_alert_names_a_section_of_the_runbook(self):
        sections = set(re.findall(r"^### (.+)$", (OPERATIONS / "README.md").read_text(), re.MULTILINE))
        named = re.findall(r"^\s+runbook: (.+)$", (OPERATIONS / "alerts.yml").read_text(), re.MULTILINE)
        self.assertEqual(len(named), len(rules()))
        self.assertLessEqual(set(named), sections)

    @unittest.skipUnless(shutil.which("promtool"), "promtool is not installed")
    def test_the_alerts_are_raised_when_they_must_be(self):
        tried = subprocess.run(["promtool", "test", "rules", OPERATIONS / "alerts_test.yml"], capture_output=True, text=True)
        self.assertEqual(tried.returncode, 0, tried.stdout + tried.stderr)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=Path, required=True, help="folder of the programs")
    at, others = parser.parse_known_args()
    Operations.binary = at.bin.resolve() / "tractus-server"
    unittest.main(argv=[sys.argv[0], *others], verbosity=2)
