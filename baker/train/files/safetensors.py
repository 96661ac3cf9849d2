"""The safetensors container: 8-byte little-endian header length, JSON header, raw data."""
import json
import os
import struct

import numpy as np

from .write_file import written

_TYPES = {
    "F64": np.float64,
    "F32": np.float32,
    "F16": np.float16,
    "I64": np.int64,
    "I32": np.int32,
    "I8": np.int8,
    "U8": np.uint8,
    "BOOL": np.bool_,
}
_CODES = {np.dtype(v): k for k, v in _TYPES.items()}
_LARGEST_HEADER = 16 << 20


class BadData(Exception):
    """Unusable input; the text is one line: what, where, how to mend."""


def refuse_over(outputs, inputs):
    """Throws BadData where a file that will be written is one that is read, through whatever links."""
    there = [i for i in inputs if os.path.isfile(i)]
    for output in outputs:
        if os.path.isfile(output) and any(os.path.samefile(i, output) for i in there):
            raise BadData(f"{output} is the input; give another name")


def _header(path, file, size):
    (length,) = struct.unpack("<Q", file.read(8)) if size >= 8 else (0,)
    if not 2 <= length <= min(_LARGEST_HEADER, size - 8):
        raise BadData(f"{path}: not a safetensors file, or cut short in its header; make it again")
    try:
        header = json.loads(file.read(length))
        return dict(header.pop("__metadata__", {})), header
    except (ValueError, AttributeError, TypeError):
        raise BadData(f"{path}: its header is not JSON; make it again") from None


def _entry(path, name, entry):
    """(type, shape, first byte, end) of a tensor."""
    try:
        kind, shape = _TYPES[entry["dtype"]], [int(n) for n in entry["shape"]]
        begin, end = map(int, entry["data_offsets"])
        size = int(np.prod(shape, dtype=np.int64)) * np.dtype(kind).itemsize
        if min(shape, default=0) >= 0 and 0 <= begin and end - begin == size:
            return kind, shape, begin, end
    except (KeyError, TypeError, ValueError):
        pass
    raise BadData(f"{path}: tensor {name}: its type, shape and size do not agree; make the file again")


def load(path):
    """(tensors: name -> array, metadata: name -> str). The arrays are mapped, not read."""
    try:
        size = os.path.getsize(path)
        with open(path, "rb") as file:
            metadata, header = _header(path, file, size)
            start = file.tell()
    except OSError as error:
        raise BadData(f"{path}: {error.strerror}") from None
    if size == start:
        return {}, metadata
    data = np.memmap(path, np.uint8, "r", start)
    tensors = {}
    for name, entry in header.items():
        kind, shape, begin, end = _entry(path, name, entry)
        if end > data.size:
            raise BadData(
                f"{path}: cut short: tensor {name} ends at byte {end} of {data.size}; make the file again"
            )
        tensors[name] = data[begin:end].view(kind).reshape(shape)
    return tensors, metadata


def save(path, tensors, metadata):
    """tensors: name -> array; metadata: name -> value, written as text. Beside its place first, then
    renamed; data start is 64-byte aligned by padding the header."""
    header, offset = {"__metadata__": {k: str(v) for k, v in metadata.items()}}, 0
    arrays = {k: np.ascontiguousarray(v) for k, v in tensors.items()}
    for name, a in arrays.items():
        header[name] = {
            "dtype": _CODES[a.dtype],
            "shape": list(a.shape),
            "data_offsets": [offset, offset + a.nbytes],
        }
        offset += a.nbytes
    text = json.dumps(header).encode()
    text += b" " * (-(8 + len(text)) % 64)
    with written(path, "wb") as file:
        file.write(struct.pack("<Q", len(text)) + text)
        for a in arrays.values():
            file.write(a.tobytes())
