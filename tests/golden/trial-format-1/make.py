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
    "format": "tractus-trial/1", "id": "0123456789abcdef0123456789abcdef",
    "case_id": "00112233445566778899aabbccddeeff" * 2, "station": "bench 1",
    "operator": "simulated hand, seed 7 — Zoë", "simulated": True, "device": "sim-lambda6",
    "started_utc_us": 1772366400123456, "rate_Hz": 4000.0,
    "probe": {"length_m": 0.13, "radius_m": 0.0007, "points": 3, "point_spacing_m": 0.009,
              "pose_offset_m": [0, 0, 0]},
    "extra": {"note": "golden"}}


def f32(x):
    return struct.unpack("<f", struct.pack("<f", x))[0]


def sample(i):
    a = 0.01 * i
    return {"t_s": i / 4000 + 1e-7, "p_VH_m": [0.1 + 1e-5 * i, -0.2, 0.3 - 1e-6 * i],
            "q_VH": [math.cos(a), 0.0, math.sin(a), 0.0],
            "force_N": [f32(0.1 * i), f32(-0.2), f32(1.5)],
            "torque_Nm": [f32(0.001 * i), f32(0.02), f32(-0.003)],
            "rendered_force_N": [f32(0.05 * i), f32(-0.1), f32(0.75)],
            "rendered_torque_Nm": [f32(0.0005 * i), f32(0.01), f32(-0.0015)],
            "deflection_m": [f32(1e-4 * i), f32(-2e-4)],
            "tick": i + (1 if i >= 5 else 0), "iterations": i % 4, "flags": 4 if i == 5 else 0}


def sample_bytes(s):
    out = struct.pack("<d3d4d", s["t_s"], *s["p_VH_m"], *s["q_VH"])
    out += struct.pack("<14f", *s["force_N"], *s["torque_Nm"], *s["rendered_force_N"],
                       *s["rendered_torque_Nm"], *s["deflection_m"])
    out += struct.pack("<IHHII", s["tick"], s["iterations"], s["flags"], 0, 0)
    assert len(out) == 136
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
               "detail": {"breach": True, "wall": "medial", "confidence": 0.8}},
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
