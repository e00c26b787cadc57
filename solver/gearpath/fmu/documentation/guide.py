"""The words of the page: equations, and how the FMU behaves."""

from html import escape

from ...network.modal import ModalNetwork
from ...network.records import MeshSource, Schedule
from ...network.time_twin import RIGID_SCALE
from ..description import LOG_CATEGORIES

_EQUATIONS = """
<p>Every component moves in its own free-free modes, mass-normalised: N = {N} modal coordinates q, with L =
diag(ω<sub>r</sub><sup>2</sup>) and X = diag(2ζ<sub>r</sub>ω<sub>r</sub>). Joints are massless springs and
dampers, K and C full symmetric matrices on their degrees of freedom; P takes their relative motion (source
minus receiver) out of q. The force g of a joint acts on its receiver, the second of the two ends; −g acts on
the source.</p>
<h3>In time</h3>
<p class="eq">q′ = s + X d e<br>
s′ = −L q − X s + (L − X<sup>2</sup>) d e + Φ<sup>T</sup>f − P<sup>T</sup>g<br>
g = K P q + C P q′</p>
<p>Inputs: forces f, and transmission errors e in gear meshes; d is the spin of the gears that undoes a unit of
e. The equations need no derivative of e. States: first w q, then s, 2N = {states} numbers, w each mode's own
angular frequency ({rigid} rad/s for rigid motions), so that x′ = A x + B u and y = C x + D u are well balanced;
they start at zero. Loss factors, which have no causal form in time, enter as viscous damping. Powers are
instantaneous: P = g · v of the receiver, positive into it.</p>
<h3>Over frequency</h3>
<p class="eq">g = Z P v,&emsp;v = Y (f<sub>e</sub> − P<sup>T</sup>g) + iω d e,&emsp;that is
(I + Z P Y P<sup>T</sup>) g = Z P (Y f<sub>e</sub> + iω d e)<br>
Z = K/(iω) + C,&emsp;Y = iω (L − ω<sup>2</sup> + iωX)<sup>−1</sup><br>
P<sub>path</sub> = ½ Re(v̅ g) of the receiver,&emsp;α = Σ P<sub>path</sub> / P<sub>in</sub></p>
<p>Here v are modal velocities, Y is the mobility of the free components, and f<sub>e</sub> their modal excitation:
Φ<sup>T</sup>f of a force, ω<sup>2</sup> M d e of a transmission error (M d, the modal column of the spin), whose own
motion is iω d e. P<sub>in</sub> is the power that the excitation puts in, which equals all power dissipated. Phasors
are peak amplitudes, e<sup>+iωt</sup>; powers are time averages. Paths are the degrees of freedom of {paths}; α lies
below 1, while single paths can exceed it where others return power. The excitation of all ratios and of the outputs
<code>frf.*</code> is <code>{excitation}</code>; they follow the input <code>frequency</code> and all parameters at
once, have no memory, and are 0 at 0 Hz.</p>
<p>Frame: z along the shafts, y along the line of action, x across, right-handed; rotations by the right hand.
All units are SI. Method: Rook and Singh, Structure-borne noise power flow in gearboxes, 1996 (mobility
synthesis).</p>
"""

_SOURCE = """
<h3>The gear mesh source</h3>
<p class="eq">e = <code>{load}</code> + Σ a<sub>i</sub> cos((h<sub>i</sub> z + k<sub>i</sub>) θ + φ<sub>i</sub>)<br>
θ′ = 2π n / 60</p>
<p>Inside the FMU, tones that turn with the driving shaft add to the input: n is the speed
(<code>{prefix}.speed</code>, rev/min, an input that may change), z the tooth count, h<sub>i</sub> the harmonic
and k<sub>i</sub> the shaft orders of a sideband beside it. Amplitude a<sub>i</sub>, phase φ<sub>i</sub> and z
are tunable. The tones are integrated exactly at constant speed, whatever the step size, and to rounding in a
run-up with the speed linear over a step. With all amplitudes 0 the source is off. A start at e ≠ 0 is a jump and
rings for some tens of milliseconds: begin with a phase of −π/2, or raise the amplitude from 0.</p>
"""

