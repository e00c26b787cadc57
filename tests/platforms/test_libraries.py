"""The libraries in an exported FMU, read as files: what they export and need, and what each system asks of them.

The only test of the macOS libraries, which cannot run here.
"""

import hashlib
import os
import re
import struct
from pathlib import Path

import fmpy
import pytest
from platform_fetch import REQUIRED

try:
    import lief
except ImportError:
    if os.environ.get(REQUIRED):
        raise
    pytest.skip('no lief here: run `python -m pip install -e ".[all,test]"`', allow_module_level=True)

pytestmark = pytest.mark.xdist_group("platforms")
LINUX = {"2.0": ("linux64", "aarch64-linux"), "3.0": ("x86_64-linux", "aarch64-linux")}
WINDOWS = {"2.0": ("win64",), "3.0": ("x86_64-windows",)}
MAC = {"2.0": ("darwin64", "aarch64-darwin"), "3.0": ("x86_64-darwin", "aarch64-darwin")}
NEWEST_GLIBC = (2, 17)
OLDEST_MAC = {"X86_64": [10, 13, 0], "ARM64": [11, 0, 0]}
LINKER = {"__mh_dylib_header", "___dso_handle"}  # marks that zig's linker adds; harmless
# memory, strings and files only: numbers that come from a system's mathematics library differ between systems
ALLOWED = {
    *("malloc", "calloc", "realloc", "free", "memcpy", "memmove", "memset", "memcmp", "bcmp", "bzero"),
    *("strlen", "strcmp", "strcat", "strcpy", "fopen", "_wfopen", "fread", "fclose", "fseek", "ftell"),
}


def functions() -> set[str]:
    """All functions that the headers of FMI 2 and FMI 3 declare for export."""
    found: set[str] = set()
    for version in "23":
        header = (Path(fmpy.__file__).parent / "c-code" / f"fmi{version}Functions.h").read_text()
        found.update(re.findall(rf"^\s*FMI{version}_Export\s+fmi{version}\w+TYPE\s+(fmi{version}\w+);", header, re.M))
    return found


def test_the_headers_were_read():
    """None is overlooked: as many as the standards have."""
    versions = [sum(name.startswith(f"fmi{v}") for name in functions()) for v in "23"]
    assert versions == [44, 75]


def file(fmus, fmi, folder):
    (path,) = (fmus[fmi].folder / "binaries" / folder).iterdir()
    return path


@pytest.fixture(params=[(fmi, folder) for fmi in LINUX for folder in LINUX[fmi]], ids="-".join)
def linux_library(fmus, request):
    return lief.ELF.parse(str(file(fmus, *request.param)))


@pytest.fixture(params=[(fmi, folder) for fmi in WINDOWS for folder in WINDOWS[fmi]], ids="-".join)
def windows_library(fmus, request):
    return lief.PE.parse(str(file(fmus, *request.param)))


@pytest.fixture(params=[(fmi, folder) for fmi in MAC for folder in MAC[fmi]], ids="-".join)
def mac_file(fmus, request):
    return file(fmus, *request.param)


def test_every_platform_is_there(fmus):
    for fmi, fmu in fmus.items():
        folders = {path.name for path in (fmu.folder / "binaries").iterdir()}
        assert folders == {*LINUX[fmi], *WINDOWS[fmi], *MAC[fmi]}


def test_linux(linux_library):
    library = linux_library
    assert {symbol.name for symbol in library.exported_symbols} == functions()
    assert {symbol.name for symbol in library.imported_symbols} <= ALLOWED
    tag = lief.ELF.DynamicEntry.TAG
    assert [entry.name for entry in library.dynamic_entries if entry.tag == tag.NEEDED] == ["libc.so.6"]
    assert not {entry.tag for entry in library.dynamic_entries} & {tag.RPATH, tag.RUNPATH, tag.TEXTREL}
    needed = [name.name for version in library.symbols_version_requirement for name in version.get_auxiliary_symbols()]
    assert needed
    for name in needed:
        numbers = tuple(int(number) for number in re.fullmatch(r"GLIBC_([\d.]+)", name)[1].split("."))
        assert numbers <= NEWEST_GLIBC, name
    may = lief.ELF.Segment.FLAGS
    assert any(segment.type == lief.ELF.Segment.TYPE.GNU_STACK for segment in library.segments)
    assert not any(segment.has(may.W) and segment.has(may.X) for segment in library.segments)  # stack and data
    assert not [section.name for section in library.sections if section.name.startswith(".debug")]


def test_the_processors_of_linux(fmus):
    for fmi in LINUX:
        found = [lief.ELF.parse(str(file(fmus, fmi, folder))).header.machine_type for folder in LINUX[fmi]]
        assert found == [lief.ELF.ARCH.X86_64, lief.ELF.ARCH.AARCH64]


