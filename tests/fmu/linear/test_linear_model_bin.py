"""model.bin of a linear system, altered: refused with a sentence, never a crash.

The layout is written down once more.
"""

import math
import struct
import zlib

import numpy as np
import pytest
from fmu_driver import Fmu
from linear_cases import random_system, unpacked_of

N, M, P = 3, 2, 3
COUNTS, DATA = 72, 136
SIZES = [4, N, N * N, N * M, P * N, P * M, N + M]  # starts, nominals, A, B, C, D, units
STARTS = dict(zip(["starts", "nominal", "A", "B", "C", "D", "unit", "end"], np.cumsum([0, *SIZES]).tolist()))


@pytest.fixture(scope="module")
def system():
    return random_system(N, inputs=M, outputs=P)


@pytest.fixture(scope="module")
def unpacked(system, tmp_path_factory):
    return unpacked_of(system, tmp_path_factory.mktemp("given"))


@pytest.fixture
def attempt(unpacked, tmp_path):
    """Whether an instance comes to be of this content, and what is said."""

    def tried(content):
        (tmp_path / "model.bin").write_bytes(content)
        fmu = Fmu(unpacked, location=tmp_path.as_uri())
        alive = bool(fmu.c.value)
        fmu.free()
        return alive, fmu.messages[-1] if fmu.messages else ""

    return tried


@pytest.fixture(scope="module")
def original(unpacked):
    return (unpacked.folder / "resources" / "model.bin").read_bytes()


def sealed(content):
    return content[:16] + struct.pack("<QI", len(content), zlib.crc32(bytes(content[32:]))) + content[28:]


def altered(content, at, form, value):
    changed = bytearray(content)
    struct.pack_into(form, changed, at, value)
    return sealed(bytes(changed))


def test_the_file_holds_the_matrices(original, system):
    doubles = np.frombuffer(original, "<f8", STARTS["end"], DATA)
    for letter in "ABCD":
        matrix = getattr(system, letter)
        assert doubles[STARTS[letter] :][: matrix.size].tolist() == matrix.ravel().tolist()
    counts = struct.unpack_from("<16I", original, COUNTS)
    assert counts[:9] == (0, 0, 0, 0, 0, M, P, M + P + 2 * N, 0)
    assert counts[10:] == (0, 0x7FFFFFFF, 0, 0, N, 0)


def test_numbers(original, attempt):
    assert attempt(sealed(original))[0]
    for i in range(STARTS["end"]):
        for bad in (math.nan, math.inf):
            alive, message = attempt(altered(original, DATA + 8 * i, "<d", bad))
            assert not alive, i
            assert "model.bin cannot be used" in message
    for part, count in (("nominal", N), ("unit", N + M)):
        for i in range(count):
            for bad in (0.0, -1.0):
                alive, message = attempt(altered(original, DATA + 8 * (STARTS[part] + i), "<d", bad))
                assert not alive
                assert "not positive" in message
    assert not attempt(altered(original, DATA, "<d", 500.0))[0]  # a frequency it has not


def test_counts_and_records(original, attempt):
    """All counts, then kinds, indices and names: what does not fit is refused, whatever it is."""
    for i in range(16):
        for bad in (1, 4, 8191, 0x7FFFFFFE, 0xFFFFFFFF):
            at = COUNTS + 4 * i
            if struct.unpack_from("<I", original, at)[0] != bad:
                assert not attempt(altered(original, at, "<I", bad))[0], (i, bad)
    records = DATA + 8 * STARTS["end"] + 8  # behind the two flags of the inputs
    for i in range(4 * P):
        assert not attempt(altered(original, records + 4 * i, "<I", 77))[0], i
    for quantity in range(5):  # those of a network
        assert not attempt(altered(original, records, "<I", quantity))[0]
    variables = records + 16 * P
    for k in range(M + P + 2 * N):
        for i in (0, 1, 2, 3, 5):
            assert not attempt(altered(original, variables + 24 * k + 4 * i, "<I", 9999))[0], (k, i)
    kinds = [kind for kind in range(64) if attempt(altered(original, variables, "<I", kind))[0]]
    assert kinds == [0, 9, 19, 20, 25]  # input, output, state, derivative, time: nothing that needs a network


def test_a_part_of_a_network_is_refused(original, attempt):
    """A damping ratio, with its count and in its place, before the matrices."""
    place = DATA + 8 * STARTS["A"]
    more = original[:place] + struct.pack("<d", 0.01) + original[place:]
    alive, message = attempt(altered(more, COUNTS + 4, "<I", 1))
    assert not alive
    assert "counts" in message


def test_truncated(original, attempt):
    for size in range(72, len(original), 8):
        assert not attempt(sealed(original[:size]))[0], size
    assert not attempt(sealed(original + bytes(8)))[0]


def test_nothing_at_all_is_refused(original, attempt):
    """No states and no inputs: the counts alone."""
    head = bytearray(original[:DATA])
    for i, value in ((5, 0), (6, 0), (7, 0), (9, 8), (14, 0)):
        struct.pack_into("<I", head, COUNTS + 4 * i, value)
    alive, message = attempt(sealed(bytes(head) + struct.pack("<4d", 0, 0, 1, 0) + bytes(8)))
    assert not alive
    assert "counts" in message
