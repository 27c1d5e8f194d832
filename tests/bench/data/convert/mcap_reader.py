"""Reads MCAP, version 0, as its specification says, and asserts all that the file says of itself: order, lengths, checksums,
indexes, statistics. Knows nothing of who wrote it."""

import ctypes
import struct
import zlib

MAGIC = b"\x89MCAP0\r\n"


def unpacked(data: bytes, compression: str, size: int) -> bytes:
    if compression == "":
        return data
    assert compression == "zstd", compression
    library = ctypes.CDLL("libzstd.so.1")
    library.ZSTD_decompress.restype = ctypes.c_size_t
    library.ZSTD_decompress.argtypes = [ctypes.c_char_p, ctypes.c_size_t, ctypes.c_char_p, ctypes.c_size_t]
    buffer = ctypes.create_string_buffer(max(size, 1))
    assert library.ZSTD_decompress(buffer, size, data, len(data)) == size
    return buffer.raw[:size]


class Fields:
    def __init__(self, data: bytes):
        self.data, self.at = data, 0

    def number(self, form: str) -> int:
        (value,) = struct.unpack_from("<" + form, self.data, self.at)
        self.at += struct.calcsize("<" + form)
        return value

    def bytes(self, size: int) -> bytes:
        assert self.at + size <= len(self.data)
        self.at += size
        return self.data[self.at - size : self.at]

    def text(self) -> str:
        return self.bytes(self.number("I")).decode("utf-8")

    def pairs(self, first, second) -> list:
        end = self.number("I") + self.at
        found = []
        while self.at < end:
            found.append((first(self), second(self)))
        assert self.at == end
        return found

    def rest(self) -> bytes:
        return self.bytes(len(self.data) - self.at)


def u16(fields):
    return fields.number("H")


def u64(fields):
    return fields.number("Q")


def records(data: bytes, at: int, end: int):
    """Opcode, content, offset, and offset of the end of each."""
    while at < end:
        opcode, length = struct.unpack_from("<BQ", data, at)
        assert at + 9 + length <= end
        yield opcode, data[at + 9 : at + 9 + length], at, at + 9 + length
        at += 9 + length


