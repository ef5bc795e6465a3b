"""Image files as bytes, written without a library: OpenEXR and PNG."""

import struct
import zlib

import numpy as np


def exr(pixels):
    """Returns the bytes of an uncompressed OpenEXR file of 32-bit floats. `pixels`: (height, width, 3), rows from the top."""
    height, width = pixels.shape[:2]
    # A row has all its values of B, then those of G, then those of R.
    rows = np.ascontiguousarray(pixels[:, :, ::-1].transpose(0, 2, 1), dtype="<f4")

    def attribute(name, kind, data):
        return name + b"\0" + kind + b"\0" + struct.pack("<i", len(data)) + data

    box = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    # For each channel: its name, the type 2 (float), four unused bytes, and 1, 1: each column and each row has a sample.
    channels = b"".join(name + b"\0" + struct.pack("<iBBBBii", 2, 0, 0, 0, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    head = b"".join((
        struct.pack("<ii", 20000630, 2),  # OpenEXR's magic number, and version 2 of the format
        attribute(b"channels", b"chlist", channels),
        attribute(b"compression", b"compression", b"\0"),
        attribute(b"dataWindow", b"box2i", box),
        attribute(b"displayWindow", b"box2i", box),
        attribute(b"lineOrder", b"lineOrder", b"\0"),
        attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1)),
        attribute(b"screenWindowCenter", b"v2f", struct.pack("<ff", 0, 0)),
        attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)), b"\0"))
    # After the header, the file has a table with the offset of each row, then the rows. Each row has its number, its size in bytes (`line`)
    # and its values.
    line = 12 * width
    first = len(head) + 8 * height
    offsets = (first + (8 + line) * np.arange(height)).astype("<u8")
    lines = np.zeros((height, 8 + line), dtype=np.uint8)
    lines[:, :4] = np.arange(height, dtype="<i4").reshape(-1, 1).view(np.uint8)
    lines[:, 4:8] = np.full((height, 1), line, dtype="<i4").view(np.uint8)
    lines[:, 8:] = rows.reshape(height, -1).view(np.uint8)
    return head + offsets.tobytes() + lines.tobytes()


def png(codes):
    """Returns the bytes of a PNG file. `codes`: uint8, (height, width, 3) or (height, width), rows from the top."""
    height, width = codes.shape[:2]
    channels = 1 if codes.ndim == 2 else 3

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    # Each row begins with a byte 0, which says that the row is not filtered.
    lines = np.zeros((height, 1 + width * channels), dtype=np.uint8)
    lines[:, 1:] = codes.reshape(height, -1)
    # 8: bits of a value. 0 or 2: grey or colour. The other zeros: the standard compression and filters, not interlaced.
    head = struct.pack(">IIBBBBB", width, height, 8, 0 if channels == 1 else 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(lines.tobytes(), 3)) + chunk(b"IEND", b"")


def srgb_codes(linear):
    """Converts linear values to 8-bit sRGB."""
    x = np.clip(linear, 0, 1)
    return (255 * np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.power(x, 1 / 2.4) - 0.055) + 0.5).astype(np.uint8)


def linear(srgb):
    """Converts sRGB values in [0, 1] to linear values."""
    return np.where(srgb <= 0.04045, srgb / 12.92, np.power((np.maximum(srgb, 0) + 0.055) / 1.055, 2.4))
