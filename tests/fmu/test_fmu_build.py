"""The compiled runtime: not stale, the hook rebuilds what changed, and other compilers agree with it."""

import hashlib
import importlib.util
import json
import shutil
import zipfile

import numpy as np
import pytest
from fmu_driver import Fmu
from fmu_helpers import MANIFEST, ROOT, stale


@pytest.fixture
def build_hook():
    pytest.importorskip("hatchling")
    pytest.importorskip("ziglang")
    spec = importlib.util.spec_from_file_location("hatch_build", ROOT / "hatch_build.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_manifest_matches_the_sources():
    """Fails when the runtime is stale: run python hatch_build.py."""
    assert stale() == ""
    manifest = json.loads(MANIFEST.read_text())
    for name, digest in manifest["binaries"].items():
        assert hashlib.sha256((MANIFEST.parent / "binaries" / name).read_bytes()).hexdigest() == digest


def test_a_changed_source_is_compiled_again(build_hook, tmp_path, monkeypatch):
    hook = build_hook
    copy = tmp_path / "runtime"
    shutil.copytree(MANIFEST.parent, copy)
    assert hook._is_current(copy, hook._manifest(hook._header_folder()))
    (copy / "binaries" / "linux64" / "gearpath.so").write_bytes(b"")
    assert not hook._is_current(copy, hook._manifest(hook._header_folder()))
    monkeypatch.setattr(hook, "COMMON", (*hook.COMMON, "-DX"))
    assert not hook._is_current(MANIFEST.parent, hook._manifest(hook._header_folder()))


@pytest.mark.slow
def test_a_compiler_error_is_shown(build_hook, tmp_path, monkeypatch):
    hook = build_hook
    (tmp_path / "src").mkdir()
    (tmp_path / "src" / "broken.c").write_text("int f(void) { return nonsense; }\n")
    monkeypatch.setattr(hook, "SOURCES", tmp_path / "src")
    monkeypatch.setattr(hook, "TARGETS", {"linux64/gearpath.so": hook.TARGETS["linux64/gearpath.so"]})
    with pytest.raises(RuntimeError, match="nonsense"):
        hook.build(tmp_path / "runtime")
    assert not (tmp_path / "runtime" / "manifest.json").exists()


@pytest.mark.slow
@pytest.mark.skipif(not (shutil.which("cmake") and shutil.which("cc")), reason="needs cmake and a C compiler")
def test_sources_compile_to_the_same_numbers(network, fmu_path, unpacked, tmp_path):
    """`fmpy compile`: the host's compiler makes a binary from sources/ that gives the same doubles."""
    from fmpy.build import build_platform_binary

    with zipfile.ZipFile(fmu_path) as archive:
        archive.extractall(tmp_path / "fmu")
    shutil.rmtree(tmp_path / "fmu" / "binaries")
    (tmp_path / "build").mkdir()
    build_platform_binary(tmp_path / "fmu", tmp_path / "build")
    built = next((tmp_path / "fmu" / "binaries").rglob("gearbox.*"))
    other = Fmu.unpack(fmu_path, tmp_path / "second", library=built)
    names = [o.name for o in network.outputs] + ["alpha", "frf.bearing_2.force_rx.im"]
    results = []
    for library in (unpacked, other):
        fmu = Fmu(library)
        fmu.start()
        U = np.random.default_rng(5).normal(size=(100, 3)) * [1e-6, 10, 10]
        results.append(fmu.run([load.name for load in network.loads], U, 1e-5, names))
        fmu.free()
    scale = np.abs(results[0]).max(axis=0)
    assert (np.abs(results[0] - results[1]).max(axis=0) <= 1e-12 * scale).all()
