"""What cannot be linearised is refused with a sentence."""

import os
import subprocess
import sys
import zipfile

import fmpy
import pytest

import gearpath as gp
from gearpath.fmu.conformance.instance import CallError
from gearpath.fmu.linearizing.run import _Continued


def refused(match, path, **options):
    with pytest.raises(gp.InputError, match=match) as caught:
        gp.linearize(path, **options)
    assert "\n" not in str(caught.value)


def rewritten(path, target, change):
    """A copy of an FMU with another model description (None: without)."""
    with zipfile.ZipFile(path) as old, zipfile.ZipFile(target, "w") as new:
        for name in old.namelist():
            content = old.read(name)
            if name == "modelDescription.xml":
                content = change(content.decode())
                if content is None:
                    continue
            new.writestr(name, content)
    return target


def test_files_that_are_no_fmu(tmp_path, pendulums):
    refused("no such file", tmp_path / "none.fmu")
    refused("no such file", tmp_path)
    text = tmp_path / "text.fmu"
    text.write_text("an FMU, honestly")
    refused("is no FMU, which is a ZIP archive", text)
    refused("not at the top", rewritten(pendulums(), tmp_path / "a.fmu", lambda _: None))
    refused("not well-formed", rewritten(pendulums(), tmp_path / "b.fmu", lambda t: t[:500]))
    refused('is of FMI "1.0"', rewritten(pendulums(), tmp_path / "c.fmu", lambda t: t.replace('"2.0"', '"1.0"')))
    out = tmp_path / "d.fmu"
    with zipfile.ZipFile(out, "w") as file:
        file.writestr("../escaped.txt", "no")
    refused("no plain path", out)


def test_what_the_fmu_lacks(tmp_path, pendulums):
    slave = rewritten(pendulums(), tmp_path / "slave.fmu", lambda t: t.replace("ModelExchange", "CoSimulation"))
    refused("has no model exchange interface", slave)
    other = rewritten(
        pendulums(), tmp_path / "other.fmu", lambda t: t.replace('Identifier="pendulum"', 'Identifier="x"')
    )
    refused("no binary for this machine", other)
    lost = rewritten(pendulums(), tmp_path / "lost.fmu", lambda t: t.replace('derivative="2"', ""))
    refused("derivative 2 of the model structure leads to no state", lost)
    refused("provides no directional derivatives", pendulums(), method="derivatives")


def test_a_library_that_cannot_be_loaded(tmp_path, pendulums):
    broken = tmp_path / "broken.fmu"
    with zipfile.ZipFile(pendulums()) as old, zipfile.ZipFile(broken, "w") as new:
        new.writestr("modelDescription.xml", old.read("modelDescription.xml"))
        new.writestr(f"binaries/{fmpy.platform}/pendulum.so", b"\x7fELF, it says")
    refused("cannot be loaded", broken)


@pytest.mark.parametrize(
    ("options", "match"),
    [
        ({"inputs": "v"}, "no input 'v'"),
        ({"inputs": ["bob.w"]}, "'bob.w' is a continuous local of type Real; only continuous floats can be an input"),
        ({"outputs": ["Tt"]}, "no output 'Tt'; did you mean 'T'"),
        ({"outputs": ["gravity_on"]}, "'gravity_on' is a fixed parameter of type Boolean"),
        ({"states": {"bob.the": 1.0}}, "no state 'bob.the'; did you mean 'bob.th'"),
        ({"states": {"bob/the": 1.0}}, "no state 'bob/the'; did you mean 'bob.th'"),
        ({"states": {"h": "deep"}}, "h = 'deep' is not a number"),
        ({"states": {"h": float("nan")}}, "h = nan is not finite"),
        ({"start_values": {"planet": 2}}, "no variable 'planet'; did you mean 'planets'"),
        ({"start_values": {"T": 2.0}}, "'T' is a continuous output that cannot be set"),
        ({"start_values": {"m": "heavy"}}, "m = 'heavy' does not fit a Real"),
        ({"start_values": {"m": [1.0, 2.0]}}, "m has 1 elements, and 2 were given"),
        ({"start_values": {"m": float("inf")}}, "m = inf is not finite"),
        ({"inputs": [], "outputs": "h"}, "without inputs it needs two of each"),
        ({"method": "guess"}, "choose one of auto, derivatives, differences"),
        ({"relative_step": 0.0}, "0.0 is not a number from 1e-06 to 1"),
        ({"relative_step": 1e-30}, "1e-30 is not a number from 1e-06 to 1; in smaller steps"),
        ({"relative_step": "a"}, "'a' is not a number from"),
        ({"time": "a"}, "time: 'a' is not a number of seconds"),
        ({"inputs": 5}, "inputs: 5 names none; give one name or several"),
        ({"outputs": 1.0}, "outputs: 1.0 names none"),
        ({"states": [1.0]}, r"states: \[1.0\] gives no values by name"),
        ({"start_values": "m"}, "start_values: 'm' gives no values by name"),
        ({"time": -1.0}, "not a number of seconds from the FMU's start time, 0 s, on"),
    ],
)
def test_requests_that_do_not_fit(pendulums, options, match):
    refused(match, pendulums(), **options)


@pytest.mark.parametrize("fmi", [2, 3])
def test_the_fmus_own_message_is_passed_on(pendulums, fmi):
    refused("the mass m must be positive", pendulums(fmi), start_values={"m": -1.0})
    refused("the label says that it is broken", pendulums(fmi), start_values={"label": "broken"})
    refused("the inflow q must not be negative", pendulums(fmi), start_values={"q": -1.0})


def test_values_that_are_not_finite(pendulums):
    refused(r"the derivative of 'bob\.w' is -?(inf|nan) at the operating", pendulums(), start_values={"l": 0.0, "u": 1})
    refused("the derivative of 'h' is -?nan", pendulums(2, 1), states={"h": -1.0})


def test_a_run_that_fails(pendulums, capfd):
    """The tank runs dry: sqrt of a negative level, which fmpy's solver meets deep inside."""
    refused("the run to 20 s failed|not finite|is -?nan", pendulums(2, 1), start_values={"a": 0.5}, time=20.0)
    assert "Traceback" not in capfd.readouterr().err


@pytest.mark.parametrize("fmi", [2, 3])
def test_a_run_that_the_fmu_stops(pendulums, capfd, fmi):
    """The FMU's error comes up in the solver's own calls, through which no exception passes."""
    start = {"u": 1e4} if fmi == 2 else {"load": [1e4, 0.0]}
    refused("the bob turns too fast", pendulums(fmi, 1), start_values=start | {"k": 0.0}, time=1.0)
    assert "Traceback" not in capfd.readouterr().err


def test_a_run_stops_at_the_first_error():
    """No exception passes through the solver: it is kept, and the step after it is the last."""

    class Failing:
        time = 0.0

        def getDerivatives(self, *_):
            raise CallError("too fast")

    run = _Continued(Failing(), (False, 0.0))
    assert run.reaches(0.1)
    assert run.getDerivatives(None, 3) is None
    assert not run.reaches(0.2)
    assert str(run.problem) == "too fast"


def test_without_fmpy_it_names_the_extra(pendulums):
    code = (
        "import sys; sys.modules['fmpy'] = None\nimport gearpath as gp\n"
        f"try: gp.linearize({str(pendulums())!r})\nexcept gp.MissingExtraError as e: print(e)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=os.environ)
    assert 'pip install "gearpath[fmu]"' in done.stdout
