"""Rules of the whole network: connected, and every shaft divided as its stations ask."""

from ...components.shaft_mesh import shaft_stations
from ...errors import ModelError
from ...joints import RIGID
from ..build import build_shaft
from ..references import find_port, station_of
from ..tables import FileTable
from ..train_tables import GearTrainTable
from ..wording import show


def check_network(file: FileTable) -> None:
    """Refuse parts that are not connected, and element numbers that do not fit the stations."""
    _check_connected(file)
    _check_direction(file)
    for name, component in file.components.items():
        if isinstance(component, GearTrainTable):
            for shaft in component.shafts:
                _check_elements(file, component, name, shaft)


def _check_connected(file: FileTable) -> None:
    if not file.joints:
        raise ModelError("joints", "there is no joint", "connect the components with at least one")
    if all(joint.kind == RIGID for joint in file.joints.values()):
        raise ModelError("joints", "all of them are rigid, so that none has a force", "add a bearing or a mount")
    links: dict[str, set[str]] = {name: set() for name in file.components}
    used: set[str] = set()
    for name, joint in file.joints.items():
        first, second = (find_port(file, text, f"joints.{name}.between") for text in joint.between)
        used |= {first.component, second.component}
        if not second.is_ground:
            links[first.component].add(second.component)
            links[second.component].add(first.component)
    for name in file.components:
        if name not in used:
            raise ModelError(f"components.{name}", f"no joint connects {show(name)}", "add one, or remove it")
    start = next(iter(file.components))
    reached, waiting = {start}, [start]
    while waiting:
        fresh = links[waiting.pop()] - reached
        reached |= fresh
        waiting += fresh
    for name in file.components:
        if name not in reached:
            raise ModelError(
                f"components.{name}",
                f"no path of joints connects {show(name)} with {show(start)} (the ground connects nothing)",
                "add a joint between them, or make two models",
            )


def _check_direction(file: FileTable) -> None:
    """Refuse bearings and bolted joints that lead in a circle: which end is the source?"""
    body = _bodies(file)
    leads: dict[str, set[str]] = {name: set() for name in body.values()}
    for name, joint in file.joints.items():
        ends = [find_port(file, text, f"joints.{name}.between").component for text in joint.between]
        source, receiver = (body[end] for end in ends)
        if joint.kind in ("mount", RIGID) or source == receiver:
            continue
        reached, waiting = set[str](), [receiver]
        while waiting:
            here = waiting.pop()
            reached.add(here)
            waiting += leads.get(here, set()) - reached
        if source in reached:
            raise ModelError(
                f"joints.{name}.between",
                f"{show(list(joint.between))} leads from {ends[0]} to {ends[1]}, and other joints lead back",
                "put the source first in all of them: power counts from the first end to the second",
            )
        leads[source].add(receiver)


def _bodies(file: FileTable) -> dict[str, str]:
    """Component -> one of those that rigid joints hold together with it; the ground by itself."""
    body = {name: name for name in [*file.components, "ground"]}
    for joint in file.joints.values():
        if joint.kind == RIGID and "ground" not in joint.between:
            first, other = (body[find_port(file, text, "between").component] for text in joint.between)
            body = {name: first if of == other else of for name, of in body.items()}
    return body


def _check_elements(file: FileTable, train: GearTrainTable, component: str, shaft: str) -> None:
    counts = train.shafts[shaft].elements
    if not isinstance(counts, tuple):
        return
    ports = [
        find_port(file, text, f"joints.{name}.between") for name, joint in file.joints.items() for text in joint.between
    ]
    bearings = [
        z
        for port in ports
        if (port.component, port.shaft) == (component, shaft) and (z := station_of(file, port)) is not None
    ]
    stations = shaft_stations(build_shaft(file, train.shafts[shaft]), bearings)
    spans = len(stations) - 1
    if len(counts) != spans:
        places = ", ".join(f"{z:.9g}" for z in stations)
        raise ModelError(
            f"components.{component}.shafts.{shaft}.elements",
            f"{show(list(counts))} has {len(counts)} entries for the {spans} spans between {places} m",
            "give one number a span, or one whole number for all",
        )
