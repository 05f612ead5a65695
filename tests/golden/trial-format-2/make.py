"""The golden trials of format 1 again, their samples packed: shared/doc/trial-format.md, nothing of the product.

    python3 make.py        writes palpation.trial, probing.trial and a torn one of each

zstd's frames are written by hand with raw blocks (RFC 8878, 3.1.1), which any reader of zstd takes.
"""
import hashlib
import json
import struct

# Columns (offset, bytes, after): the table of trial-format.md.
PALPATION = ([(o, 8, None) for o in range(0, 64, 8)] + [(o, 4, None) for o in range(64, 88, 4)] +
             [(o, 4, o - 24) for o in range(88, 112, 4)] + [(o, 4, None) for o in (112, 116, 120)] +
             [(124, 2, None), (126, 2, None), (128, 4, None), (132, 4, None)])
PROBING = ([(o, 8, None) for o in (0, 8, 16)] + [(o, 4, None) for o in range(24, 48, 4)] +
           [(48, 4, 40), (52, 4, None), (56, 4, None), (60, 2, None), (62, 2, None)])


def crc32c(data):
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x82F63B78 if crc & 1 else 0)
    return crc ^ 0xFFFFFFFF


def planes(samples, before, columns):
    out = b""
    for offset, width, after in columns:
        limit = 1 << 8 * width
        at = lambda s, o: int.from_bytes(s[o:o + width], "little")
        values, rest = [at(s, offset) for s in before + samples], []
        for i, value in enumerate(values[2:]):
            if after is not None:
                d = value - at(samples[i], after)
            else:
                d = value - 2 * values[i + 1] + values[i]
            d %= limit
            rest.append((d << 1 if d < limit // 2 else (limit - 1 - d) << 1 | 1) % limit)
        for byte in range(width):
            out += bytes(r >> 8 * byte & 255 for r in rest)
    return out


def zstd_raw(content):
    assert len(content) < 65536 + 256
    frame = struct.pack("<IBH", 0xFD2FB528, 0x60, len(content) - 256)  # one segment, size in two bytes
    return frame + struct.pack("<I", len(content) << 3 | 1)[:3] + content  # one raw block, the last


def frames(content):
    at = content.index(b"\n") + 1
    while at < len(content):
        kind, length = struct.unpack_from("<4sI", content, at)
        yield kind, content[at + 20:at + 20 + length]
        at += 20 + length


def repacked(content, size, columns):
    out, sequence, edge = b"tractus-trial/2\n", 0, 0
    before = [bytes(size), bytes(size)]
    for kind, payload in frames(content):
        if kind == b"HEAD":
            head = json.loads(payload)
            head["format"] = "tractus-trial/2"
            payload = json.dumps(head, ensure_ascii=False).encode()
        if kind == b"SAMP":
            count = struct.unpack_from("<I", payload)[0]
            samples = [payload[4 + i * size:4 + (i + 1) * size] for i in range(count)]
            kind, payload = b"PACK", payload[:4] + zstd_raw(planes(samples, before, columns))
            before = (before + samples)[-2:]
        if kind == b"SEAL":
            payload = payload[:8] + hashlib.sha256(out).digest()
        head = struct.pack("<4sIII", kind, len(payload), sequence, crc32c(payload))
        out += head + struct.pack("<I", crc32c(head)) + payload
        sequence += 1
        if kind == b"PACK":
            edge = len(out)
    return out, out[:edge - 100]  # cut within the second block of samples


for rig, folder, size, columns in (("palpation", "trial-format-1", 136, PALPATION),
                                   ("probing", "trial-format-1-probing", 64, PROBING)):
    with open(f"../{folder}/small.trial", "rb") as file:
        whole, torn = repacked(file.read(), size, columns)
    with open(f"{rig}.trial", "wb") as file:
        file.write(whole)
    with open(f"{rig}-torn.trial", "wb") as file:
        file.write(torn)
