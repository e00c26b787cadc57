"""The command `gearpath bearing`: a bearing of the catalogue or those of a model, printed and drawn."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from .. import console
from ..errors import InputError
from ..joints.bearings import catalogue_bearing, designations
from ..modelfile.hints import hint
from .bearing_record import as_dict
from .bearing_text import text
from .bearings import Case
from .mounted_bearings import study_machine
from .single_bearing import Duty, arranged, study


@dataclass(frozen=True)
class Order:
    """What the command line asks for, as it was written."""

    target: str | None
    load: Sequence[str] = ()
    displacement: Sequence[str] = ()
    preload: float | None = None
    mirrored: bool = False
    arrangement: str = ""
    distance: float | None = None
    speed: float | None = None
    phases: bool = False
    joint: str | None = None
    settings: Sequence[str] = ()
    catalogue_file: Path | None = None

    @property
    def is_model(self) -> bool:
        """Whether the target is a model file."""
        return self.target is not None and self.target.lower().endswith(".toml")


def run(order: Order, output: Path | None, json: bool) -> None:
    """Study what is ordered, print it, and write its page."""
    if order.target is None:
        _refuse_without_target(order, output)
        _list(order.catalogue_file, json)
        return
    write = None
    if output is not None:
        from ..report.bearing_page import bearing_page

        write = bearing_page(output)
    found = _of_model(order) if order.is_model else [_of_catalogue(order)]
    if write is not None:
        write(found)
    if json:
        console.print_json(as_dict(found) | ({"page": output} if output else {}))
        return
    for case in found:
        _print(case)
    if output is not None:
        console.out.print(f"wrote {output}", markup=False)


def pairs(option: str, entries: Sequence[str]) -> dict[str, float]:
    """The numbers of repeated `name=value` (or `a=1,b=2`) options; raises InputError."""
    found: dict[str, float] = {}
    for item in (part for given in entries for part in given.split(",")):
        name, separator, value = (part.strip() for part in item.partition("="))
        try:
            number = float(value) if separator and name else None
        except ValueError:
            number = None
        if number is None:
            raise InputError(f"{option} {item}: is not NAME=NUMBER; write for example {option} uz=1000")
        if name in found:
            raise InputError(f"{option} {item}: {name} is given twice; give it once")
        found[name] = number
    return found


def _refuse_without_target(order: Order, output: Path | None) -> None:
    given = [order.load, order.displacement, order.preload, order.mirrored, order.arrangement, order.distance]
    if any(given) or output or order.phases or order.joint or order.settings or order.speed is not None:
        raise InputError(
            "bearing: there is no target; name a bearing of the catalogue (shown by gearpath bearing --list) or a model"
        )


def _of_catalogue(order: Order) -> Case:
    if order.joint is not None or order.settings:
        raise InputError(f"--joint and --set belong to a model file, and {order.target} is none; leave them out")
    name = order.target or ""
    sources = _known(order.catalogue_file)
    if name not in sources:
        near = next((each for each in sources if each.lower().startswith(name.lower())), "")
        advice = f"did you mean {near!r}?" if near else hint(name, list(sources))
        raise InputError(f"there is no bearing {name!r} in the catalogue; {advice}")
    own = order.catalogue_file is not None and name in designations(order.catalogue_file)
    bearing = arranged(
        catalogue_bearing(name, order.catalogue_file if own else None),
        order.mirrored,
        order.arrangement,
        order.distance,
    )
    duty = Duty(
        pairs("--load", order.load),
        pairs("--displacement", order.displacement),
        order.preload or 0.0,
        order.speed,
    )
    return study(name, bearing, duty, phases=order.phases, source=sources[name])


def _of_model(order: Order) -> list[Case]:
    own = [order.load, order.displacement, order.preload, order.mirrored, order.arrangement, order.distance]
    if any(own) or order.speed is not None or order.catalogue_file is not None:
        raise InputError(
            f"{order.target}: the model says how its bearings are mounted and loaded; change it with --set, such as "
            "--set joints.bearing_1.load.uz=500"
        )
    model = console.load_with(Path(order.target or ""), order.settings, noted=False)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # every case has its notes
        system = model.system
    return study_machine(system, order.joint, phases=order.phases)


def _known(file: Path | None) -> dict[str, str]:
    """Own entries come first and replace those of the same name."""
    own = {} if file is None else designations(file)
    return own | {name: source for name, source in designations().items() if name not in own}


def _list(file: Path | None, json: bool) -> None:
    known = _known(file)
    if json:
        console.print_json({"catalogue": known})
        return
    wide = max(len(name) for name in known)
    console.out.print(f"{'designation':{wide}}  source of the numbers", style="bold", markup=False)
    for name, source in known.items():
        console.out.print(f"{name:{wide}}  {source}", markup=False)


def _print(case: Case) -> None:
    for heading, lines in text(case):
        console.out.print(heading, style="bold", markup=False)
        for line in lines:
            console.out.print(f"  {line}", markup=False)
        console.out.print()
