"""model.bin missing, cut or altered anywhere: refused with a sentence, never a crash.

The layout is written down once more here, from the format as fmu_src/gp_model.c describes it.
"""

import math
import struct
import zlib

import pytest
from fmu_driver import Fmu

from gearpath.fmu.binary import payload
from gearpath.fmu.native_table import native_table

HEADER, COUNTS = 72, 16
DATA = HEADER + 4 * COUNTS  # where the doubles begin
UNSIGNED_KINDS, RECORDS = ("pairs", "is_error", "rotation"), {"joint": 6, "output": 4, "variable": 6}


def layout(content: bytes):
    """The number of doubles, the (start, integers) of each index section, and the start of the text."""
    names = ["N", "groups", "joints", "rows", "blocks", "loads", "outputs", "variables", "excitation"]
    names += ["text", "tones", "source", "pairs", "points"]
    n = dict(zip(names, struct.unpack_from("<14I", content, HEADER)))
    N = n["N"]
    doubles = 4 + (3 + n["groups"]) * N + n["groups"] + 2 * n["blocks"]
    doubles += (2 * n["rows"] + 2 * n["loads"] + n["outputs"]) * N
    doubles += 4 * n["pairs"] + 2 * n["pairs"] * N + 4 * n["tones"]
    doubles += n["points"] * (1 + 2 * n["blocks"])
    at, sections = DATA + 8 * doubles, {}
    lengths = [n["pairs"], n["loads"], n["rows"], 6 * n["joints"], 4 * n["outputs"], 6 * n["variables"]]
    for name, length in zip((*UNSIGNED_KINDS, *RECORDS), lengths):
        sections[name] = (at, length)
        at += (4 * length + 7) // 8 * 8
    assert at + (n["text"] + 7) // 8 * 8 == len(content)
    return n, doubles, sections, at


@pytest.fixture
def model_bin(unpacked, tmp_path):
    """model.bin as bytes, and a way to instantiate an altered one."""
    original = (unpacked.folder / "resources" / "model.bin").read_bytes()

    def attempt(content):
        (tmp_path / "model.bin").write_bytes(content)
        fmu = Fmu(unpacked, location=tmp_path.as_uri())
        alive = bool(fmu.c.value)
        fmu.free()
        return alive, fmu.messages[-1] if fmu.messages else ""

    return original, attempt


def sealed(content: bytes) -> bytes:
    """With the size and checksum of the altered content, so that the checks behind them are reached."""
    head = struct.pack("<Q", len(content)) + struct.pack("<I", zlib.crc32(content[32:]))
    return content[:16] + head + content[28:]


def test_model_bin_unaltered(model_bin):
    original, attempt = model_bin
    assert attempt(original) == (True, "")
    assert attempt(sealed(original)) == (True, "")


def test_model_bin_truncated(model_bin):
    original, attempt = model_bin
    cuts = {*range(0, 160, 7), *range(160, len(original), 997), len(original) - 1}
    for size in cuts:
        alive, message = attempt(original[:size])
        assert not alive, size
        assert "model.bin cannot be used" in message
    assert not attempt(original + b"\0")[0]


def test_model_bin_truncated_and_sealed(model_bin):
    """The size and the checksum fit, the counts do not."""
    original, attempt = model_bin
    for size in [*range(72, 160, 8), *range(160, len(original), 997), len(original) - 8]:
        alive, message = attempt(sealed(original[:size]))
        assert not alive, size
        assert "model.bin cannot be used" in message
    assert not attempt(sealed(original + bytes(8)))[0]


def test_model_bin_bit_flips(model_bin):
    original, attempt = model_bin
    for at in {*range(120), *range(120, len(original), 1009), len(original) - 1}:
        flipped = bytearray(original)
        flipped[at] ^= 1 << (at % 8)
        alive, message = attempt(bytes(flipped))
        assert not alive, at
        assert message.startswith("fmi2Instantiate: ")


def test_model_bin_wrong_numbers(model_bin):
    """Doubles NaN or infinite in turn, sealed: refused; all of the first, and of each section some."""
    original, attempt = model_bin
    n, doubles, _, _ = layout(original)
    first = 4 + 3 * n["N"] + n["groups"] * (1 + n["N"])
    for i in [*range(4 + 3 * n["N"] + n["groups"] + 2), *range(first, doubles, 53), doubles - 1]:
        for bad in (math.nan, math.inf):
            content = bytearray(original)
            struct.pack_into("<d", content, DATA + 8 * i, bad)
            alive, message = attempt(sealed(bytes(content)))
            assert not alive, (i, bad)
            assert "out of range" in message


def test_model_bin_wrong_indices(model_bin):
    """Every integer of every record replaced by a large one, sealed: refused, never a crash.

    Nothing but padding is not looked at, and a name may begin anywhere in the text.
    """
    original, attempt = model_bin
    n, _, sections, text = layout(original)
    padding, names = set(), set()
    for name, (at, length) in sections.items():
        if length % 2:
            padding.add(at + 4 * length)
        if name in RECORDS and name != "output":
            names |= {at + 4 * k for k in range(4, length, RECORDS[name])}
    start, variables = sections["pairs"][0], sections["variable"][0]
    assert padding  # the case is not trivial
    # 13 and 6 have no common divisor: every field of a variable, over many variables
    for at in [*range(HEADER, DATA, 4), *range(start, variables, 4), *range(variables, text, 4 * 13)]:
        for bad in (0xFFFFFFFF, 0x7FFFFFFE, 0x01000000, 8191):
            content = bytearray(original)
            struct.pack_into("<I", content, at, bad)
            alive, message = attempt(sealed(bytes(content)))
            harmless = at in padding or (at in names and bad < n["text"])
            assert alive == harmless, (at, bad, message)


def test_model_bin_of_another_version_says_what_to_do(model_bin):
    original, attempt = model_bin
    for version in (0, 1, 2, 3, 5):
        content = bytearray(original)
        struct.pack_into("<I", content, 8, version)
        alive, message = attempt(sealed(bytes(content)))
        assert not alive
        assert "another version; export the FMU again" in message


def test_payload_is_what_the_file_holds(unpacked, network):
    content = (unpacked.folder / "resources" / "model.bin").read_bytes()
    assert content[72:] == payload(network, native_table(network, 500.0), 500.0)
    assert content[32:72].rstrip(b"\0").decode() == unpacked.description.guid