_INPUTS = {
    "2.0": """
<p>Steps are exact for the signal between communication points, at any step size from 1 µs to 1 s, fixed or not;
what a simulation misses is only what it assumes about its inputs. <strong>They are held</strong> at the values
set before <code>fmi2DoStep</code>, unless <code>fmi2SetRealInputDerivatives</code> gives their first
derivatives: then they vary <strong>linearly</strong> over the coming step, which is integrated exactly too. A
derivative lasts one step. Held inputs lag by half a step: for a tone of frequency F and a step h the error is
about π F h of the response (3 % at 1 kHz and 10 µs), linear ones leave about (π F h)<sup>2</sup>/3.</p>
<p>Model exchange: the importer's solver sees the inputs as it sets them (some hold them over its internal steps).
The system is linear and stiff, with modes up to {highest} kHz: use an implicit solver, or co-simulation, which is
faster and more accurate.</p>
""",
    "3.0": """
<p>Steps are exact for the signal between communication points, at any step size from 1 µs to 1 s, fixed or not;
what a simulation misses is only what it assumes about its inputs. <strong>They are held</strong> at the values
set before <code>fmi3DoStep</code>, unless the importer gave a callback <code>fmi3IntermediateUpdate</code>: it
is called with the end of the step and <code>intermediateVariableSetRequested</code>, and inputs that it sets
there are those at the end of the step. They then vary <strong>linearly</strong> over the step, which is
integrated exactly too. After the step it is called again to read results. Held inputs lag by half a step: for a
tone of frequency F and a step h the error is about π F h of the response (3 % at 1 kHz and 10 µs), linear ones
leave about (π F h)<sup>2</sup>/3.</p>
<p>Model exchange: the importer's solver sees the inputs as it sets them (some hold them over its internal steps).
The system is linear and stiff, with modes up to {highest} kHz: use an implicit solver, or co-simulation, which is
faster and more accurate.</p>
""",
}

_BEHAVIOUR = """
<h3>Parameters while running</h3>
<p>All parameters are tunable: stiffness and damping of {joints} {matrices}, the modal damping of
components{more}. Set them before or in initialisation, between the steps of a co-simulation, or in the event
mode of model exchange. The next step or output uses them, the power ratios included; positions and velocities
stay continuous. Matrices are symmetric and must be positive semidefinite; damping ratios lie from 0 to below 1.
What cannot be used is refused with a sentence in the log, and the old value stays; entries set one by one may
make a matrix indefinite for a while, so that it is judged when it is next used. As exported, a step costs a
few products a mode; after a change of joints or damping the whole system is discretised anew for every step
size in use, and a step is a matrix product.</p>
<h3>State and derivatives</h3>
<p>{state} The state holds everything: parameters, inputs, modal coordinates, time and phase. As bytes it has no
pointers, carries a checksum and the identity of the model, and can be restored in another process on another
platform; those of another model or altered ones are refused. {derivatives} They are exact, with respect to
inputs, states and parameters, in both interface types.</p>
<h3>Errors and logging</h3>
<p>A call that cannot be done returns an error, logs a sentence and changes nothing; instantiation returns NULL.
Log categories:</p>
<dl>
{categories}
</dl>
<h3>Platforms</h3>
<p>Nothing is needed beside the FMU: the libraries in <code>binaries/</code> use the C library only, and
<code>sources/</code> compiles to the same numbers. Any number of instances may run at a time, each in any one
thread; there are no global variables, and no step takes memory.</p>
"""

_SCHEDULE = """
<h3>Stiffness over the torque</h3>
<p class="eq">K(T) = (1 − s) K<sub>i</sub> + s K<sub>i+1</sub>,&emsp;s = (T − T<sub>i</sub>) / (T<sub>i+1</sub> −
T<sub>i</sub>)</p>
<p>The input <code>operation.torque</code> (T, N m) decides the stiffness of {stiffness}, and the damping of {damping}:
linear between the operating points {points}&nbsp;N&nbsp;m, whose matrices were computed at export; beyond them those
of the first or last one. They can be read but not set. Outputs over frequency follow at once, and so do derivatives
in model exchange. A step holds the torque at the value set before it (a derivative in time, or a value for its end,
counts from its end on), and each change of the torque costs as much as a change of parameters. Motion stays
continuous. Derivatives with respect to the torque are those of the interval above it, at a point too.</p>
"""

