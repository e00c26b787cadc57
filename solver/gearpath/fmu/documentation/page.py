"""The page itself: one HTML file without script, style file or anything from outside, on light and dark screens."""

from collections.abc import Mapping, Sequence
from html import escape

import numpy as np

from ...network.modal import ModalNetwork
from ...numerics.arrays import Real
from ..description import Experiment
from ..variables import Variable
from . import guide, tables
from .modes import modal_data
from .plots import BAND, figures
from .svg import COLOURS

_ON_DARK = ("#5ab4f0", "#ff9d4d", "#35cba0", "#e0a0bd", "#d8bd4f", "#9fd3f5", "#b8bec5", "#c99ae6")
_STYLE = """:root { color-scheme: light dark; --ink: #1f2933; --paper: #ffffff; --rule: #cbd2d9; --soft: #f3f5f7; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e4e7eb; --paper: #14181d; --rule: #3e4c59; --soft: #1f262e; }
DARK
}
body { color: var(--ink); background: var(--paper); font: 16px/1.55 system-ui, sans-serif; margin: 0 auto;
  max-width: 50rem; padding: 1.5rem; }
h1, h2, h3 { line-height: 1.25; margin: 2rem 0 0.5rem; }
h1 { margin-top: 0; }
h2 { border-bottom: 1px solid var(--rule); padding-bottom: 0.2rem; }
a { color: inherit; }
nav ul { columns: 2; padding-left: 1.2rem; }
code { font: 0.88em ui-monospace, monospace; }
.eq { background: var(--soft); padding: 0.6rem 1rem; line-height: 1.9; overflow-x: auto; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: 0.88rem; }
th, td { border-bottom: 1px solid var(--rule); padding: 0.25rem 0.7rem 0.25rem 0; text-align: left;
  vertical-align: top; }
.n { text-align: right; font-variant-numeric: tabular-nums; }
sup, sub { line-height: 0; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 0.2rem 1rem; }
dd { margin: 0; }
figure { margin: 1.2rem 0; }
figcaption { font-weight: 600; }
figure svg { max-width: 100%; height: auto; }
.legend { list-style: none; display: flex; flex-wrap: wrap; gap: 0.1rem 1.2rem; padding: 0; margin: 0.2rem 0;
  font-size: 0.88rem; }
summary { font-weight: 600; cursor: pointer; margin: 1rem 0; }"""
_PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{name}</title>
<style>
{style}
</style>
</head>
<body>
<h1>{name}</h1>
<p>{description}</p>
{facts}
<nav aria-label="Contents">
<ul>
{contents}
</ul>
</nav>
{sections}
<footer>
<p>Written by Gearpath {version}, under the <a href="licenses/license.txt">MIT licence</a>.</p>
</footer>
</body>
</html>
"""
_SECTION = '<section id="{}">\n<h2>{}</h2>\n{}\n</section>'
_POWER_TEXT = """<p>Dotted: power that returns to the source; bold: the sum. Ticks at the foot: undamped natural
frequencies of the assembly. Single parts may exceed 0 dB where others return power; the whole ratio cannot.</p>
"""


def documentation(
    network: ModalNetwork,
    variables: Sequence[Variable],
    *,
    fmi: str,
    description: str,
    version: str,
    experiment: Experiment,
    plots: bool = True,
    reference: bool = True,
    band: tuple[float, float] = BAND,
    frequencies: Real | None = None,
) -> bytes:
    """documentation/index.html of a native FMU; without `plots` there are no figures and no modes of the assembly.

    `band` (Hz) is where the plots begin and end, `frequencies` (Hz, ascending) their very lines; `reference` says
    whether the FMU has reference files.
    """
    drawn = figures(network, band, frequencies) if plots else {}
    high = min(band[1], network.band) if frequencies is None else float(np.max(frequencies))
    sections = {
        "power": ("Power flow", drawn.get("power", "") and drawn["power"] + _POWER_TEXT),
        "transfers": ("Transfers from the excitation", drawn.get("transfers", "")),
        "joints": ("Joints", tables.joints(network)),
        "components": ("Components", tables.components(network)),
        "modes": ("Modes of the assembly", tables.modes(network, modal_data(network), high) if plots else ""),
        "equations": ("Equations, signs and units", guide.equations(network)),
        "inputs": ("Inputs between communication points", guide.inputs(fmi, _highest(network))),
        "use": ("Use", guide.behaviour(network, fmi)),
        "files": ("Terminals and reference results", guide.files(reference)),
        "variables": ("Variables", tables.variables(variables)),
    }
    return page(network.name, description, _facts(network, variables, fmi, experiment), sections, version)


def page(
    name: str, description: str, facts: Mapping[str, str], sections: Mapping[str, tuple[str, str]], version: str
) -> bytes:
    """The HTML file of facts (text) and sections (key -> heading and HTML); a section without content is left out."""
    shown = {key: section for key, section in sections.items() if section[1]}
    listed = "\n".join(f"<dt>{key}</dt><dd>{escape(text)}</dd>" for key, text in facts.items())
    return _PAGE.format(
        name=escape(name),
        description=escape(description),
        style=_style(),
        facts=f"<dl>\n{listed}\n</dl>",
        contents="\n".join(f'<li><a href="#{key}">{heading}</a></li>' for key, (heading, _) in shown.items()),
        sections="\n".join(_SECTION.format(key, *section) for key, section in shown.items()),
        version=escape(version),
    ).encode()


def _style() -> str:
    dark = "\n".join(f"  .c{k} {{ stroke: {colour}; }}" for k, colour in enumerate(_ON_DARK[: len(COLOURS)]))
    return _STYLE.replace("DARK", dark)


def _highest(network: ModalNetwork) -> float:
    return float(np.sqrt(network.eigenvalues.max(initial=0.0)) / (2.0 * np.pi))


def _facts(network: ModalNetwork, variables: Sequence[Variable], fmi: str, experiment: Experiment) -> dict[str, str]:
    kinds: dict[str, int] = {}
    for joint in network.joints:
        kinds[joint.kind] = kinds.get(joint.kind, 0) + 1
    counts = ", ".join(f"{count} {kind}{'s' if count > 1 else ''}" for kind, count in kinds.items())
    start, stop, step = experiment.start_time, experiment.stop_time, experiment.step_size
    facts = {
        "Interface": f"FMI {fmi}, model exchange and co-simulation",
        "Components": ", ".join(network.components),
        "Joints": f"{len(network.joints)}: {counts}",
        "Excitation": network.excitation,
        "Modal coordinates": f"{len(network.eigenvalues)}",
        "Variables": f"{len(variables)}",
        "Default experiment": f"{start:g} s to {stop:g} s in steps of {step:g} s",
    }
    if np.isfinite(network.band):
        facts["Exact up to"] = f"{network.band:g} Hz (components reduced to their band)"
    return facts
