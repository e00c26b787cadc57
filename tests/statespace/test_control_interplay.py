"""The four objects with python-control's own functions: bode_plot, feedback, interconnect, forced_response, printing.

To take in another one, add it to `SYSTEMS` and `makers`: all of them have the signals of the default gearbox.
"""

import warnings
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest

import gearpath as gp

control = pytest.importorskip("control")
pytest.importorskip("fmpy")
mpl.use("Agg")
LINES = np.linspace(20.0, 5000.0, 200)  # Hz
FMI = {"linearize": "2.0", "linearize_3": "3.0"}
MODEL = Path(__file__).resolve().parents[2] / "models" / "gearbox.toml"
OUTPUTS, INPUTS = ["mesh/velocity", "casing/velocity_uy"], ["mesh/force"]
SYSTEMS = ("state_space", "reduce", "linearize", "linearize_3")
TOLERANCE = {"reduce": 5e-3}  # asked for 1e-3 of each largest gain; the others are exact


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Each of the systems, by name, made when it is first asked for."""
    model, folder, known = gp.load(MODEL), tmp_path_factory.mktemp("interplay"), {}

    def linearized(name):
        path = gp.export_fmu(model, folder / f"{name}.fmu", fmi=FMI[name], documentation=False)
        return gp.linearize(path, inputs=["mesh.transmission_error", "mesh.force"])

    makers = {
        "state_space": lambda: gp.state_space(model),
        "reduce": lambda: gp.reduce(model, tolerance=1e-3),
        "to_frd": lambda: gp.to_frd(model, LINES),
        **{name: lambda name=name: linearized(name) for name in FMI},
    }

    def make(name):
        if name not in known:
            known[name] = makers[name]()
        return known[name]

    return make


@pytest.fixture
def exact(made):
    """What all are compared with: complex numbers of the state space."""
    return made("state_space")


@pytest.fixture(params=SYSTEMS)
def system(request, made):
    return made(request.param)


@pytest.fixture(params=[*SYSTEMS, "to_frd"])
def response(request, made):
    """All of them, frequency responses too."""
    return made(request.param)


@pytest.fixture
def tolerance(request):
    return TOLERANCE.get(request.node.callspec.params.get("system", request.node.callspec.params.get("response")), 1e-8)


def test_bode_plot_draws_the_gains_under_their_names(response, exact, tolerance):
    figure = plt.figure()
    part = response[OUTPUTS, INPUTS]
    control.bode_plot(part if isinstance(part, control.FRD) else control.frequency_response(part, 2 * np.pi * LINES))
    written = " ".join(text.get_text() for text in figure.findobj(mpl.text.Text))
    drawn = [line.get_xydata() for axes in figure.axes for line in axes.lines if len(line.get_xydata()) > 50]
    plt.close(figure)
    assert all(name in written for name in (*OUTPUTS, *INPUTS))
    for data, name in zip(drawn[::2], OUTPUTS, strict=True):  # magnitude and phase in turn
        gain = abs(exact[name, "mesh/force"](1j * data[:, 0]))
        assert abs(data[:, 1] - gain).max() < tolerance * gain.max()


def test_printing_names_the_signals(response):
    text = str(response[OUTPUTS, INPUTS])
    assert all(name in text for name in (*OUTPUTS, *INPUTS))
    assert "casing/velocity_uy (m/s)" in response.__doc__


def test_every_signal_has_its_unit(response):
    assert list(response.input_units) == response.input_labels
    assert list(response.output_units) == response.output_labels
    assert response.input_units["mesh/force"] == "N"


def test_states_have_their_units(made):
    """Modal ones are mass-normalised: J^0.5; the FMU has no unit for them, as FMI knows whole exponents only."""
    for name, unit in (("state_space", "J^0.5"), ("reduce", "J^0.5"), ("linearize", "")):
        assert list(made(name).state_units) == made(name).state_labels
        assert set(made(name).state_units.values()) == {unit}


@pytest.mark.parametrize("sign", [-1, 1])
def test_feedback_is_that_of_the_frequency_response(response, exact, tolerance, sign):
    """H / (1 - sign k H), in complex numbers."""
    k, s = 40.0, 2j * np.pi * LINES
    H = exact["mesh/velocity", "mesh/force"](s)
    expected = H / (1.0 - sign * k * H)
    found = control.feedback(response["mesh/velocity", "mesh/force"], k, sign)(s)
    assert abs(found - expected).max() < tolerance * abs(expected).max()


def test_interconnect_by_names(system, exact, tolerance):
    """A velocity fed back to a force through a controller, all by names."""
    controller = control.ss(
        [[-2000.0]], [[1.0]], [[-4e4]], [[0.0]], inputs="casing/velocity_uy", outputs="mesh/force", name="controller"
    )
    outputs, inputs = ["mount_1/force_uy", "casing/velocity_uy"], ["mesh/transmission_error", "mesh/force"]
    loop = control.interconnect([system[outputs, inputs], controller], inputs=inputs[:1], outputs=outputs)
    assert (loop.input_labels, loop.output_labels) == (inputs[:1], outputs)
    s = 2j * np.pi * LINES
    H, K = exact[outputs, inputs](s), -4e4 / (s + 2000.0)
    expected = H[:, 0] + H[:, 1] * K * H[1, 0] / (1.0 - K * H[1, 1])
    apart = abs(loop(s)[:, 0] - expected)
    assert np.all(apart.max(axis=1) < tolerance * abs(expected).max(axis=1))


def test_connect_by_numbers(system, exact, tolerance):
    """The older function, which python-control keeps under a deprecation."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FutureWarning)
        loop = control.connect(system[OUTPUTS, INPUTS], [[1, -1]], [1], [1, 2])
    s = 2j * np.pi * LINES
    H = exact[OUTPUTS, INPUTS](s)[:, 0]
    expected = H / (1.0 + H[0])
    assert np.all(abs(loop(s)[:, 0] - expected).max(axis=1) < tolerance * abs(expected).max(axis=1))


def test_forced_response_settles_to_the_frequency_response(system, exact):
    """A sine long after its start: amplitude and phase of the transfer, but for the straight lines between samples."""
    f, periods, samples = 400.0, 200, 64
    t = np.linspace(0.0, periods / f, samples * periods + 1)
    part = system[["casing/velocity_uy"], INPUTS]
    run = control.forced_response(part, t, np.sin(2 * np.pi * f * t))
    last = slice(-10 * samples, None)
    phasor = 2j * np.mean(run.outputs[last] * np.exp(-2j * np.pi * f * t[last]))
    expected = exact["casing/velocity_uy", "mesh/force"](2j * np.pi * f)
    assert run.output_labels == ["casing/velocity_uy"]
    assert abs(phasor - expected) < 5e-3 * abs(expected)