_STATE = {
    "2.0": "<code>fmi2GetFMUstate</code>, <code>fmi2SetFMUstate</code> and serialisation work between steps.",
    "3.0": "<code>fmi3GetFMUState</code>, <code>fmi3SetFMUState</code> and serialisation work between steps.",
}
_DERIVATIVES = {
    "2.0": "<code>fmi2GetDirectionalDerivative</code> gives directional derivatives.",
    "3.0": "<code>fmi3GetDirectionalDerivative</code> and <code>fmi3GetAdjointDerivative</code> give derivatives of "
    "outputs and states; the matrices A, B, C and D themselves are the variables <code>system.*</code>.",
}
_MATRICES = {
    "2.0": "(entry by entry of the upper half; the lower one is its mirror image)",
    "3.0": "(whole matrices, which must be symmetric)",
}
_REFERENCE = """
<p>In <code>extra/org.fmi-standard.fmi-ls-ref/</code> lie a swept sine in every load and the outputs that must
come out, for held and for linear inputs, computed apart from this FMU with the matrix exponential of the whole
model (<a href="fmi-ls-ref.txt">more about them</a>).</p>
"""
_TERMINALS = """
<p><code>terminalsAndIcons/terminalsAndIcons.xml</code> has a terminal for every joint: <code>force_*</code>
(outflow, positive on the receiver) with <code>velocity_*</code> (signal, of the receiver) for each degree of
freedom, whose products are the power into the receiver; and one for every excitation. A joint is inside the
FMU: its terminal is for reading, such as by a radiation model.</p>
"""


def equations(network: ModalNetwork) -> str:
    """State equations, synthesis, signs and units."""
    text = _EQUATIONS.format(
        N=len(network.eigenvalues),
        states=2 * len(network.eigenvalues),
        rigid=f"{RIGID_SCALE:.6g}",
        paths=escape(", ".join(network.paths)) or "no joint",
        excitation=escape(network.excitation),
    )
    return text + (_source(network.source) if network.source is not None else "")


def _source(source: MeshSource) -> str:
    return _SOURCE.format(load=escape(source.load), prefix=escape(source.load.rpartition(".")[0]))


def inputs(fmi: str, highest: float) -> str:
    """What holds between communication points; `highest` is the largest natural frequency, Hz."""
    return _INPUTS[fmi].format(highest=f"{highest / 1000.0:.3g}")


def behaviour(network: ModalNetwork, fmi: str) -> str:
    """Parameters, the schedule over the torque, state, derivatives, errors, logging, platforms."""
    listed = (f"<dt><code>{escape(k)}</code></dt><dd>{escape(v)}</dd>" for k, v in LOG_CATEGORIES.items())
    scheduled = "" if network.schedule is None else _scheduled(network.schedule)
    return scheduled + _BEHAVIOUR.format(
        joints="every joint" if network.schedule is None else "every joint that does not follow the torque",
        matrices=_MATRICES[fmi],
        more=", tooth count and tones of the gear mesh source" if network.source is not None else "",
        state=_STATE[fmi],
        derivatives=_DERIVATIVES[fmi],
        categories="\n".join(listed),
    )


def _scheduled(schedule: Schedule) -> str:
    points = ", ".join(f"{torque:g}" for torque in schedule.torques)
    return _SCHEDULE.format(
        points=points,
        stiffness=escape(", ".join(sorted(schedule.stiffness))),
        damping=escape(", ".join(sorted(schedule.damping))) or "none of them",
    )


def files(reference: bool) -> str:
    """Terminals and reference files."""
    return _TERMINALS + (_REFERENCE if reference else "")
