"""NumPy's .npy format, version 1.0, with or without NumPy."""
import ast
import struct

from .errors import TractusError

try:
    import numpy
except ImportError:
    numpy = None


def parse_npy(data, name="array"):
    """A numpy array, or a list of tuples if NumPy is not installed."""
    if data[:8] != b"\x93NUMPY\x01\x00":
        raise TractusError(f"{name}: not a .npy file of version 1.0")
    begin = 10 + struct.unpack("<H", data[8:10])[0]
    head = ast.literal_eval(data[10:begin].decode("latin1"))
    if head["descr"] != "<f8" or head["fortran_order"] or len(head["shape"]) != 2:
        raise TractusError(f"{name}: little-endian doubles row after row are expected")
    rows, columns = head["shape"]
    if len(data) - begin != rows * columns * 8:
        raise TractusError(f"{name}: has {len(data) - begin} bytes of data, expected {rows * columns * 8}")
    if numpy:
        return numpy.frombuffer(data, "<f8", offset=begin).reshape(rows, columns)
    values = struct.unpack(f"<{rows * columns}d", data[begin:])
    return [values[row * columns:(row + 1) * columns] for row in range(rows)]
