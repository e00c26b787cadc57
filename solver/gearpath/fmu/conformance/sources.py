"""Source code: the files that are to be compiled, and the build description of FMI 3."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any

from .contents import FILE, Fmu, true
from .documents import BUILD
from .finding import Finding, error, warning

MISSING = error("source-missing", "Every source file that is named is in sources/.", "2.3", "2.4.10")
DUPLICATE = error("source-duplicate", "No source file is named twice for one build.", "2.3", "2.4.10")
UNLISTED = warning("source-unlisted", "The model description of FMI 2 names the source files.", "2.3", None)
DESCRIPTION = error("build-missing", "Source code comes with sources/buildDescription.xml.", None, "2.5.1.3")
IDENTIFIER = error("build-identifier", "A build configuration is for a modelIdentifier of the FMU.", None, "2.4.10")
UNBUILT = error("build-interface", "Every modelIdentifier has a build configuration.", None, "2.4.10")
PLATFORM = error("build-platform", "No two build configurations are for one platform.", None, "2.4.10")
VERSION = error("build-version", "fmiVersion of the build description is that of the FMU.", None, "2.4.10")
INCLUDE = error("build-include", "Every include directory is in sources/.", None, "2.4.10")
LIBRARY = error("build-library", "Every internal library is in binaries/.", None, "2.4.10")
OPTION = error("build-option", "The value of a definition is one of its options.", None, "2.4.10")

_CODE = (".c", ".cc", ".cpp", ".cxx")


def check(fmu: Fmu) -> Iterator[Finding]:
    """Lists of files by edition."""
    code = [name for name in fmu.archive.under("sources") if name.lower().endswith(_CODE)]
    if fmu.version == 2:
        lists = [e for e in (i.find("SourceFiles") for i in fmu.interfaces.values()) if e is not None]
        for listed in lists:
            yield from _named(fmu, FILE, [e.get("name", "") for e in listed.iterchildren("File")])
        if code and not lists and BUILD not in fmu.archive.names:
            yield UNLISTED.found(2, f"{FILE}: sources/ has code but no SourceFiles name it; list the files")
    elif code and BUILD not in fmu.archive.names:
        yield DESCRIPTION.found(3, f"{BUILD} is missing; without it nobody can compile sources/")
    root = fmu.documents.get(BUILD)
    if root is not None:
        yield from _build(fmu, root)


def _named(fmu: Fmu, place: str, names: Sequence[str]) -> Iterator[Finding]:
    for name, count in Counter(names).items():
        if f"sources/{name}" not in fmu.archive.names:
            yield MISSING.found(fmu.version, f'{place}: names "{name}", which is not in sources/; add the file')
        if count > 1:
            yield DUPLICATE.found(fmu.version, f'{place}: names "{name}" {count} times; keep one')


def _build(fmu: Fmu, root: Any) -> Iterator[Finding]:
    stated = root.get("fmiVersion", "")
    if fmu.version == 3 and stated != fmu.root.get("fmiVersion"):
        yield VERSION.found(3, f'{BUILD}: fmiVersion is "{stated}"; write that of {FILE}')
    configurations = list(root.iterchildren("BuildConfiguration"))
    targets = Counter((c.get("modelIdentifier"), c.get("platform")) for c in configurations)
    for (_, platform), count in targets.items():
        if count > 1:
            message = f"{BUILD}: {count} configurations are for platform {platform or 'any'}; keep one"
            yield PLATFORM.found(3, message)
    built = {c.get("modelIdentifier") for c in configurations}
    for identifier in fmu.identifiers:
        if identifier not in built:
            yield UNBUILT.found(3, f'{BUILD}: has no configuration for modelIdentifier "{identifier}"; add one')
    for number, configuration in enumerate(configurations, 1):
        yield from _configuration(fmu, f"{BUILD}, configuration {number}", configuration)


def _configuration(fmu: Fmu, place: str, configuration: Any) -> Iterator[Finding]:
    identifier = configuration.get("modelIdentifier")
    if identifier not in fmu.identifiers:
        message = f'{place}: is for modelIdentifier "{identifier}", which {FILE} does not have; correct it'
        yield IDENTIFIER.found(3, message)
    yield from _named(fmu, place, [e.get("name", "") for e in configuration.iterfind("SourceFileSet/SourceFile")])
    for element in configuration.iterfind("SourceFileSet/IncludeDirectory"):
        folder = element.get("name", "").strip("/")
        if folder not in (".", "") and not fmu.archive.under(f"sources/{folder}"):
            yield INCLUDE.found(3, f'{place}: include directory "{folder}" is not in sources/; add or remove it')
    for element in configuration.iterfind("SourceFileSet/PreprocessorDefinition"):
        options = [e.get("value") for e in element.iterchildren("Option")]
        if options and element.get("value") not in options:
            message = f'{place}: "{element.get("name")}" is "{element.get("value")}", which is no option of it; use one'
            yield OPTION.found(3, message)
    for element in configuration.iterfind("Library"):
        name = element.get("name", "")
        held = any(n.split("/")[-1].startswith((name, f"lib{name}")) for n in fmu.archive.under("binaries"))
        if not true(element.get("external")) and not held:
            yield LIBRARY.found(3, f'{place}: library "{name}" is not in binaries/; add it or set external')
