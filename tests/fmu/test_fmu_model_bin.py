"""model.bin missing, cut or altered anywhere: refused with a sentence, never a crash."""

import math
import struct
import zlib

import pytest
from fmu_driver import Fmu

from gearpath.fmu.binary import payload
from gearpath.fmu.variables import variable_table


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
    """Every double NaN in turn, sealed: refused."""
    original, attempt = model_bin
    counts = struct.unpack_from("<12I", original, 72)
    N, groups, _, rows, blocks, loads, outputs = counts[:7]
    doubles = 1 + 2 * N + groups + 2 * rows * N + 2 * blocks + 2 * loads * N + outputs * N
    for i in [*range(2 * N + 5), *range(2 * N + 5, doubles, 53), doubles - 1]:
        for bad in (math.nan, math.inf):
            content = bytearray(original)
            struct.pack_into("<d", content, 120 + 8 * i, bad)
            assert not attempt(sealed(bytes(content)))[0], (i, bad)


def test_model_bin_wrong_indices(model_bin):
    """Every integer of every record replaced by a large one, sealed: refused or harmless, never a crash."""
    original, attempt = model_bin
    counts = struct.unpack_from("<12I", original, 72)
    N, groups, joints, rows, blocks, loads, outputs, variables = counts[:8]
    start = 120 + 8 * (1 + 2 * N + groups + 2 * rows * N + 2 * blocks + 2 * loads * N + outputs * N)
    text = -(-counts[9] // 8) * 8
    integers = [*range(72, 120, 4), *range(start, len(original) - text, 4)]
    assert len(integers) > N + 6 * joints + 4 * outputs + 4 * variables
    padding = 0
    for at in integers:
        for bad in (0xFFFFFFFF, 0x7FFFFFFE, 0x01000000, 8191):
            content = bytearray(original)
            struct.pack_into("<I", content, at, bad)
            alive, _ = attempt(sealed(bytes(content)))
            padding += alive
    assert padding <= 4 * 3  # only the padding of odd-length index sections is not looked at


def test_payload_is_what_the_file_holds(unpacked, network):
    content = (unpacked.folder / "resources" / "model.bin").read_bytes()
    assert content[72:] == payload(network, variable_table(network, 500.0), 500.0)
    assert content[32:72].rstrip(b"\0").decode() == unpacked.description.guid
