"""Real bearings in one gearbox: power paths, ranking, and what couplings and moments in their matrices are worth.

    python examples/bearing_study/bearing_study.py

Deep groove, angular contact, cylindrical and tapered bearings carry models/bearing_study.toml at its torque; their
matrices are then used whole, diagonal, and radial alone (Fig. 8 of Rook & Singh 1996). Prints the tables and the
statement of README.md and draws build/bearing_study.png.
"""

import warnings
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

import gearpath as gp

MODEL = Path(__file__).resolve().parents[2] / "models" / "bearing_study.toml"
NAMES = [f"bearing_{k}" for k in (1, 2, 3, 4)]
OCTAVES = 31.25 * 2.0 ** np.arange(8)  # Hz, 31.5 to 4000 Hz by their usual names
LINES = np.geomspace(OCTAVES[0] / 2**0.5, OCTAVES[-1] * 2**0.5, 401)[:-1]  # 50 in every octave
TORQUES = (5.0, 10.0, 20.0, 50.0, 100.0, 200.0)  # N m
PRELOAD = 500.0  # N, of angular contact and tapered bearings


def facing(designation: str, first: bool) -> list[dict]:
    """Four single bearings; the first of every shaft is mirrored or the second."""
    return [{"catalogue": designation, "preload": PRELOAD, "mirrored": (k % 2 == 0) == first} for k in range(4)]


BALL = {"catalogue": "6206-like"}
CASES = {
    "deep groove": [BALL] * 4,
    "angular contact, O": facing("7206B-like", False),
    "angular contact, X": facing("7206B-like", True),
    "cylindrical": [BALL, {"catalogue": "NU206-like"}] * 2,
    "tapered, O": facing("30206-like", False),
    "tapered, X": facing("30206-like", True),
}
IS_FORCE = np.array([True, True, True, False, False, False])
SAME = np.equal.outer(IS_FORCE, IS_FORCE)  # force-force and moment-moment entries
PARTS = {  # entries of the matrices that are kept
    "full": np.ones((6, 6)),
    "no force-moment coupling": 1.0 * SAME,
    "diagonal": np.eye(6),
    "no moments": 1.0 * np.logical_and.outer(IS_FORCE, IS_FORCE),
    "radial": np.diag([1.0, 1.0, 0.0, 0.0, 0.0, 0.0]),
}
HIGH = slice(5, 8)  # the octaves from 1 to 4 kHz


@dataclass
class Case:
    """One kind of bearings in the gearbox."""

    model: gp.Model
    states: dict  # joint -> gearpath.joints.bearings.Equilibrium
    flows: dict[str, xr.Dataset]  # by the part of the matrices that is kept


def main() -> None:
    """Print the tables and the statement, draw the picture."""
    cases = study()
    sweep = torque_sweep()
    print(text(cases, sweep))
    draw(Path("build") / "bearing_study.png", cases, sweep)


def text(cases: dict[str, Case], sweep: xr.Dataset) -> str:
    """The statement and all tables."""
    return "\n\n".join((statement(cases, sweep), *tables(cases, sweep)))


def study() -> dict[str, Case]:
    """Every case at its operating point, with all parts of the matrices."""
    return {name: solved(name) for name in CASES}


def solved(name: str) -> Case:
    """The power flow with these bearings, and with parts of their matrices."""
    model = machine(CASES[name])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the notes are printed instead
        states = gp.operating_point(model)
        flows = {part: gp.power_flow(typed(model, states, mask), LINES) for part, mask in PARTS.items()}
    return Case(model, states, flows)


def machine(bearings: Iterable[dict]) -> gp.Model:
    """The model of the study with these four bearings."""
    data = gp.load(MODEL).to_dict()
    for name, bearing in zip(NAMES, bearings):
        del data["joints"][name]["catalogue"]
        data["joints"][name] |= bearing
    return gp.Model.from_dict(data)


