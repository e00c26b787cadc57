"""The compiled runtime: not stale, the hook rebuilds what changed, and other compilers agree with it."""

import hashlib
import importlib.util
import json
import shutil

import pytest
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
