"""Reads a report as a browser would, as far as the tests need it: text, tables, attributes, figures; and its models."""

import json
import re
from html.parser import HTMLParser
from pathlib import Path

import gearpath as gp

VOID = {"meta", "br", "img", "link", "hr", "input", "col"}
MODEL = Path(__file__).resolve().parents[2] / "models" / "gearbox.toml"
BEARINGS = [f"bearing_{k}" for k in (1, 2, 3, 4)]


class Reader(HTMLParser):
    """Raises AssertionError where an end tag does not fit the open element."""

    def __init__(self, html):
        super().__init__(convert_charrefs=True)
        self.stack, self.tags, self.texts = [], [], []  # texts: (ids of the open elements, names of them, text)
        self.feed(html)
        self.close()
        assert self.stack == []

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        self.tags.append((tag, attrs))
        if tag not in VOID:
            self.stack.append((tag, attrs))

    def handle_endtag(self, tag):
        assert self.stack, f"</{tag}> closes nothing"
        assert self.stack[-1][0] == tag, f"</{tag}> closes <{self.stack[-1][0]}>"
        self.stack.pop()

    def handle_data(self, data):
        self.texts.append(([a.get("id") for _, a in self.stack], [t for t, _ in self.stack], data))

    def of(self, element):
        """The text within the element of an id, blanks as one, signs as in ASCII."""
        return plain(" ".join(text for ids, _, text in self.texts if element in ids))

    def within(self, tag):
        """All texts within elements of a name."""
        return [text for _, names, text in self.texts if tag in names]

    @property
    def figures(self):
        """Figure id -> traces, with their abscissae."""
        (text,) = [t for ids, _, t in self.texts if "figure-data" in ids]
        book = json.loads(text)
        return {
            key: [{**trace, "x": book["grids"][trace["x"]]} for trace in figure["data"]]
            for key, figure in book["figures"].items()
        }


def plain(text):
    """Without typography."""
    text = text.replace("\u2060", "").replace("−", "-").replace("\u202f", " ")
    return re.sub(r"\s+", " ", text).strip()


def gearbox(points=120, **changes):
    return gp.load(MODEL).replace({"frequency.points": points, **changes})


def mirrored():
    """Couplings of opposite sign at the two ends of a shaft: the symmetric machine does not tilt its casing."""
    return gearbox(**{f"joints.bearing_{k}.stiffness": [[1.2e8, -1.8e6], [-1.8e6, 6.0e4]] for k in (2, 4)})


def translating():
    return gearbox(dofs=["uy"], **{f"joints.{name}.stiffness": 1.2e8 for name in BEARINGS})


def mounts_only():
    return gearbox(**{f"joints.{name}.kind": "mount" for name in BEARINGS})


def single():
    return gearbox(**{f"joints.{name}.kind": "mount" for name in BEARINGS[1:]})
