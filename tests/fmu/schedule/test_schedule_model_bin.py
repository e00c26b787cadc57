"""model.bin with a schedule that export cannot write: refused with a sentence under the right checksum."""

import struct
import zlib

import numpy as np
from fmu_driver import Fmu
from schedule_machine import START, TORQUES

from gearpath.fmu.binary import payload, scheduled_torques
from gearpath.fmu.native_table import native_table


def attempt(unpacked, content, folder):
    """Instantiates with this model.bin under the right size and checksum."""
    head = struct.pack("<QI", len(content), zlib.crc32(content[32:]))
    folder.mkdir(exist_ok=True)
    (folder / "model.bin").write_bytes(content[:16] + head + content[28:])
    fmu = Fmu(unpacked, location=folder.as_uri())
    alive, message = bool(fmu.c.value), fmu.messages[-1] if fmu.messages else ""
    fmu.free()
    return alive, message


def test_altered_tables(fmus, scheduled, tmp_path):
    """What export cannot write is refused at instantiation, under the right checksum."""
    content = (fmus[2].folder / "resources" / "model.bin").read_bytes()
    assert scheduled_torques(content).tolist() == TORQUES.tolist()
    assert content[72:] == payload(scheduled.at_torque(START), native_table(scheduled, 500.0), 500.0)
    blocks = sum(len(joint.dofs) ** 2 for joint in scheduled.joints)
    torques = content.index(TORQUES.astype("<f8").tobytes())
    table, start = torques + 8 * len(TORQUES), 136 + 24
    assert struct.unpack_from("<d", content, start) == (START,)

    def double(at, value):
        changed = bytearray(content)
        struct.pack_into("<d", changed, at, value)
        return attempt(fmus[2], bytes(changed), tmp_path / "it")

    assert double(torques, 10.0) == (True, "")
    bad = [(torques, v) for v in (25.0, 26.0, np.nan, -np.inf)]
    bad += [(start, v) for v in (9.0, 101.0, 33.0, np.nan)]
    bad += [(table + 8, 1.0), (table, -1.0), (table + 8 * 4 * 2, 1.0), (table, np.inf)]  # symmetry, sign, bearing 3
    bad += [(table + 8 * len(TORQUES) * blocks, 1.0)]  # damping of bearing 1, which does not follow
    for at, value in bad:
        alive, message = double(at, value)
        assert not alive, (at, value)
        assert "model.bin cannot be used" in message
    joints = content.index(struct.pack("<4I", 0, 2, 0, 1))
    for value in (0, 2, 3, 4, 0x7FFFFFFF):  # bearing 1 follows in another way than the table says
        changed = bytearray(content)
        struct.pack_into("<I", changed, joints + 20, value)
        alive, message = attempt(fmus[2], bytes(changed), tmp_path / "it")
        assert not alive, value
        assert "schedule over the torque is wrong" in message