class Mcap:
    def __init__(self, path: str):
        self.data = open(path, "rb").read()
        data = self.data
        assert data.startswith(MAGIC) and data.endswith(MAGIC)
        self.schemas, self.channels, self.messages = {}, {}, []
        self.metadata, self.attachments = {}, {}
        self.chunks, self.offsets = {}, {2: {}, 7: {}, 9: {}, 12: {}}
        footer_at = len(data) - 8 - 29
        opcode, length = struct.unpack_from("<BQ", data, footer_at)
        assert (opcode, length) == (2, 20)
        self.summary, self.summary_offsets, crc = struct.unpack_from("<QQI", data, footer_at + 9)
        assert crc == zlib.crc32(data[self.summary : footer_at + 25])
        self.read_data()
        self.read_summary(footer_at)

    def read_data(self):
        chunk = None
        for opcode, content, at, end in records(self.data, 8, self.summary):
            fields = Fields(content)
            assert (opcode == 1) == (at == 8)
            if opcode == 1:
                self.profile, self.library = fields.text(), fields.text()
            elif opcode == 6:
                chunk = self.read_chunk(fields, at, end)
                self.chunks[at] = chunk
            elif opcode == 7:
                channel, entries = u16(fields), fields.pairs(u64, u64)
                assert entries == chunk["by_channel"].pop(channel)
                chunk["index_offsets"].append((channel, at))
                chunk["index_end"] = end
            elif opcode == 9:
                log, create, name, media = u64(fields), u64(fields), fields.text(), fields.text()
                body = fields.bytes(u64(fields))
                assert fields.number("I") == zlib.crc32(content[:-4])
                self.attachments[name] = body
                self.offsets[9][at] = (end - at, log, create, len(body), name, media)
            elif opcode == 12:
                name = fields.text()
                self.metadata[name] = dict(fields.pairs(Fields.text, Fields.text))
                self.offsets[12][at] = (end - at, name)
            else:
                assert opcode == 15, opcode
                assert end == self.summary
                assert fields.number("I") == zlib.crc32(self.data[:at])
        for chunk in self.chunks.values():
            assert not chunk["by_channel"]

    def read_chunk(self, fields, at, end):
        begin_time, end_time, size, crc = u64(fields), u64(fields), u64(fields), fields.number("I")
        compression = fields.text()
        packed = fields.bytes(u64(fields))
        body = unpacked(packed, compression, size)
        assert crc == zlib.crc32(body)
        by_channel, times = {}, []
        for opcode, content, offset, _ in records(body, 0, len(body)):
            inner = Fields(content)
            if opcode == 3:
                self.add(self.schemas, u16(inner), (inner.text(), inner.text(), inner.bytes(inner.number("I"))))
            elif opcode == 4:
                self.add(self.channels, *self.channel(inner))
            else:
                assert opcode == 5, opcode
                channel, sequence, log, publish = u16(inner), inner.number("I"), u64(inner), u64(inner)
                assert channel in self.channels
                by_channel.setdefault(channel, []).append((log, offset))
                times.append(log)
                self.messages.append((channel, sequence, log, publish, inner.rest()))
        assert (begin_time, end_time) == ((min(times), max(times)) if times else (0, 0))
        return {"times": (begin_time, end_time), "end": end, "by_channel": by_channel, "index_offsets": [], "index_end": end,
                "compression": compression, "packed": len(packed), "size": size}

    def channel(self, fields):
        number, schema = u16(fields), u16(fields)
        assert schema == 0 or schema in self.schemas
        return number, (schema, fields.text(), fields.text(), tuple(fields.pairs(Fields.text, Fields.text)))

    @staticmethod
    def add(known, number, value):
        assert known.setdefault(number, value) == value

    def read_summary(self, footer_at):
        seen, groups, order = {}, {}, []
        for opcode, content, at, end in records(self.data, self.summary, footer_at):
            fields = Fields(content)
            if opcode == 14:
                assert at >= self.summary_offsets
                group = fields.number("B")
                assert (u64(fields), u64(fields)) == groups.pop(group)
                continue
            assert at < self.summary_offsets
            if not order or order[-1] != opcode:
                assert opcode not in order, "one group an opcode"
                order.append(opcode)
                groups[opcode] = (at, 0)
            groups[opcode] = (groups[opcode][0], end - groups[opcode][0])
            seen[opcode] = seen.get(opcode, 0) + 1
            if opcode == 3:
                assert self.schemas[u16(fields)] == (fields.text(), fields.text(), fields.bytes(fields.number("I")))
            elif opcode == 4:
                number, channel = self.channel(fields)
                assert self.channels[number] == channel
            elif opcode == 8:
                self.check_chunk_index(fields)
            elif opcode == 10:
                assert self.offsets[9][u64(fields)] == (u64(fields), u64(fields), u64(fields), u64(fields), fields.text(), fields.text())
            elif opcode == 13:
                assert self.offsets[12][u64(fields)] == (u64(fields), fields.text())
            else:
                assert opcode == 11, opcode
                self.check_statistics(fields)
        assert not groups
        for opcode, count in ((3, self.schemas), (4, self.channels), (8, self.chunks), (10, self.offsets[9]), (13, self.offsets[12])):
            assert seen.get(opcode, 0) == len(count), opcode
        assert seen[11] == 1

    def check_chunk_index(self, fields):
        times, at, length = (u64(fields), u64(fields)), u64(fields), u64(fields)
        chunk = self.chunks[at]
        assert times == chunk["times"] and at + length == chunk["end"]
        assert fields.pairs(u16, u64) == chunk["index_offsets"]
        assert u64(fields) == chunk["index_end"] - chunk["end"]
        assert (fields.text(), u64(fields), u64(fields)) == (chunk["compression"], chunk["packed"], chunk["size"])

    def check_statistics(self, fields):
        times = [message[2] for message in self.messages] or [0]
        counts = {}
        for message in self.messages:
            counts[message[0]] = counts.get(message[0], 0) + 1
        assert u64(fields) == len(self.messages)
        assert u16(fields) == len(self.schemas)
        for what in (self.channels, self.attachments, self.metadata, self.chunks):
            assert fields.number("I") == len(what)
        assert (u64(fields), u64(fields)) == (min(times), max(times))
        assert dict(fields.pairs(u16, u64)) == counts
