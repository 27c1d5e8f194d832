"""Makes the TDMS files of this folder: python3 make_tdms.py. A writer of its own, by NI's "TDMS File Format Internal Structure"."""

import math
import struct

META, NEW, RAW, INTERLEAVED, BIG, DAQMX = 2, 4, 8, 32, 64, 128
CODES = {1: "b", 2: "h", 3: "i", 4: "q", 5: "B", 6: "H", 7: "I", 8: "Q", 9: "f", 10: "d", 0x21: "?"}
NONE, SAME = "none", "same"


class Time:
    def __init__(self, unix_s, fraction):
        self.s, self.f = unix_s + 2082844800, int(fraction * 2**64)


def value(order, type_, v):
    if type_ == 0x20:
        return text(order, v)
    if type_ == 0x44:
        return struct.pack(order + "qQ", v.s, v.f) if order == ">" else struct.pack("<Qq", v.f, v.s)
    return struct.pack(order + CODES[type_], v)


def text(order, v):
    return struct.pack(order + "I", len(v.encode())) + v.encode()


def segment(objects, raw=b"", flags=META | NEW | RAW, closed=True):
    """objects: (path, index, properties); index: NONE, SAME or (type, count[, bytes]); properties: {name: (type, value)}."""
    order = ">" if flags & BIG else "<"
    meta = b""
    if flags & META:
        meta = struct.pack(order + "I", len(objects))
        for path, index, properties in objects:
            meta += text(order, path)
            if index == NONE:
                meta += b"\xff\xff\xff\xff"
            elif index == SAME:
                meta += struct.pack(order + "I", 0)
            else:
                body = struct.pack(order + "IIQ", index[0], 1, index[1])
                if len(index) > 2:
                    body += struct.pack(order + "Q", index[2])
                meta += struct.pack(order + "I", len(body) + 4) + body
            meta += struct.pack(order + "I", len(properties))
            for name, (type_, v) in properties.items():
                meta += text(order, name) + struct.pack(order + "I", type_) + value(order, type_, v)
    length = len(meta) + len(raw) if closed else 2**64 - 1
    return b"TDSm" + struct.pack("<I", flags) + struct.pack(order + "IQQ", 4713, length, len(meta)) + meta + raw


def numbers(order, type_, values):
    return b"".join(value(order, type_, v) for v in values)


time = [k / 100.0 for k in range(40)]
position = [0.01 * math.sin(7.0 * t) for t in time]  # m
force = [300.0 * x + 0.1 for x in position]  # N
STAMPED = {"wf_increment": (10, 0.01), "wf_start_offset": (10, 0.0), "wf_start_time": (0x44, Time(1769860800, 0.25))}


def unit(u):
    return {"unit_string": (0x20, u)}


# Ten rows, then as before in two chunks of ten, then new lengths in the same list: two chunks of five.
root = ("/", NONE, {"title": (0x20, "a punch")})
group = ("/'run'", NONE, {"number": (3, 7)})
x, f = "/'run'/'position'", "/'run'/'load ''A'''"
contiguous = segment([root, group, (x, (10, 10), unit("m") | STAMPED), (f, (10, 10), unit("N") | STAMPED)],
                     numbers("<", 10, position[0:10]) + numbers("<", 10, force[0:10]))
contiguous += segment([], b"".join(numbers("<", 10, v[a:a + 10]) for a in (10, 20) for v in (position, force)), RAW)
contiguous += segment([(x, (10, 5), {}), (f, (10, 5), {})],
                      b"".join(numbers("<", 10, v[a:a + 5]) for a in (30, 35) for v in (position, force)), META | RAW)
open("punch.tdms", "wb").write(contiguous)

# The same with the other byte order, interleaved, times as moments, forces as floats; in two segments.
t = "/'run'/'at'"
def interleaved(a, b):
    return b"".join(value(">", 0x44, Time(1769860800, time[k])) + value(">", 10, position[k]) + value(">", 9, force[k]) for k in range(a, b))
flags = META | NEW | RAW | INTERLEAVED | BIG
big = segment([(t, (0x44, 25), {}), (x, (10, 25), unit("m")), (f, (9, 25), unit("N"))], interleaved(0, 25), flags)
big += segment([(t, (0x44, 15), {}), (x, (10, 15), {}), (f, (9, 15), {})], interleaved(25, 40), flags)
open("punch-big.tdms", "wb").write(big)

# Raw counts with scales: of the position a linear one behind a polynomial one; texts and a channel of another length beside.
counts = [round((v + 0.02) * 1e6) for v in position]
scales = {"NI_Scaling_Status": (0x20, "unscaled"), "NI_Number_Of_Scales": (7, 2),
          "NI_Scale[0]_Scale_Type": (0x20, "Polynomial"), "NI_Scale[0]_Polynomial_Coefficients_Size": (7, 2),
          "NI_Scale[0]_Polynomial_Coefficients[0]": (10, -0.02), "NI_Scale[0]_Polynomial_Coefficients[1]": (10, 1e-6),
          "NI_Scale[0]_Polynomial_Input_Source": (7, 2**32 - 1), "NI_Scale[1]_Scale_Type": (0x20, "Linear"),
          "NI_Scale[1]_Linear_Slope": (10, 1000.0), "NI_Scale[1]_Linear_Y_Intercept": (10, 5.0),
          "NI_Scale[1]_Linear_Input_Source": (7, 0)}
words = b"".join(struct.pack("<I", 2 * (k + 1)) for k in range(40)) + b"ok" * 40
counted = segment([("/'a'/'way'", (3, 40), unit("mm") | scales), ("/'b'/'F'", (10, 40), unit("N")),
                   ("/'b'/'wide'", (8, 40), {}), ("/'b'/'said'", (0x20, 40, len(words)), {}), ("/'b'/'few'", (2, 3), {})],
                  numbers("<", 3, counts) + numbers("<", 10, force) + numbers("<", 8, [2**60] * 40) + words
                  + numbers("<", 2, [1, 2, 3]))
open("counts.tdms", "wb").write(counted)
