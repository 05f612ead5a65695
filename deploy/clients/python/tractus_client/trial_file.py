"""Trial files (.ttrial), formats tractus-trial/1 and /2, as trial-format.md describes them. Needs NumPy."""
import ctypes
import ctypes.util
import hashlib
import json
import struct

from .arrays import numpy
from .errors import TractusError

_MAX_PAYLOAD = 1 << 20
# name, type, number of components; then for packing: the field that the residual refers to.
_PALPATION = [("t_s", "<f8", 1), ("p_VH_m", "<f8", 3), ("q_VH", "<f8", 4), ("force_N", "<f4", 3), ("torque_Nm", "<f4", 3),
              ("rendered_force_N", "<f4", 3), ("rendered_torque_Nm", "<f4", 3), ("deflection_m", "<f4", 2), ("tick", "<u4", 1),
              ("iterations", "<u2", 1), ("flags", "<u2", 1), ("patches", "<u4", 1), ("reserved", "<u4", 1)]
_PROBING = [("t_s", "<f8", 1), ("x_m", "<f8", 1), ("theta_rad", "<f8", 1), ("speed_m_s", "<f4", 1), ("turning_rad_s", "<f4", 1),
            ("fz_N", "<f4", 1), ("tz_Nm", "<f4", 1), ("command_m_s", "<f4", 1), ("command_Nm", "<f4", 1), ("law_m_s", "<f4", 1),
            ("round_trip_s", "<f4", 1), ("tick", "<u4", 1), ("flags", "<u2", 1), ("mode", "u1", 1), ("fault", "u1", 1)]
_REFERS = {"rendered_force_N": "force_N", "rendered_torque_Nm": "torque_Nm", "law_m_s": "command_m_s"}


class Trial:
    """`header` and `events` as the file has them; `samples` a structured NumPy array, a field per quantity in SI units.

    sealed: the end of the file is there and its SHA-256 holds; complete: the trial was ended, not interrupted.
    """

    def __init__(self, header, samples, events, sealed):
        self.header, self.samples, self.events, self.sealed = header, samples, events, sealed
        self.complete = sealed and any(event["kind"] == "end" for event in events)

    def frame(self):
        """A pandas.DataFrame, a column per number; needs pandas."""
        import pandas
        columns = {}
        for name in self.samples.dtype.names:
            field = self.samples[name]
            if field.ndim == 1:
                columns[name] = field
            else:
                columns.update({f"{name}_{i}": field[:, i] for i in range(field.shape[1])})
        return pandas.DataFrame(columns)


def _sample_type(fields):
    return numpy.dtype([(name, kind) if count == 1 else (name, kind, (count,)) for name, kind, count in fields])


def _packed_columns(fields):
    """(offset, bytes, offset that the residual refers to) of each column; mode and fault are one."""
    kind, columns = _sample_type(fields), []
    for name, _, count in fields:
        if name == "fault":
            continue
        offset, width = kind.fields[name][1], 2 if name == "mode" else kind.fields[name][0].base.itemsize
        after = kind.fields[_REFERS[name]][1] if name in _REFERS else None
        columns += [(offset + i * width, width, None if after is None else after + i * width) for i in range(count)]
    return columns


def _crc32c_table():
    table = []
    for byte in range(256):
        for _ in range(8):
            byte = byte >> 1 ^ (0x82F63B78 if byte & 1 else 0)
        table.append(byte)
    return table


_CRC32C = _crc32c_table()


def _crc32c(data):
    crc = 0xFFFFFFFF
    for byte in data:
        crc = crc >> 8 ^ _CRC32C[(crc ^ byte) & 255]
    return crc ^ 0xFFFFFFFF


def _zstd():
    """A function (compressed, size) -> bytes: Python 3.14's own, the module zstandard, or the library libzstd."""
    try:
        from compression import zstd
        return lambda data, size: zstd.decompress(data)
    except ImportError:
        pass
    try:
        import zstandard
        return lambda data, size: zstandard.ZstdDecompressor().decompress(data, max_output_size=size)
    except ImportError:
        pass
    library = ctypes.util.find_library("zstd")
    if not library:
        raise TractusError("to read packed samples, install the Python module zstandard or the library libzstd")
    decompress = ctypes.CDLL(library).ZSTD_decompress
    decompress.restype = ctypes.c_size_t
    decompress.argtypes = [ctypes.c_void_p, ctypes.c_size_t, ctypes.c_char_p, ctypes.c_size_t]

    def with_library(data, size):
        out = ctypes.create_string_buffer(size)
        return out.raw if decompress(out, size, data, len(data)) == size else b""
    return with_library