def test_windows(windows_library):
    library = windows_library
    assert library.header.machine == lief.PE.Header.MACHINE_TYPES.AMD64
    assert {entry.name for entry in library.get_export().entries} == functions()
    imports = {module.name.lower(): {entry.name for entry in module.entries} for module in library.imports}
    assert set(imports) <= {"ucrtbase.dll", "kernel32.dll"}
    assert set.union(*imports.values()) <= ALLOWED
    assert library.header.time_date_stamps == 0
    assert library.get_export().timestamp == 0
    assert not [entry for entry in library.debug if entry.timestamp]
    wanted = lief.PE.OptionalHeader.DLL_CHARACTERISTICS
    assert {wanted.DYNAMIC_BASE, wanted.NX_COMPAT} <= set(library.optional_header.dll_characteristics_lists)
    assert library.has_relocations  # else it could not be loaded beside another library at its address
    assert library.optional_header.major_subsystem_version <= 6  # Windows Vista and later


def test_mac(mac_file):
    names = {f"_{name}" for name in functions()}
    parts = lief.MachO.parse(str(mac_file))  # which must outlive the libraries that it gives
    for library in parts:
        processor = library.header.cpu_type.name
        assert {export.symbol.name for export in library.dyld_info.exports} - LINKER == names
        imports = {binding.symbol.name.lstrip("_") for binding in library.dyld_info.bindings}
        assert imports - {"dyld_stub_binder"} <= ALLOWED
        dylibs = [
            command.name
            for command in library.commands
            if command.command in (lief.MachO.LoadCommand.TYPE.LOAD_DYLIB, lief.MachO.LoadCommand.TYPE.LOAD_WEAK_DYLIB)
        ]
        assert dylibs == ["/usr/lib/libSystem.B.dylib"]
        (identity,) = [c for c in library.commands if c.command == lief.MachO.LoadCommand.TYPE.ID_DYLIB]
        assert identity.name == "@rpath/gearpath.dylib"
        oldest = library.build_version.minos if library.has_build_version else library.version_min.version
        assert list(oldest) == OLDEST_MAC[processor]
        assert not library.has_rpath
        assert library.has_uuid
        assert library.header.file_type == lief.MachO.Header.FILE_TYPE.DYLIB
        assert library.has_code_signature or processor != "ARM64"


def test_the_processors_of_mac(fmus):
    """FMI 2's darwin64 is universal, the others hold one processor; the parts are the same libraries everywhere."""
    parts = {(fmi, folder): slices(file(fmus, fmi, folder).read_bytes()) for fmi in MAC for folder in MAC[fmi]}
    x86, arm = parts["3.0", "x86_64-darwin"], parts["3.0", "aarch64-darwin"]
    assert [list(x86), list(arm)] == [[0x01000007], [0x0100000C]]
    assert parts["2.0", "aarch64-darwin"] == arm
    assert parts["2.0", "darwin64"] == {**x86, **arm}


def slices(content: bytes) -> dict[int, bytes]:
    """The parts of a Mach-O file by processor; a universal one has a big-endian table in front."""
    if content[:4] != b"\xca\xfe\xba\xbe":
        return {struct.unpack_from("<I", content, 4)[0]: content}
    found = {}
    for k in range(struct.unpack_from(">I", content, 4)[0]):
        processor, _, start, size, align = struct.unpack_from(">IIIII", content, 8 + 20 * k)
        assert start % (1 << align) == 0
        assert align >= 14  # pages of 16 kB on Arm
        found[processor] = content[start : start + size]
    return found


def test_the_signature_for_arm_is_right(mac_file):
    """macOS on Arm ends a program that loads a page whose hash is not the one in the signature."""
    signed = [part for processor, part in slices(mac_file.read_bytes()).items() if processor == 0x0100000C]
    for part in signed:
        parts = lief.MachO.parse(list(part))
        library = parts.at(0)
        start = library.code_signature.data_offset
        assert start + library.code_signature.data_size == len(part)
        directory = _code_directory(part[start:])
        _, _, version, _, hashes, _, _, pages, limit = struct.unpack_from(">9I", directory)
        size, kind, _, page_bits = struct.unpack_from(">4B", directory, 36)
        assert version >= 0x20100
        assert (size, kind, limit) == (32, 2, start)  # SHA-256 of everything in front of the signature
        page = 1 << page_bits
        assert pages == -(-limit // page)
        for k in range(pages):
            digest = hashlib.sha256(part[k * page : min((k + 1) * page, limit)]).digest()
            assert digest == directory[hashes + k * size : hashes + (k + 1) * size], f"page {k}"


def _code_directory(signature: bytes) -> bytes:
    magic, _, count = struct.unpack_from(">3I", signature)
    assert magic == 0xFADE0CC0
    for k in range(count):
        kind, offset = struct.unpack_from(">2I", signature, 12 + 8 * k)
        if kind == 0:
            assert signature[offset : offset + 4] == b"\xfa\xde\x0c\x02"
            return signature[offset:]
    raise AssertionError("no code directory in the signature")
