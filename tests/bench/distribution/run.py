#!/usr/bin/env python3
"""A case's volume fetched by several stations at once: this server against nginx and Orthanc, the same bytes in the same run.

    python3 tests/bench/distribution/run.py [--bin build/release/bin] [--stations 4] [--rounds 5]

Plain HTTP on the loopback, curl as the station, rounds in turn, the best of each. Exits 1 when a figure is missed. Orthanc keeps
the file as an attachment and is left out, by name, when it is not installed (Debian: nginx-light, orthanc).
"""
import argparse, base64, gzip, json, os, shutil, socket, struct, subprocess, sys, tempfile, time, urllib.request

SIDE, FETCHES = 320, 60  # voxels along the cube; times each station fetches it a round


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def wait_for(url):
    for _ in range(200):
        try:
            return urllib.request.urlopen(url, timeout=1)
        except urllib.error.HTTPError:
            return None
        except OSError:
            time.sleep(0.05)
    sys.exit(f"nothing answers at {url}")


def noise_volume(path):
    """NIfTI of noise: zstd cannot make it small."""
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, SIDE, SIDE, SIDE, 1, 1, 1, 1)
    struct.pack_into("<2h", header, 70, 4, 16)
    struct.pack_into("<8f", header, 76, 1, 0.3, 0.3, 0.3, 0, 0, 0, 0)
    struct.pack_into("<f2f", header, 108, 352, 1, 0)
    header[123] = 2
    struct.pack_into("<2h", header, 252, 0, 1)
    for row, at in enumerate((280, 296, 312)):
        values = [0.0] * 4
        values[row] = 0.3
        struct.pack_into("<4f", header, at, *values)
    header[344:348] = b"n+1\0"
    with open(path, "wb") as file:
        file.write(header)
        for _ in range(SIDE):
            block = bytearray(os.urandom(2 * SIDE * SIDE))
            for i in range(1, len(block), 2):
                block[i] &= 3  # 0 to 1023
            file.write(block)


def published(home, bin):
    volume = home / "noise.nii"
    noise_volume(volume)
    run = lambda *a: subprocess.run([str(x) for x in a], check=True, stdout=subprocess.DEVNULL)
    run(bin / "tractus", "import", volume, home / "v.tvol")
    mid = SIDE * 0.15
    run(bin / "tractus", "carve", "--volume", home / "v.tvol", "--entry", f"{-mid},{20 - mid},{mid}", "--target", f"{-mid},{-mid - 20},{mid}",
        "--title", "noise", "--source", "simulated noise", "--key", home / "key", "--out", home / "case")
    (home / "password").write_text("a long password for a bench\n")
    run(bin / "tractus-server", "init", "--data", home / "data", "--admin-name", "admin", "--password-file", home / "password")
    run(bin / "tractus-server", "publish", "--data", home / "data", home / "case")
    run(bin / "tractus-server", "enrol", "--data", home / "data", "--name", "s", "--out", home / "token")
    return home / "case" / "volume.tvol", (home / "token").read_text().strip()


