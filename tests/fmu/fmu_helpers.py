"""Exporting the test network, and what the compiled runtime belongs to."""

import hashlib
import json
from pathlib import Path

import fmpy

from gearpath.fmu import runtime_files
from gearpath.fmu.native import export_native

ROOT = Path(__file__).resolve().parents[2]
MANIFEST = runtime_files.RUNTIME / "manifest.json"
HEADERS = Path(fmpy.__file__).parent / "c-code"


def stale() -> str:
    """Why the compiled runtime does not belong to fmu_src, or nothing."""
    current = {
        p.name: hashlib.sha256(p.read_bytes()).hexdigest()
        for p in (ROOT / "fmu_src").iterdir()
        if p.suffix in (".c", ".h")
    }
    if not MANIFEST.is_file():
        return "the FMU runtime is not compiled: run python hatch_build.py"
    if json.loads(MANIFEST.read_text())["sources"] != current:
        return "the FMU runtime is stale: run python hatch_build.py"
    return ""


def export(network, path, **changes):
    settings = {
        "model_identifier": "gearbox",
        "description": "A test model",
        "frequency": 500.0,
        "stop_time": 0.1,
        "step_size": 1e-5,
        "version": "0.0.test",
    }
    return export_native(network, path, **(settings | changes))
