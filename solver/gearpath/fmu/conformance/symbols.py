"""Reads the heads of shared libraries: for which machines they are, and which functions they offer.

Nothing is loaded, so that a binary for any platform can be read on any other. ELF: the dynamic symbol table; PE: the
export directory; Mach-O: the external symbols of every machine in a universal file. A library that is none of these,
or is cut short, gives None.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass

_FAT, _FAT_64 = 0xCAFEBABE, 0xCAFEBABF


@dataclass(frozen=True)
class Library:
    """What a shared library says of itself."""

    format: str  # "elf", "pe", "macho"
    machines: frozenset[int]  # numbers of the format
    functions: frozenset[str]


def read_library(data: bytes) -> Library | None:
    """The head of a shared library, or None."""
    try:
        if data[:4] == b"\x7fELF":
            return _elf(data)
        if data[:2] == b"MZ":
            return _pe(data)
        magic = struct.unpack_from(">I", data)[0]
        if magic in (_FAT, _FAT_64):
            return _universal(data, magic == _FAT_64)
        return _macho(data)
    except (struct.error, IndexError, ValueError, UnicodeDecodeError):
        return None


def _text(data: bytes, start: int) -> str:
    return data[start : data.index(b"\0", start)].decode("utf-8")


def _elf(data: bytes) -> Library:
    wide, order = data[4] == 2, "<" if data[5] == 1 else ">"
    machine = struct.unpack_from(order + "H", data, 18)[0]
    head = struct.unpack_from(order + ("Q" if wide else "I"), data, 40 if wide else 32)[0]
    size, count = struct.unpack_from(order + "HH", data, 58 if wide else 46)
    layout = order + ("IIQQQQIIQQ" if wide else "IIIIIIIIII")
    sections = [struct.unpack_from(layout, data, head + k * size) for k in range(count)]
    names = set()
    for section in sections:
        if section[1] != 11:  # SHT_DYNSYM
            continue
        strings = sections[section[6]][4]
        for place in range(section[4], section[4] + section[5], section[9]):
            if wide:
                name, info, _, index = struct.unpack_from(order + "IBBH", data, place)
            else:
                name, _, _, info, _, index = struct.unpack_from(order + "IIIBBH", data, place)
            if index and info >> 4 in (1, 2):  # defined, and global or weak
                names.add(_text(data, strings + name))
    return Library("elf", frozenset({machine}), frozenset(names))


def _pe(data: bytes) -> Library:
    head = struct.unpack_from("<I", data, 0x3C)[0]
    if data[head : head + 4] != b"PE\0\0":
        raise ValueError("no PE header")
    machine, count = struct.unpack_from("<HH", data, head + 4)
    optional = struct.unpack_from("<H", data, head + 20)[0]
    wide = struct.unpack_from("<H", data, head + 24)[0] == 0x20B
    exports = struct.unpack_from("<I", data, head + 24 + (112 if wide else 96))[0]
    table = head + 24 + optional
    sections = [struct.unpack_from("<8xIIII", data, table + 40 * k) for k in range(count)]

    def place(address: int) -> int:
        for size, start, raw, offset in sections:
            if start <= address < start + max(size, raw):
                return int(address - start + offset)
        raise ValueError("address outside all sections")

    names = set()
    if exports:
        directory = place(exports)
        total = struct.unpack_from("<I", data, directory + 24)[0]
        listed = place(struct.unpack_from("<I", data, directory + 32)[0])
        names = {_text(data, place(struct.unpack_from("<I", data, listed + 4 * k)[0])) for k in range(total)}
    return Library("pe", frozenset({machine}), frozenset(names))


def _universal(data: bytes, wide: bool) -> Library:
    count = struct.unpack_from(">I", data, 4)[0]
    layout, size = (">IIQQ", 32) if wide else (">IIII", 20)
    parts = []
    for k in range(count):
        _, _, offset, length = struct.unpack_from(layout, data, 8 + k * size)
        parts.append(_macho(data[offset : offset + length]))
    machines = frozenset(m for part in parts for m in part.machines)
    return Library("macho", machines, frozenset.intersection(*(part.functions for part in parts)))


def _macho(data: bytes) -> Library:
    magic, machine = struct.unpack_from("<II", data)
    wide = magic == 0xFEEDFACF
    if not wide and magic != 0xFEEDFACE:
        raise ValueError("no Mach-O header")
    commands, position = struct.unpack_from("<I", data, 16)[0], 32 if wide else 28
    names = set()
    for _ in range(commands):
        command, size = struct.unpack_from("<II", data, position)
        if command == 2:  # LC_SYMTAB
            first, count, strings, _ = struct.unpack_from("<IIII", data, position + 8)
            for k in range(count):
                name, kind = struct.unpack_from("<IB", data, first + k * (16 if wide else 12))
                if kind & 1 and kind & 0x0E and not kind & 0xE0:  # external, defined, no debugging entry
                    names.add(_text(data, strings + name).removeprefix("_"))
        position += size
    return Library("macho", frozenset({machine}), frozenset(names))