def typed(model: gp.Model, states: dict, mask: np.ndarray) -> gp.Model:
    """The model with the operating point's matrices, entry by entry times the mask, in place of the bearings."""
    data = model.to_dict()
    for name in NAMES:
        kept = {key: data["joints"][name][key] for key in ("kind", "between", "damping_time")}
        data["joints"][name] = {**kept, "stiffness": (mask * states[name].stiffness).tolist()}
    del data["operation"]
    return gp.Model.from_dict(data)


def torque_sweep() -> xr.Dataset:
    """alpha over torque and frequency, with deep groove bearings."""
    return gp.torque_sweep(gp.load(MODEL), TORQUES, LINES)


def octaves(alpha: xr.DataArray) -> np.ndarray:
    """Mean of a ratio over the lines of every octave (..., 8)."""
    return alpha.values.reshape(*alpha.shape[:-1], len(OCTAVES), -1).mean(axis=-1)


def change(case: Case, part: str) -> np.ndarray:
    """How far alpha moves with this part of the matrices: mean of |dB| over the lines of every octave."""
    level = abs(10.0 * np.log10(case.flows[part].alpha / case.flows["full"].alpha))
    return octaves(level)


def share_of_moments(flow: xr.Dataset) -> float:
    """Part of the moment paths in the sizes of all path powers, over all lines."""
    sizes = abs(flow.path_alpha).sum("frequency")
    return float(sizes[is_moment(flow)].sum() / sizes.sum())


def is_moment(flow: xr.Dataset) -> np.ndarray:
    """Which paths are moments."""
    return np.array([str(path).split(".")[1].startswith("r") for path in flow.path.values])


def ranking(flow: xr.Dataset) -> list[tuple[str, float]]:
    """Paths by the size of their mean net ratio, largest first."""
    mean = flow.path_alpha.mean("frequency").to_series()
    order = mean.abs().sort_values(ascending=False).index
    return [(str(path), float(mean[path])) for path in order]


def joints_ranked(flow: xr.Dataset) -> list[tuple[str, float]]:
    """Bearings by their mean net ratio, largest first."""
    mean = {name: sum(value for path, value in ranking(flow) if path.startswith(name)) for name in NAMES}
    return sorted(mean.items(), key=lambda item: -item[1])