class _Reader:
    def __init__(self, path):
        try:
            with open(path, "rb") as file:
                self.data = file.read()
        except OSError as reason:
            raise TractusError(f"{path}: cannot be read: {reason.strerror}") from None
        self.path, self.decompress = path, None
        self.header, self.blocks, self.events, self.sealed = None, [], [], False
        self.before = None  # the last two samples, for the next packed block

    def wrong(self, offset, what):
        return TractusError(f"{self.path}: offset {offset}: {what}")

    def frames(self):
        """(offset, type, payload) of each whole frame; a torn end is passed over."""
        if self.data[:16] not in (b"tractus-trial/1\n", b"tractus-trial/2\n"):
            raise TractusError(f"{self.path}: not a trial file of Tractus")
        at, sequence = 16, 0
        while at < len(self.data):
            rest = self.data[at:at + 20]
            if len(rest) < 20 or not any(rest):
                return
            kind, length, number, payload_crc, header_crc = struct.unpack("<4sIIII", rest)
            if _crc32c(rest[:16]) != header_crc or number != sequence or length > _MAX_PAYLOAD:
                raise self.wrong(at, "the checksum of a frame's header does not hold")
            payload = self.data[at + 20:at + 20 + length]
            if len(payload) < length:
                return
            if not self.is_whole and _crc32c(payload) != payload_crc:
                raise self.wrong(at, "the checksum of a frame's payload does not hold")
            yield at, kind, payload
            at, sequence = at + 20 + length, sequence + 1

    def read(self):
        # The SHA-256 of the end frame covers every byte; the slower checksums are needed without it alone.
        seal = self.data[-60:]
        self.is_whole = seal[:4] == b"SEAL" and seal[28:] == hashlib.sha256(self.data[:-60]).digest()
        for at, kind, payload in self.frames():
            if self.sealed or (self.header is None) != (kind == b"HEAD"):
                raise self.wrong(at, "frames in the wrong order")
            self.take(at, kind, payload)
        if self.header is None:
            raise TractusError(f"{self.path}: the file holds no whole header")
        samples = numpy.concatenate(self.blocks) if self.blocks else numpy.empty(0, self.type)
        return Trial(self.header, samples, self.events, self.sealed)

    def take(self, at, kind, payload):
        if kind == b"HEAD":
            self.header = json.loads(payload)
            self.fields = _PROBING if self.header.get("rig") == "probing" else _PALPATION
            self.type = _sample_type(self.fields)
            self.before = numpy.zeros(2, self.type)
        elif kind == b"EVNT":
            self.events.append(json.loads(payload))
        elif kind in (b"SAMP", b"PACK"):
            self.take_samples(at, kind, payload)
        elif kind == b"SEAL":
            self.take_seal(at, payload)
        else:
            raise self.wrong(at, f"frame of unknown type {kind!r}")

    def take_samples(self, at, kind, payload):
        count = struct.unpack_from("<I", payload)[0]
        content = payload[4:]
        if kind == b"PACK":
            self.decompress = self.decompress or _zstd()
            content = self.decompress(content, count * self.type.itemsize)
        if count == 0 or len(content) != count * self.type.itemsize:
            raise self.wrong(at, f"{count} samples said, {len(content)} bytes given")
        block = numpy.frombuffer(content, self.type) if kind == b"SAMP" else self.unpacked(content, count)
        self.blocks.append(block)
        self.before = numpy.concatenate([self.before, block])[-2:]

    def unpacked(self, content, count):
        planes = numpy.frombuffer(content, "u1").reshape(self.type.itemsize, count)
        out = numpy.zeros((count, self.type.itemsize), "u1")
        before, row = self.before.view("u1").reshape(2, -1), 0
        for offset, width, after in _packed_columns(self.fields):
            kind = f"<u{width}"
            z = numpy.ascontiguousarray(planes[row:row + width].T).view(kind)[:, 0]
            residual = (z >> 1) ^ (0 - (z & 1)).astype(kind)
            if after is not None:
                values = residual + numpy.ascontiguousarray(out[:, after:after + width]).view(kind)[:, 0]
            else:
                first, second = numpy.ascontiguousarray(before[:, offset:offset + width]).view(kind)[:, 0]
                residual = residual.copy()
                residual[0] += second - first
                steps = numpy.cumsum(residual, dtype=kind)
                steps[0] += second
                values = numpy.cumsum(steps, dtype=kind)
            out[:, offset:offset + width] = values.astype(kind).view("u1").reshape(count, width)
            row += width
        return out.reshape(-1).view(self.type)

    def take_seal(self, at, payload):
        count = struct.unpack_from("<Q", payload)[0] if len(payload) == 40 else -1
        if not self.is_whole or count != sum(map(len, self.blocks)):
            raise self.wrong(at, "the end frame does not hold: its SHA-256 or its number of samples differs")
        self.sealed = True


def read_trial(path):
    """Reads a whole trial file. Errors name the file, the offset and what does not hold."""
    if numpy is None:
        raise TractusError("to read a trial file, install NumPy")
    with numpy.errstate(over="ignore"):
        return _Reader(path).read()
