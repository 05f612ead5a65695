"""Writes C3D files, from the format's public description (c3d.org user guide) and apart from our reader: blocks of 512 bytes,
a header of words, parameters by group, then frames of points and analog samples; integers or floats, of any of the three
processors."""
import struct

PROCESSORS = {"intel": 84, "dec": 85, "mips": 86}


def dec_float(value):
    """A VAX F float: IEEE single times four, its two words swapped."""
    if value == 0:
        return b"\0\0\0\0"
    word = struct.unpack("<I", struct.pack("<f", value * 4))[0]
    return struct.pack("<HH", word >> 16, word & 0xffff)


class Order:
    def __init__(self, processor):
        self.sign = ">" if processor == "mips" else "<"
        self.real = dec_float if processor == "dec" else lambda v: struct.pack(self.sign + "f", v)

    def word(self, v):
        return struct.pack(self.sign + "h", v)


def group(number, name, order):
    return struct.pack("bb", len(name), -number) + name.encode() + order.word(3) + b"\0"


def parameter(number, name, kind, dims, data, order):
    body = struct.pack("bB", kind, len(dims)) + bytes(dims) + data + b"\0"
    return struct.pack("bb", len(name), number) + name.encode() + order.word(2 + len(body)) + body


def texts(names):
    width = max(len(n) for n in names)
    return [width, len(names)], "".join(n.ljust(width) for n in names).encode()


def write(path, frames, labels, rate, analog, channels, units, per_frame, processor="intel", scale=-1.0, unit="mm",
          analog_scale=1.0, offset=0):
    """frames: for each, a point's three coordinates or None where it was not seen; analog: per_frame rows for each frame."""
    order = Order(processor)
    reals = scale < 0
    dims, names = texts(labels)
    adims, anames = texts(channels)
    udims, unames = texts(units)
    n = len(channels)
    params = group(1, "POINT", order) + group(2, "ANALOG", order)
    params += parameter(1, "USED", 2, [], order.word(len(labels)), order)
    params += parameter(1, "SCALE", 4, [], order.real(scale), order)
    params += parameter(1, "RATE", 4, [], order.real(rate), order)
    params += parameter(1, "FRAMES", 2, [], order.word(min(len(frames), 32767)), order)
    params += parameter(1, "LABELS", -1, dims, names, order)
    params += parameter(1, "UNITS", -1, [len(unit)], unit.encode(), order)
    params += parameter(2, "USED", 2, [], order.word(n), order)
    params += parameter(2, "LABELS", -1, adims, anames, order)
    params += parameter(2, "UNITS", -1, udims, unames, order)
    params += parameter(2, "GEN_SCALE", 4, [], order.real(1.0), order)
    params += parameter(2, "SCALE", 4, [n], b"".join(order.real(analog_scale) for _ in range(n)), order)
    params += parameter(2, "OFFSET", 2, [n], b"".join(order.word(offset) for _ in range(n)), order)
    params += parameter(2, "RATE", 4, [], order.real(rate * per_frame), order)
    blocks = (4 + len(params) + 2 + 511) // 512
    head = bytes([2, 0x50]) + order.word(len(labels)) + order.word(n * per_frame) + order.word(1)
    head += order.word(min(len(frames), 32767)) + order.word(0) + order.real(scale) + order.word(2 + blocks)
    head += order.word(per_frame) + order.real(rate)
    with open(path, "wb") as out:
        out.write(head.ljust(512, b"\0"))
        out.write((bytes([1, 0x50, blocks, PROCESSORS[processor]]) + params).ljust(512 * blocks, b"\0"))
        for k, points in enumerate(frames):
            for p in points:
                if reals:
                    out.write(b"".join(order.real(float(v)) for v in (p if p is not None else (0, 0, 0))))
                    out.write(order.real(0.0 if p is not None else -1.0))
                else:
                    out.write(b"".join(order.word(round(v / scale)) for v in (p if p is not None else (0, 0, 0))))
                    out.write(order.word(0 if p is not None else -1))
            for row in analog[k * per_frame:(k + 1) * per_frame]:
                for v in row:
                    raw = v / analog_scale + offset
                    out.write(order.real(float(raw)) if reals else order.word(round(raw)))