def table(title: str, head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """A table in Markdown."""
    head = list(head)
    lines = [head, ["---", *["---:"] * (len(head) - 1)], *rows]
    return f"## {title}\n\n" + "\n".join("| " + " | ".join(line) + " |" for line in lines)


def tables(cases: dict[str, Case], sweep: xr.Dataset) -> list[str]:
    """All results."""
    bands = [f"{centre:.0f} Hz" for centre in OCTAVES]
    return [
        table(
            "Operating loads at 100 N m",
            ("bearings", "joint", "radial N", "axial N", "tilting N m", "elements loaded", "contact angles deg"),
            rows(cases, operating),
        ),
        table(
            "Stiffness at the operating point: N/um, kN m/rad, kN/rad; couplings K_ij also over sqrt(K_ii K_jj)",
            ("bearings", "joint", "ux", "uy", "uz", "rx", "ry", "uy-rx", "uz-rx", "uy-rx relative", "uz-rx relative"),
            rows(cases, stiffness),
        ),
        table(
            "alpha, mean of the lines of an octave, and over all lines in all, through forces and through moments",
            ("bearings", *bands, "all", "forces", "moments"),
            [[name, *ratios(case.flows["full"])] for name, case in cases.items()],
        ),
        table(
            "Ranking: mean path ratios over all lines",
            ("bearings", "joints", "paths", "share of moments in |path powers|"),
            [[name, *ranks(case.flows["full"])] for name, case in cases.items()],
        ),
        table(
            "Change of alpha when only a part of the matrices is kept: mean |dB| in every octave, and over all lines",
            ("bearings", "kept", *bands, "all", "share of moments"),
            [[name, *changes(case, part)] for name, case in cases.items() for part in PARTS if part != "full"],
        ),
        table(
            "Torque sweep of the deep groove bearings: K_uy of bearing 1 (N/um) and alpha",
            ("torque N m", "K_uy", *bands),
            torque_rows(sweep),
        ),
    ]


def rows(cases: dict[str, Case], cells: Callable) -> list[list[str]]:
    """A line for every bearing of every case."""
    return [[name, joint, *cells(state)] for name, case in cases.items() for joint, state in case.states.items()]


def operating(state) -> list[str]:
    """What a bearing carries."""
    F, angles = state.load, np.degrees(abs(state.contact_angles[state.element_loads > 0]))
    numbers = (np.hypot(F[0], F[1]), F[2], np.hypot(F[3], F[4]))
    loaded = f"{state.loaded} of {len(state.element_loads)}"
    return [f"{x:.4g}" if abs(x) > 1e-6 else "0" for x in numbers] + [
        loaded,
        f"{angles.min():.1f} to {angles.max():.1f}",
    ]


def stiffness(state) -> list[str]:
    """Diagonal of K and its main couplings."""
    K = state.stiffness
    diagonal = [f"{K[i, i] / unit:.3g}" for i, unit in enumerate((1e6, 1e6, 1e6, 1e3, 1e3))]
    return [
        *diagonal,
        *(f"{K[i, 3] / 1e3:.3g}" for i in (1, 2)),
        f"{coupling(K, 1, 3):.2f}",
        f"{coupling(K, 2, 3):.2f}",
    ]


def coupling(K: np.ndarray, i: int, j: int) -> float:
    """|K_ij| over sqrt(K_ii K_jj): 0 without coupling, 1 where it is as strong as can be."""
    scale = np.sqrt(K[i, i] * K[j, j])
    return float(abs(K[i, j]) / scale) if scale else 0.0


def ratios(flow: xr.Dataset) -> list[str]:
    """alpha by octaves, over all lines, and its parts."""
    parts = [float(part.mean()) for part in (flow.alpha, flow.alpha_force, flow.alpha_moment)]
    return [f"{a:.3g}" for a in (*octaves(flow.alpha), *parts[:2])] + [f"{parts[2]:.1e}"]


def ranks(flow: xr.Dataset) -> list[str]:
    """Bearings and the first paths in their order."""
    joints = ", ".join(f"{name[-1]}: {value:.3f}" for name, value in joints_ranked(flow))
    paths = ", ".join(f"{name[len('bearing_') :]}: {value:.3f}" for name, value in ranking(flow)[:4])
    return [joints, paths, f"{100.0 * share_of_moments(flow):.2f} %"]


def changes(case: Case, part: str) -> list[str]:
    """What leaving out the rest of the matrices does, dB."""
    moved = change(case, part)
    return [
        part,
        *(f"{dB:.2f}" for dB in (*moved, moved.mean())),
        f"{100.0 * share_of_moments(case.flows[part]):.2f} %",
    ]


def torque_rows(sweep: xr.Dataset) -> list[list[str]]:
    """Stiffness and alpha by octaves at every torque."""
    K = sweep["stiffness.bearing_1"].sel(dof="uy", dof_2="uy").values / 1e6
    return [
        [f"{torque:g}", f"{k:.0f}", *(f"{a:.3g}" for a in alpha)]
        for torque, k, alpha in zip(TORQUES, K, octaves(sweep.alpha))
    ]


def high(case: Case, part: str) -> float:
    """Mean of |dB| over the octaves from 1 to 4 kHz."""
    return float(change(case, part)[HIGH].mean())


def span(values: Iterable[float], digits: int) -> str:
    """The smallest and the largest of some numbers."""
    values = list(values)
    return f"{min(values):.{digits}f} to {max(values):.{digits}f}"


def numbers(cases: dict[str, Case], sweep: xr.Dataset) -> dict[str, str]:
    """The numbers of the statement, by the names that it has for them."""
    full = {name: case.flows["full"] for name, case in cases.items()}
    groups = {"angular": "angular", "tapered": "tapered", "plain": ("deep", "cylindrical")}
    found = {}
    for group, names in groups.items():
        chosen = [case for name, case in cases.items() if name.startswith(names)]
        for key, part in (("mixed", "no force-moment coupling"), ("diagonal", "diagonal"), ("radial", "radial")):
            found[f"{group}_{key}"] = span((high(case, part) for case in chosen), 1)
        for key in ("full", "diagonal"):
            shares = (100.0 * share_of_moments(case.flows[key]) for case in chosen)
            found[f"{group}_moments_{key}"] = span(shares, 2)
    balls = [s.contact_angles[s.element_loads > 0] for s in cases["deep groove"].states.values()]
    plain = [case for name, case in cases.items() if name.startswith(groups["plain"])]
    worst = np.max([change(case, part) for case in plain for part in ("diagonal", "radial")], axis=0)
    top = octaves(sweep.alpha)[:, -1]
    K = sweep["stiffness.bearing_1"].sel(dof="uy", dof_2="uy").values
    return found | {
        "low": f"{max(change(case, part)[:4].max() for case in cases.values() for part in PARTS):.2f}",
        "alpha": span((a for flow in full.values() for a in octaves(flow.alpha)[:4]), 3),
        "plain_most": f"{worst.max():.1f}",
        "plain_where": f"{OCTAVES[worst.argmax()]:.0f}",
        "angles": span(np.degrees(abs(np.concatenate(balls))), 1),
        "coupled": span((coupling(s.stiffness, 1, 3) for s in cases["deep groove"].states.values()), 2),
        "angular_apart": f"{apart(full, 'angular contact'):.1f}",
        "tapered_apart": f"{apart(full, 'tapered'):.1f}",
        "stiffer": f"{K[-1] / K[0]:.1f}",
        "louder": f"{top[-1] / top[0]:.1f}",
    }


def statement(cases: dict[str, Case], sweep: xr.Dataset) -> str:
    """What the study shows, with its numbers; README.md repeats it and a test compares them."""
    words = Path(__file__).with_name("statement.txt").read_text(encoding="utf-8")
    return words.strip().format(**numbers(cases, sweep))


def apart(full: dict[str, xr.Dataset], kind: str) -> float:
    """How far alpha of both arrangements is apart from 1 to 4 kHz: mean of |dB|."""
    levels = abs(10.0 * np.log10(full[f"{kind}, O"].alpha / full[f"{kind}, X"].alpha))
    return float(octaves(levels)[HIGH].mean())


def draw(path: Path, cases: dict[str, Case], sweep: xr.Dataset) -> None:
    """alpha of all bearings, what parts of the matrices do, and alpha over the torque."""
    figure = Figure(figsize=(12, 9), layout="constrained")
    (first, second), (third, fourth) = figure.subplots(2, 2)
    for name, case in cases.items():
        first.loglog(LINES, case.flows["full"].alpha, label=name, linewidth=1.0)
    first.set_title("alpha, full matrices")
    for part, style in zip(PARTS, ("k-", "C2-", "C0-", "C3--", "C1--")):
        second.loglog(LINES, cases["angular contact, O"].flows[part].alpha, style, label=part, linewidth=1.0)
    second.set_title("angular contact, O: alpha with parts of the matrices")
    left_out = [part for part in PARTS if part != "full"]
    for k, part in enumerate(left_out):
        heights = [high(case, part) for case in cases.values()]
        third.bar(np.arange(len(cases)) + 0.2 * (k - 1.5), heights, 0.2, label=part)
    third.set_xticks(range(len(cases)), [name.replace(" ", "\n", 1) for name in cases])
    third.set(title="change of alpha from 1 to 4 kHz", ylabel="mean |dB|")
    for torque, alpha in zip(TORQUES, sweep.alpha.values):
        fourth.loglog(LINES, alpha, label=f"{torque:g} N m", linewidth=1.0)
    fourth.set_title("deep groove: alpha over the torque")
    for axes in (first, second, third, fourth):
        axes.grid(visible=True, alpha=0.3)
        axes.legend(fontsize="small", loc="upper center" if axes is third else "best")
        if axes is not third:
            axes.set(xlabel="frequency, Hz", ylabel="alpha")
    path.parent.mkdir(exist_ok=True)
    figure.savefig(path, dpi=110)
    print("wrote", path)


if __name__ == "__main__":
    main()
