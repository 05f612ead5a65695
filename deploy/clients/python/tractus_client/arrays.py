"""NumPy's .npy format, version 1.0, with or without NumPy."""
import ast
import io
import struct

from .errors import TractusError

try:
    import numpy
except ImportError:
    numpy = None


def npy_shape(file, name="array"):
    """Rows and columns; the file is then at the first row."""
    if file.read(8) != b"\x93NUMPY\x01\x00":
        raise TractusError(f"{name}: not a .npy file of version 1.0")
    head = ast.literal_eval(file.read(struct.unpack("<H", file.read(2))[0]).decode("latin1"))
    if head["descr"] != "<f8" or head["fortran_order"] or len(head["shape"]) != 2:
        raise TractusError(f"{name}: little-endian doubles row after row are expected")
    return head["shape"]


def parse_npy(data, name="array"):
    """A numpy array, or a list of tuples if NumPy is not installed."""
    file = io.BytesIO(data)
    rows, columns = npy_shape(file, name)
    begin = file.tell()
    if len(data) - begin != rows * columns * 8:
        raise TractusError(f"{name}: has {len(data) - begin} bytes of data, expected {rows * columns * 8}")
    if numpy:
        return numpy.frombuffer(data, "<f8", offset=begin).reshape(rows, columns)
    values = struct.unpack(f"<{rows * columns}d", data[begin:])
    return [values[row * columns:(row + 1) * columns] for row in range(rows)]
