"""A probing trial as shared/doc/trial-format.md writes it, made without the product's own code."""
import hashlib
import json
import struct

SAMPLE = struct.Struct("<dddffffffffIHBB")  # 64 bytes
STARTED_UTC_US = 1_770_000_000_000_000


def crc32c_table():
    table = []
    for value in range(256):
        for _ in range(8):
            value = (value >> 1) ^ 0x82F63B78 if value & 1 else value >> 1
        table.append(value)
    return table


TABLE = crc32c_table()


def crc32c(data):
    value = 0xFFFFFFFF
    for byte in data:
        value = TABLE[(value ^ byte) & 0xFF] ^ (value >> 8)
    return value ^ 0xFFFFFFFF


def frame(kind, sequence, payload):
    head = kind + struct.pack("<III", len(payload), sequence, crc32c(payload))
    return head + struct.pack("<I", crc32c(head)) + payload


def samples(count, seed):
    out = struct.pack("<I", count)
    for tick in range(count):
        x_m = 5e-5 * tick
        out += SAMPLE.pack(tick * 1e-3, x_m, 1e-3 * tick, 5e-3, 1.0, 100.0 + seed % 7 if x_m < 0.02 else 6.0, 0.0, 0.0, 0.0, 0.0, 0.0,
                           tick, 0, 1 if x_m < 0.02 else 3, 0)
    return out


def trial_bytes(trial_id, case_id, operator, count=560, seed=0, fields=None, breach=True):
    """A whole, sealed trial whose answer is `breach`. `fields` replace those of the header."""
    header = {"format": "tractus-trial/2", "id": trial_id, "case_id": case_id, "station": "station", "operator": operator,
              "simulated": False, "device": "sim-rig", "started_utc_us": STARTED_UTC_US + seed * 60_000_000, "rate_Hz": 1000.0,
              "probe": {"travel_m": 0.028}, "extra": {}, "rig": "probing"} | (fields or {})
    end_s = count * 1e-3
    answer = {"t_s": end_s, "kind": "answer", "detail": {"breach": breach, "wall": None, "confidence": 0.75, "depth_m": 0.021 if breach else None}}
    payloads = [(b"HEAD", json.dumps(header).encode()), (b"EVNT", b'{"t_s":0.0,"kind":"start","detail":{}}'),
                (b"SAMP", samples(count, seed)), (b"EVNT", json.dumps(answer).encode()),
                (b"EVNT", json.dumps({"t_s": end_s, "kind": "end", "detail": {}}).encode())]
    return sealed(payloads, count)


def sealed(payloads, count):
    out = b"tractus-trial/2\n"
    for sequence, (kind, payload) in enumerate(payloads):
        out += frame(kind, sequence, payload)
    seal = struct.pack("<Q", count) + hashlib.sha256(out).digest()
    return out + frame(b"SEAL", len(payloads), seal)


def announced(client, trial_id, case_id, data):
    """Announces and sends a trial; the answer of the last step that was taken."""
    told = {"case_id": case_id, "size_bytes": len(data), "sha256": hashlib.sha256(data).hexdigest()}
    answer = client.ask("PUT", f"/uploads/{trial_id}", told)
    if answer.status != 200:
        return answer
    return client.ask("PATCH", f"/uploads/{trial_id}?offset_bytes=0", data, kind="application/octet-stream",
                      headers={"X-Crc32c": f"{crc32c(data):08x}"})


def hand_over(client, trial_id, case_id, data):
    answer = announced(client, trial_id, case_id, data)
    return client.ask("POST", f"/uploads/{trial_id}/commit") if answer.status == 200 else answer
