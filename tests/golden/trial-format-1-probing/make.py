"""Writes small.trial, torn.trial and expected.json from shared/doc/trial-format.md alone, sharing no code with the product.

    python3 make.py      (Python >= 3.8, standard library only)
"""
import hashlib
import json
import math
import struct


def crc32c(data):
    """CRC-32C bit by bit: reflected polynomial 0x82F63B78, all ones in and out."""
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = (crc >> 1) ^ (0x82F63B78 if crc & 1 else 0)
    return crc ^ 0xFFFFFFFF


assert crc32c(b"123456789") == 0xE3069283  # RFC 3720

HEADER = {
    "format": "tractus-trial/1", "id": "fedcba9876543210fedcba9876543210",
    "case_id": "ffeeddccbbaa99887766554433221100" * 2, "station": "bench 2",
    "operator": "simulated surgeon, seed 3", "simulated": True, "device": "sim-rig",
    "started_utc_us": 1772366400123456, "rate_Hz": 1000.0, "probe": {"travel_m": 0.05},
    "extra": {"note": "golden"}, "rig": "probing"}


def f32(x):
    return struct.unpack("<f", struct.pack("<f", x))[0]


def sample(i):
    return {"t_s": i / 1000 + 1e-7, "x_m": 1e-5 * i, "theta_rad": 0.8e-3 * i,
            "speed_m_s": f32(0.006), "turning_rad_s": f32(0.8), "fz_N": f32(90.5 + i),
            "tz_Nm": f32(0.02), "command_m_s": f32(0.0061), "command_Nm": f32(-0.015),
            "law_m_s": f32(0.0062), "round_trip_s": f32(7.5e-5 + 1e-6 * i),
            "tick": i + (2 if i >= 5 else 0), "flags": 4 | 32 if i == 5 else 64 | 8 if i == 7 else 0,
            "mode": i % 5, "fault": 1 if i == 11 else 0}


def sample_bytes(s):
    out = struct.pack("<3d", s["t_s"], s["x_m"], s["theta_rad"])
    out += struct.pack("<8f", s["speed_m_s"], s["turning_rad_s"], s["fz_N"], s["tz_Nm"],
                       s["command_m_s"], s["command_Nm"], s["law_m_s"], s["round_trip_s"])
    out += struct.pack("<IHBB", s["tick"], s["flags"], s["mode"], s["fault"])
    assert len(out) == 64
    return out


class Writer:
    def __init__(self):
        self.bytes, self.sequence = b"tractus-trial/1\n", 0

    def frame(self, kind, payload):
        head = struct.pack("<4sIII", kind, len(payload), self.sequence, crc32c(payload))
        self.bytes += head + struct.pack("<I", crc32c(head)) + payload
        self.sequence += 1

    def json(self, kind, value):
        self.frame(kind, json.dumps(value, ensure_ascii=False).encode())

    def samples(self, block):
        self.frame(b"SAMP", struct.pack("<I", len(block)) + b"".join(map(sample_bytes, block)))

    def seal(self, count):
        self.frame(b"SEAL", struct.pack("<Q", count) + hashlib.sha256(self.bytes).digest())


def main():
    samples = [sample(i) for i in range(12)]
    events = [{"t_s": 0, "kind": "start", "detail": {}},
              {"t_s": 0.0025, "kind": "answer",
               "detail": {"breach": True, "wall": "lateral", "confidence": 0.6}},
              {"t_s": 0.003, "kind": "end", "detail": {"why": "answered"}}]
    w = Writer()
    w.json(b"HEAD", HEADER)
    w.json(b"EVNT", events[0])
    w.samples(samples[:5])
    w.samples(samples[5:])
    edge = len(w.bytes)
    w.json(b"EVNT", events[1])
    w.json(b"EVNT", events[2])
    w.seal(len(samples))
    with open("small.trial", "wb") as file:
        file.write(w.bytes)
    with open("torn.trial", "wb") as file:
        file.write(w.bytes[:edge - 100])  # within the second block of samples
    with open("expected.json", "w") as file:
        json.dump({"header": HEADER, "samples": samples, "events": events}, file, indent=1,
                  ensure_ascii=False)


main()
