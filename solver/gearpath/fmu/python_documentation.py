"""The page inside a python FMU that says what it is and what it needs."""

from collections.abc import Sequence
from html import escape

from .variables import Variable

_PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>{name}</title>
</head>
<body>
<h1>{name}</h1>
<p>{description}</p>
<h2>What it needs</h2>
<p>This FMU is a Python program. It does not bring Python along; it runs in the Python of the host
process.</p>
<ul>
<li>Platform: {platforms}.</li>
<li>Python 3.11 or later in the host process, with <code>numpy</code> (1.26 or later) and
<code>scipy</code> (1.11 or later): <code>python -m pip install numpy scipy</code>. Any such Python will
do; it need not be the one that wrote the FMU, nor have Gearpath or pythonfmu installed.</li>
<li>A host that is no Python itself must load Python's library before the FMU with all its symbols
visible: on Linux start it with <code>LD_PRELOAD</code> set to <code>libpython3.x.so</code>, on Windows
put the folder of <code>python3.dll</code> on <code>PATH</code>. Such a process may abort when it ends,
after the results are there.</li>
<li>A path to the unpacked FMU without characters that a URI encodes, the space excepted: pythonfmu
crashes on others, such as &eacute;, <code>+</code>, <code>#</code> or <code>%</code>, if the host encodes
them.</li>
</ul>
<h2>How it behaves</h2>
<ul>
<li>Time steps are exact for inputs that are held over a step, at any step size. Input derivatives are not
supported by pythonfmu; choose the step by how well held inputs follow the signal.</li>
<li>There is no gear mesh source in it, and no model exchange: the native kind of FMU has both. The transmission
error is an input.</li>
<li>Outputs always belong to the present inputs and parameters, also when an input was set without a
step.</li>
<li>Joint parameters and modal damping are tunable at any time. Design parameters are fixed: set them
before the initialisation ends; the components are then solved again.</li>
<li>Bearings given by their geometry have the stiffness, and the damping that follows it, of their operating point:
geometry, preload, load and torque are design parameters, the matrices calculated from them can be read only.</li>
<li>A value that cannot be used is refused with a sentence in the log (turn logging on), and the old value
stays. An indefinite matrix is noticed when it is next used, since entries are set one by one; the joint
then keeps its last valid matrices.</li>
<li>pythonfmu cannot return <code>fmi2Error</code>: a refused value is reported as <code>fmi2Fatal</code>,
a refused step as <code>fmi2Discard</code>. The instance can be used further in both cases.</li>
<li>The state can be saved, restored and serialised, to the last bit.</li>
</ul>
<h2>Variables</h2>
<table>
<tr><th>Name</th><th>Unit</th><th>Start</th><th>Meaning</th></tr>
{rows}
</table>
</body>
</html>
"""


def documentation(name: str, description: str, variables: Sequence[Variable], platforms: Sequence[str]) -> bytes:
    """documentation/index.html."""
    rows = (
        f"<tr><td>{escape(variable.name)}</td><td>{escape(variable.unit or '')}</td>"
        f"<td>{'' if variable.start is None else repr(variable.start)}</td>"
        f"<td>{escape(variable.description)}</td></tr>"
        for variable in variables
    )
    return _PAGE.format(
        name=escape(name),
        description=escape(description),
        platforms=escape(", ".join(platforms)),
        rows="\n".join(rows),
    ).encode()