def start_ours(home, bin, token):
    port = free_port()
    process = subprocess.Popen([bin / "tractus-server", "serve", "--data", home / "data", "--listen", f"127.0.0.1:{port}", "--plain"],
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    base = f"http://127.0.0.1:{port}/api/v1"
    wait_for(base + "/session")
    headers = {"Authorization": f"Bearer {token}"}
    cases = json.load(urllib.request.urlopen(urllib.request.Request(base + "/cases", headers=headers)))["cases"]
    return process, f"{base}/cases/{cases[0]['id']}/parts/volume.tvol", [f"Authorization: Bearer {token}"]


def start_nginx(home, file):
    port, folder = free_port(), home / "nginx"
    (folder / "files").mkdir(parents=True)
    os.link(file, folder / "files" / "volume.tvol")
    for path in (home, folder, folder / "files"):
        path.chmod(0o755)
    (folder / "nginx.conf").write_text(f"""
worker_processes 2; daemon off; pid {folder}/pid; error_log {folder}/error.log;
events {{ worker_connections 64; }}
http {{ access_log off; sendfile on; tcp_nopush on;
  client_body_temp_path {folder}/a; proxy_temp_path {folder}/b; fastcgi_temp_path {folder}/c; uwsgi_temp_path {folder}/d; scgi_temp_path {folder}/e;
  server {{ listen 127.0.0.1:{port}; root {folder}/files; }} }}""")
    process = subprocess.Popen(["nginx", "-c", folder / "nginx.conf", "-e", folder / "error.log"])
    url = f"http://127.0.0.1:{port}/volume.tvol"
    wait_for(url)
    return process, url, []


def start_orthanc(home, file):
    port, folder = free_port(), home / "orthanc"
    folder.mkdir()
    (folder / "orthanc.json").write_text(json.dumps({
        "StorageDirectory": str(folder / "db"), "IndexDirectory": str(folder / "db"), "HttpPort": port, "DicomServerEnabled": False,
        "RemoteAccessAllowed": False, "AuthenticationEnabled": False, "StorageCompression": False, "HttpThreadsCount": 8,
        "HttpCompressionEnabled": False, "Plugins": []}))
    process = subprocess.Popen(["Orthanc", folder / "orthanc.json"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    base = f"http://127.0.0.1:{port}"
    wait_for(base + "/system")
    ask = lambda method, path, body: json.load(urllib.request.urlopen(urllib.request.Request(base + path, data=body, method=method)))
    made = ask("POST", "/tools/create-dicom", json.dumps({"Tags": {"PatientName": "SIMULATED", "SOPClassUID": "1.2.840.10008.5.1.4.1.1.7"}}).encode())
    path = f"/instances/{made['ID']}/attachments/1024"
    ask("PUT", path, file.read_bytes())
    return process, base + path + "/data", []


def fetched(url, headers, stations, size):
    """Bytes a second over all stations."""
    command = ["curl", "-sf", "--write-out", "%{size_download}\\n"] + [x for h in headers for x in ("-H", h)]
    command += [x for _ in range(FETCHES) for x in ("-o", "/dev/null", url)]
    start = time.monotonic()
    running = [subprocess.Popen(command, stdout=subprocess.PIPE) for _ in range(stations)]
    sizes = [int(n) for p in running for n in p.communicate()[0].split()]
    elapsed = time.monotonic() - start
    if sizes != [size] * (stations * FETCHES):
        sys.exit(f"{url}: {len(sizes)} fetches of {set(sizes)} bytes, {stations * FETCHES} of {size} expected")
    return sum(sizes) / elapsed


def main():
    from pathlib import Path
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=Path, default=Path("build/release/bin"))
    parser.add_argument("--stations", type=int, default=4)
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    if not shutil.which("nginx"):
        sys.exit("nginx is not installed (Debian: nginx-light)")
    home, servers = Path(tempfile.mkdtemp(prefix="tractus-distribution-")), {}
    try:
        file, token = published(home, options.bin.resolve())
        servers["tractus-server"] = start_ours(home, options.bin.resolve(), token)
        servers["nginx"] = start_nginx(home, file)
        if shutil.which("Orthanc"):
            servers["Orthanc"] = start_orthanc(home, file)
        size = file.stat().st_size
        best = dict.fromkeys(servers, 0.0)
        for _ in range(options.rounds):
            for name, (_, url, headers) in servers.items():
                best[name] = max(best[name], fetched(url, headers, options.stations, size))
    finally:
        for process, _, _ in servers.values():
            process.terminate()
            process.wait()
        shutil.rmtree(home)
    print(f"{size / 2**20:.0f} MiB, {options.stations} stations, best of {options.rounds} rounds")
    for name, speed in best.items():
        print(f"  {name:15} {speed / 1e6:8.0f} MB/s   {best['tractus-server'] / speed:5.2f} x")
    met = best["tractus-server"] >= 0.8 * best["nginx"] and best["tractus-server"] >= best.get("Orthanc", 0.0)
    print("at least 0.8 x nginx, and Orthanc:" if "Orthanc" in best else "at least 0.8 x nginx (Orthanc is not installed):", "met" if met else "MISSED")
    sys.exit(0 if met else 1)


main()
