"""Files beside the model description: documentation, licence, icons, sources, extra."""

from __future__ import annotations

import re
from collections.abc import Iterator

from .contents import Fmu
from .finding import Finding, error, warning

LAYOUT = warning("layout", "Everything lies in a folder of the standard.", "2.3", "2.5.1")
DOCUMENTATION = warning("documentation-missing", "documentation/index.html is there.", "2.3", "2.5.1.1")
LICENCE = warning("licence-missing", "documentation/licenses/ has license.txt or license.html.", "2.3", "2.5.1.1")
LICENCE_ENTRY = error("licence-entry", "If it is there, documentation/licenses/ has license.txt.", None, "2.5.1.1")
ICON = error("icon-png", "An icon or diagram as SVG is there as PNG too.", "2.3", "2.4.9")
EXTRA = warning("extra-name", "Folders of extra/ have names such as org.example.", "2.3.1", "2.5.1.6")
HEADERS = warning("sources-headers", "sources/ leaves the headers of the standard to the importer.", "2.3", "2.5.1.3")
IMPLEMENTATION = error("implementation-missing", "There is a binary or source code.", "2.3", "2.5")

_FOLDERS = {"documentation", "sources", "binaries", "resources", "extra", "terminalsAndIcons"}
_FILES = {2: {"modelDescription.xml", "model.png"}, 3: {"modelDescription.xml"}}
_STANDARD_HEADER = re.compile(r"fmi[23](TypesPlatform|PlatformTypes|FunctionTypes|Functions)\.h")


def check(fmu: Fmu) -> Iterator[Finding]:
    """Which files there are; their content is the matter of other checks."""
    archive, version = fmu.archive, fmu.version
    for top in sorted({name.split("/")[0] for name in archive.names}):
        inside = any(name.startswith(top + "/") for name in archive.names)
        if (inside and top not in _FOLDERS) or (not inside and top not in _FILES[version]):
            yield LAYOUT.found(version, f'"{top}" is at no place of the standard; move it to extra/ or resources/')
    if "documentation/index.html" not in archive.names:
        yield DOCUMENTATION.found(version, "documentation/index.html is missing; describe the model there")
    licences = archive.under("documentation/licenses")
    entries = [f"documentation/licenses/license.{end}" for end in ("txt", "html", "spdx")]
    if not licences:
        yield LICENCE.found(version, "documentation/licenses/ is missing; add license.txt there")
    elif not archive.names.intersection(entries):
        rule = LICENCE if version == 2 else LICENCE_ENTRY
        yield rule.found(version, "documentation/licenses/ has neither license.txt nor license.html; add one")
    for picture in ("terminalsAndIcons/icon", "documentation/diagram"):
        if f"{picture}.svg" in archive.names and f"{picture}.png" not in archive.names:
            yield ICON.found(version, f"{picture}.svg is there without {picture}.png; add that")
    for name in sorted({n.split("/")[1] for n in archive.under("extra")}):
        if not re.fullmatch(r"[A-Za-z0-9_-]+(\.[A-Za-z0-9_-]+)+", name):
            yield EXTRA.found(version, f'"extra/{name}" is no reverse domain name; name it such as extra/org.example')
    for name in archive.under("sources"):
        if _STANDARD_HEADER.fullmatch(name.rpartition("/")[2]):
            yield HEADERS.found(version, f"{name} is a header of the standard; leave it to the importer")
    if not archive.under("sources") and not archive.under("binaries"):
        yield IMPLEMENTATION.found(version, "neither binaries/ nor sources/ is there; add one, or no tool can run it")
