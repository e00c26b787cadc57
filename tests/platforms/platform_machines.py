"""The machines that a library of an FMU runs on here: this one, Windows under Wine, Arm under QEMU."""

import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from urllib.parse import quote

import fmpy
import pytest
from platform_fetch import ARM, OLD, QEMU, REQUIRED, SYSROOT, WINE, Tool, advice

HOST = Path(__file__).parent / "host"
FMI_HEADERS = Path(fmpy.__file__).parent / "c-code"
# -ffp-contract=off: the host's integrator, too, gives the same doubles everywhere
FLAGS = ("-std=c99", "-O2", "-g0", "-ffp-contract=off", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror")
# the C runtime's own printf and start-up code would have to be compiled first, which takes minutes
BARE_WINDOWS = ("-D__USE_MINGW_ANSI_STDIO=0", "-DGP_BARE_WINDOWS")
WINDOWS_LINK = ("-nostdlib", "-lkernel32", "-lucrtbase")
WINDOWS_PROGRAM = ("-Wl,--subsystem,console", "-Wl,--entry=mainCRTStartup")


def need(*tools: Tool) -> None:
    """Skip where a program is missing, and fail where it is required."""
    problem = advice(tools)
    if problem:
        (pytest.fail if os.environ.get(REQUIRED) else pytest.skip)(problem)


@dataclass(frozen=True)
class Machine:
    """How to compile for a platform and to run its programs: the folders of its library in an FMU by FMI version."""

    name: str
    target: str
    folders: dict[str, str]
    extension: str
    tools: tuple[Tool, ...] = ()
    prefix: tuple[str, ...] = ()  # of the command line
    drive: str = ""  # before an absolute path
    environment: dict[str, str] = field(default_factory=dict)

    @property
    def windows(self) -> bool:
        return self.extension == ".dll"

    def path(self, path: Path) -> str:
        """`path` as the machine's programs name it."""
        return self.drive + path.as_posix()

    def location(self, resources: Path, fmi: str) -> str:
        """Where an importer says that the resources are: a URI in FMI 2, a path with its separator in FMI 3."""
        if fmi == "3.0":
            return self.path(resources) + "/"
        return "file:///" + self.drive + ("/" if self.drive else "") + quote(resources.as_posix().lstrip("/"))

    def compile_host(self, folder: Path) -> Path:
        """The host program for this machine, in `folder`."""
        sources = sorted(HOST.glob("*.c"))
        return self.compile(sources, folder / f"host-{self.name}", [*FLAGS, "-isystem", str(FMI_HEADERS)])

    def compile(self, sources: Sequence[Path], output: Path, flags: Sequence[str], shared: bool = False) -> Path:
        """A program or a shared library of C sources, compiled with zig."""
        output.parent.mkdir(parents=True, exist_ok=True)
        if not self.windows:
            kind = ["-shared", "-fPIC"] if shared else []
            zig(["-target", self.target, *flags, *kind, *map(str, sources), "-o", str(output), "-ldl"], output.parent)
            return output
        output = output.with_suffix(".dll" if shared else ".exe")
        with tempfile.TemporaryDirectory(dir=output.parent) as scratch:
            objects = [f"{source.stem}.obj" for source in sources]
            for source, result in zip(sources, objects, strict=True):
                zig(["-target", self.target, *flags, *BARE_WINDOWS, "-c", str(source), "-o", result], Path(scratch))
            kind = ["-shared"] if shared else WINDOWS_PROGRAM
            zig(["-target", self.target, *kind, *objects, "-o", str(output), *WINDOWS_LINK], Path(scratch))
        return output

    def run(self, program: Path, script: str) -> str:
        """What the host prints; raises RuntimeError with its message where it does not come to the end."""
        # files, not pipes: Wine's own services inherit those and would keep them open
        with tempfile.TemporaryFile() as lines, tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as errors:
            lines.write(script.encode())
            lines.seek(0)
            environment = {**os.environ, **self.environment}
            command = [*self.prefix, str(program)]
            done = subprocess.run(
                command, stdin=lines, stdout=out, stderr=errors, env=environment, timeout=120, check=False
            )
            out.seek(0)
            errors.seek(0)
            output, message = out.read().decode().replace("\r\n", "\n"), errors.read().decode(errors="replace")
        if done.returncode:
            raise RuntimeError(
                f"the host on {self.name} ended with code {done.returncode} after {len(output.splitlines())} calls: "
                f"{message[-500:]}\n{output[-500:]}"
            )
        return output


def zig(arguments: Sequence[str], folder: Path) -> None:
    """Run zig's C compiler in `folder`, with the cache of C libraries that the build hook uses."""
    caches = {
        "ZIG_GLOBAL_CACHE_DIR": str(Path(tempfile.gettempdir()) / f"gearpath-zig-{os.getuid()}"),
        "ZIG_LOCAL_CACHE_DIR": str(folder / "cache"),
    }
    command = [sys.executable, "-m", "ziglang", "cc", *arguments]
    environment = {**caches, **os.environ}
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{' '.join(command)}\n{done.stdout}{done.stderr}"


def gcc(sources: Sequence[Path] | None, output: Path, flags: Sequence[str]) -> Path:
    """A shared library of an FMU's sources for this machine, or the host where there are none, compiled with GCC."""
    files = sorted(HOST.glob("*.c")) if sources is None else sources
    kind = [] if sources is None else ["-shared", "-fPIC"]
    command = ["gcc", "-isystem", str(FMI_HEADERS), *flags, *kind, *map(str, files), "-o", str(output), "-ldl"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return output


def native() -> Machine:
    """This machine, x86-64 Linux."""
    return Machine("linux", "x86_64-linux-gnu.2.17", {"2.0": "linux64", "3.0": "x86_64-linux"}, ".so")


def old() -> Machine:
    """An x86-64 processor of 2008, without AVX, by QEMU: the library then takes its plain loops."""
    folders = native().folders
    return Machine("old", native().target, folders, ".so", (OLD,), (str(OLD.find()), "-cpu", "Nehalem"))


def arm() -> Machine:
    """64-bit Arm Linux: QEMU's emulation of the processor, and Debian's C library."""
    qemu = str(QEMU.find())
    folders = {"2.0": "aarch64-linux", "3.0": "aarch64-linux"}
    return Machine("arm", "aarch64-linux-gnu.2.17", folders, ".so", (QEMU, ARM), (qemu, "-L", str(SYSROOT)))


def windows(prefix: Path) -> Machine:
    """64-bit Windows: Wine, with `prefix` as its system folder and this machine's files as drive Z."""
    environment = {
        "WINEPREFIX": str(prefix),
        "WINEARCH": "win64",
        "WINEDEBUG": "-all",
        "WINEDLLOVERRIDES": "mscoree,mshtml=",  # no questions about .NET and a browser
        "DISPLAY": "",
        "LC_ALL": "C.UTF-8",  # file names here are UTF-8
    }
    folders = {"2.0": "win64", "3.0": "x86_64-windows"}
    return Machine("windows", "x86_64-windows-gnu", folders, ".dll", (WINE,), (str(WINE.find()),), "Z:", environment)


def start_wine(machine: Machine) -> None:
    """Make the system folder and start its server to stay: a program starts in 0.1 s then, and in 3 s otherwise."""
    server = _wine_server(machine)
    _quietly([server, "-p"], machine)
    _quietly([*machine.prefix, "wineboot", "--init"], machine)


def end_wine(machine: Machine) -> None:
    """Stop the server of this system folder and of no other, so that the folder can be removed."""
    _quietly([_wine_server(machine), "-k", "-w"], machine)


def _wine_server(machine: Machine) -> str:
    return str(PurePosixPath(machine.prefix[0]).with_name("wineserver"))


def _quietly(command: Sequence[str], machine: Machine) -> None:
    environment, nowhere = {**os.environ, **machine.environment}, subprocess.DEVNULL
    subprocess.run(command, env=environment, stdin=nowhere, stdout=nowhere, stderr=nowhere, timeout=120, check=False)
