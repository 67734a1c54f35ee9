"""Files for tests of the command line, made and read by hand: expectations that owe nothing to the program's own libraries."""

import gzip
import struct
import zlib


def nrrd(sizes="8 8 8", data=None, kind="uint8", encoding="raw", spacings="1 1 1", dimension=None):
    """A NRRD file's bytes. Header fields are text, so that they may say anything."""
    dimension = len(sizes.split()) if dimension is None else dimension
    header = f"NRRD0004\ntype: {kind}\ndimension: {dimension}\nsizes: {sizes}\nencoding: {encoding}\nendian: little\n"
    if spacings:
        header += f"spacings: {spacings}\n"
    return header.encode() + b"\n" + (ramp() if data is None else data)


def nifti(dims=(8, 8, 8), kind=2, bits=8, spacings=(1.0, 1.0, 1.0), data=None):
    """An uncompressed NIfTI-1 file's bytes; kind 2 is uint8. Offsets are those of nifti1.h."""
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, len(dims), *(list(dims) + [1] * (7 - len(dims))))
    struct.pack_into("<hh", header, 70, kind, bits)
    struct.pack_into("<8f", header, 76, 1.0, *(list(spacings) + [1.0] * (7 - len(spacings))))
    struct.pack_into("<f", header, 108, 352.0)
    header[344:348] = b"n+1\0"
    return bytes(header) + (ramp() if data is None else data)


def ramp(edge=8):
    """Cubic 8-bit voxels, brighter along x."""
    return bytes(range(0, 32 * edge, 32)) * edge * edge


def packed(data):
    return gzip.compress(data, mtime=0)


def dicom(series, z, edge=8):
    """One CT slice in explicit little endian (PS3.5, section 7.1.2), with what a volume needs and no more."""
    def element(group, number, kind, value):
        value = value.encode() if isinstance(value, str) else value
        value += (b"\0" if kind in ("UI", "OW") else b" ") * (len(value) % 2)
        length = struct.pack("<HI", 0, len(value)) if kind == "OW" else struct.pack("<H", len(value))
        return struct.pack("<HH2s", group, number, kind.encode()) + length + value

    def short(number, value):
        return element(0x0028, number, "US", struct.pack("<H", value))

    ct, instance = "1.2.840.10008.5.1.4.1.1.2", f"{series}.{z + 1}"
    meta = (element(2, 2, "UI", ct) + element(2, 3, "UI", instance) + element(2, 0x10, "UI", "1.2.840.10008.1.2.1"))
    body = b"".join((
        element(0x0008, 0x0016, "UI", ct), element(0x0008, 0x0018, "UI", instance),
        element(0x0008, 0x0060, "CS", "CT"),
        element(0x0020, 0x000D, "UI", "1.2.3"), element(0x0020, 0x000E, "UI", series),
        element(0x0020, 0x0013, "IS", str(z + 1)),
        element(0x0020, 0x0032, "DS", f"0\\0\\{z}"), element(0x0020, 0x0037, "DS", "1\\0\\0\\0\\1\\0"),
        short(0x0002, 1), element(0x0028, 0x0004, "CS", "MONOCHROME2"), short(0x0010, edge), short(0x0011, edge),
        element(0x0028, 0x0030, "DS", "1\\1"), short(0x0100, 16), short(0x0101, 16), short(0x0102, 15),
        short(0x0103, 1),
        element(0x7FE0, 0x0010, "OW", struct.pack(f"<{edge * edge}h", *range(edge * edge)))))
    return b"\0" * 128 + b"DICM" + element(2, 0, "UL", struct.pack("<I", len(meta))) + meta + body


class Png:
    """An 8-bit RGB or RGBA picture, decoded as the PNG specification says, checksums and end included."""

    def __init__(self, data):
        assert data[:8] == b"\x89PNG\r\n\x1a\n", "no PNG signature"
        chunks, at = [], 8
        while at < len(data):
            length, kind = struct.unpack_from(">I4s", data, at)
            body = data[at + 8:at + 8 + length]
            assert struct.unpack_from(">I", data, at + 8 + length)[0] == zlib.crc32(kind + body), kind
            chunks.append((kind, body))
            at += length + 12
        assert chunks[0][0] == b"IHDR" and chunks[-1][0] == b"IEND"
        self.width, self.height, bits, colour, _, _, interlaced = struct.unpack(">IIBBBBB", chunks[0][1])
        assert bits == 8 and not interlaced
        self.channels = {2: 3, 6: 4}[colour]
        self.rows = self._unfiltered(zlib.decompress(b"".join(body for kind, body in chunks if kind == b"IDAT")))

    def _unfiltered(self, data):
        stride, step = self.width * self.channels, self.channels
        assert len(data) == self.height * (stride + 1)
        rows, above = [], bytearray(stride)
        for y in range(self.height):
            start = y * (stride + 1)
            kind, row = data[start], bytearray(data[start + 1:start + 1 + stride])
            for i in range(stride):
                left = row[i - step] if i >= step else 0
                corner = above[i - step] if i >= step else 0
                guess = (0, left, above[i], (left + above[i]) // 2, _paeth(left, above[i], corner))[kind]
                row[i] = (row[i] + guess) & 255
            rows.append(bytes(row))
            above = row
        return rows

    def pixel(self, x, y):
        return tuple(self.rows[y][x * self.channels:(x + 1) * self.channels])


def _paeth(left, above, corner):
    estimate = left + above - corner
    return min((left, above, corner), key=lambda value: abs(estimate - value))


def exr_header(data):
    """The attributes of an OpenEXR file, by name, as bytes."""
    assert struct.unpack_from("<I", data)[0] == 20000630, "no OpenEXR signature"
    attributes, at = {}, 8
    while data[at]:
        name, kind_and_rest = data[at:].split(b"\0", 2)[:2]
        at += len(name) + len(kind_and_rest) + 2
        size = struct.unpack_from("<I", data, at)[0]
        attributes[name.decode()] = data[at + 4:at + 4 + size]
        at += 4 + size
    return attributes
