"""The XML files of an FMU: well-formed, in UTF-8, without entities, and valid by the schemas of the standard."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

from ...errors import MissingExtraError
from .archive import Archive
from .finding import Finding, error, warning

MISSING = error("description-missing", "modelDescription.xml is at the top of the archive.", "2.3", "2.5.1")
BROKEN = error("xml-broken", "Every XML file is well-formed.", "2.2", "2.4")
ENCODING = error("xml-encoding", "The first line of an XML file states the encoding UTF-8.", "2.2", "2.4")
ENTITIES = error("xml-entities", "An XML file has no document type, and so no entities.")
SCHEMA = error("xml-schema", "Every XML file is valid by its schema.", "2.2", "2.4")
MANIFEST = warning("manifest", "The manifest of a layered standard names it as its folder does.", "2.3.1", "2.6")

DESCRIPTION = "modelDescription.xml"
BUILD = "sources/buildDescription.xml"
TERMINALS = "terminalsAndIcons/terminalsAndIcons.xml"
_LAYERED = "{http://fmi-standard.org/fmi-ls-manifest}"
_SCHEMA = {
    (DESCRIPTION, 2): "fmi2/fmi2ModelDescription.xsd",
    (DESCRIPTION, 3): "fmi3/fmi3ModelDescription.xsd",
    (BUILD, 2): "fmi3/fmi3BuildDescription.xsd",
    (BUILD, 3): "fmi3/fmi3BuildDescription.xsd",
    (TERMINALS, 2): "fmi3/fmi3TerminalsAndIcons.xsd",
    (TERMINALS, 3): "fmi3/fmi3TerminalsAndIcons.xsd",
}


def parse(archive: Archive, name: str, version: int | None = None) -> tuple[Any, list[Finding]]:
    """Root element (None where there is none) and what is wrong with the text."""
    content = archive.read(name)
    if content is None:
        return None, []
    etree, found = _etree(), []
    declared = re.match(rb"<\?xml[^>]*encoding\s*=\s*[\"']([^\"']*)", content.removeprefix(b"\xef\xbb\xbf"))
    if not declared or declared[1].upper() != b"UTF-8":
        stated = declared[1].decode("ascii", "replace") if declared else "none"
        found.append(ENCODING.found(version, f'{name} states the encoding {stated}; begin it with encoding="UTF-8"'))
    if b"<!DOCTYPE" in content or b"<!ENTITY" in content:
        return None, [*found, ENTITIES.found(version, f"{name} has a document type declaration; leave it out")]
    reader = etree.XMLParser(resolve_entities=False, load_dtd=False, no_network=True, huge_tree=False)
    try:
        root = etree.fromstring(content, reader)
    except (etree.XMLSyntaxError, ValueError) as problem:
        return None, [*found, BROKEN.found(version, f"{name} is not well-formed ({problem}); write it again")]
    if root.getroottree().docinfo.doctype:
        return None, [*found, ENTITIES.found(version, f"{name} has a document type declaration; leave it out")]
    return root, found


def others(archive: Archive, version: int) -> Iterator[tuple[str, Any, list[Finding]]]:
    """All XML files but the model description and those in resources/: name, root or None, what is wrong."""
    for name in sorted(archive.names):
        if name.lower().endswith(".xml") and name != DESCRIPTION and not name.startswith("resources/"):
            yield (name, *parse(archive, name, version))


def schema_findings(name: str, root: Any, version: int) -> Iterator[Finding]:
    """Where a document breaks its schema."""
    file = _SCHEMA.get((name, version))
    if file is None:
        yield from _manifest(name, root, version)
        return
    schema = _schema(file)
    if not schema.validate(root):
        for entry in schema.error_log:
            text = re.sub(r"\{[^}]*\}", "", entry.message).rstrip(". ")
            yield SCHEMA.found(version, f"{name}, line {entry.line}: {text}; correct it")


def schema_attributes(file: str, type_name: str) -> frozenset[str]:
    """Names of all attributes that are declared in a complex type of a schema, extensions included."""
    tree = _etree().parse(str(_folder() / file))
    spaces = {"xs": "http://www.w3.org/2001/XMLSchema"}
    return frozenset(tree.xpath(f"//xs:complexType[@name='{type_name}']//xs:attribute/@name", namespaces=spaces))


def _manifest(name: str, root: Any, version: int) -> Iterator[Finding]:
    """The manifest of a layered standard says which one it is, whatever its root element is called."""
    folder = re.fullmatch(r"extra/([^/]+)/fmi-ls-manifest\.xml", name)
    if folder is None:
        return
    missing = [key for key in ("name", "version", "description") if not root.get(f"{_LAYERED}fmi-ls-{key}")]
    if missing:
        message = f"{name}: has no fmi-ls-{missing[0]}; give name, version and description of the layered standard"
        yield MANIFEST.found(version, message)
    elif root.get(f"{_LAYERED}fmi-ls-name") != folder[1]:
        yield MANIFEST.found(version, f"{name}: its fmi-ls-name is not the name of its folder; give both one name")


@cache
def _schema(file: str) -> Any:
    etree = _etree()
    return etree.XMLSchema(etree.parse(str(_folder() / file)))


@cache
def _folder() -> Path:
    try:
        import fmpy
    except ImportError as problem:
        raise MissingExtraError("fmpy", "fmu") from problem
    return Path(fmpy.__file__).parent / "schema"


def _etree() -> Any:
    try:
        from lxml import etree
    except ImportError as problem:
        raise MissingExtraError("lxml", "fmu") from problem
    return etree
