"""An FMU's sources/, compiled by whoever unpacks it, give the same numbers as the libraries that it brings."""

import shutil
from xml.etree import ElementTree

import pytest
from platform_fetch import BUILDERS, COMPILER, HEADERS
from platform_machines import FMI_HEADERS, gcc, need
from platform_scenarios import every_scenario
from platform_script import Script

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("platform_sources")]
SCENARIOS = {name: every_scenario()[name] for name in ("held inputs", "interpolated inputs", "model exchange")}


def listed(fmu) -> list:
    """The files that the FMU itself tells importers to compile."""
    folder = fmu.folder / "sources"
    if fmu.fmi == "3.0":
        root = ElementTree.parse(folder / "buildDescription.xml").getroot()
        configuration = root.find("BuildConfiguration")
        assert configuration.get("modelIdentifier") == "gearbox"
        files = configuration.findall("SourceFileSet/SourceFile")
    else:
        root = ElementTree.parse(fmu.folder / "modelDescription.xml").getroot()
        files = root.findall("CoSimulation/SourceFiles/File")
        assert [f.attrib for f in files] == [f.attrib for f in root.findall("ModelExchange/SourceFiles/File")]
    return [folder / file.get("name") for file in files]


@pytest.fixture(scope="module")
def printed(run):
    """What the host prints with the FMU's own library and with another, over the scenarios."""

    def outputs(fmu, machine, library=None):
        scripts = []
        for scenario in SCENARIOS.values():
            script = Script(fmu, machine, library)
            scenario(script)
            scripts.append(run(script))
        return scripts

    return outputs


def test_all_sources_are_listed(fmu):
    assert sorted(path.name for path in listed(fmu)) == sorted(p.name for p in (fmu.folder / "sources").glob("*.c"))


def test_clang(fmus, machine, printed, tmp_path):
    """For every platform, optimised, and without a word about floating point: clang fuses products and sums on Arm."""
    fmu = fmus["3.0"]
    flags = ["-O3", "-isystem", str(FMI_HEADERS)]  # the headers come from who compiles, not with the sources
    library = machine.compile(listed(fmu), tmp_path / "gearbox.so", flags, shared=True)
    assert printed(fmu, machine, library) == printed(fmu, machine)


# -mfma: a processor with fused products and sums. Those of complex numbers GCC 12 vectorises even if told not to.
@pytest.mark.parametrize(
    "flags", [["-std=c99", "-O0"], ["-O3"], ["-O3", "-mfma", "-fno-tree-slp-vectorize"]], ids=" ".join
)
def test_gcc(fmus, linux, printed, tmp_path, flags):
    """GCC as an importer may call it, which fuses products and sums unless it is told not to."""
    need(COMPILER, HEADERS)
    fmu = fmus["2.0"]
    library = gcc(listed(fmu), tmp_path / "gearbox.so", flags)
    assert printed(fmu, linux, library) == printed(fmu, linux)


def test_fmpy(fmu, linux, printed, tmp_path):
    """As `fmpy compile` does it: with CMake, whatever C compiler that finds, and its release flags."""
    from fmpy.build import build_platform_binary

    need(*BUILDERS)
    folder = tmp_path / "fmu"
    shutil.copytree(fmu.folder, folder, ignore=shutil.ignore_patterns("binaries"))
    (tmp_path / "build").mkdir()
    build_platform_binary(folder, tmp_path / "build")
    (built,) = (folder / "binaries").rglob("gearbox.so")
    assert printed(fmu, linux, built) == printed(fmu, linux)
