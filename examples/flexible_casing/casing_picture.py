"""Transmitted power and alpha over frequency, with the flexible and the rigid casing; modes of the casing."""

from pathlib import Path

import numpy as np
import xarray as xr
from casing_matrices import Casing
from matplotlib import colormaps
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

ORDERS = ((0, 1, 2, 3), (0, 1, 3, 2), (0, 2, 1, 3))  # in which four corners may follow one another
SWING = 0.03  # m, largest displacement that is drawn


def draw(path: Path, flows: dict[str, xr.Dataset], casing: Casing, frequencies: np.ndarray, shapes: np.ndarray) -> None:
    """Curves above, three modes of the free casing below, coloured by displacement."""
    figure = Figure(figsize=(11, 11), layout="constrained")
    grid = figure.add_gridspec(3, 3, height_ratios=(3, 2, 4))
    power, alpha = figure.add_subplot(grid[0, :]), figure.add_subplot(grid[1, :])
    for name, flow in flows.items():
        level = 10.0 * np.log10(np.maximum(flow.transmitted_power, 1e-15) / 1e-12)
        power.plot(flow.frequency, level, lw=1, label=name)
        alpha.plot(flow.frequency, flow.alpha, lw=1, label=name)
    power.set(ylabel="power into the casing, dB re 1 pW", title="1 um transmission error")
    alpha.set(ylabel="alpha", xlabel="frequency, Hz", ylim=(0.0, 1.0))
    for panel in (power, alpha):
        panel.grid(visible=True, alpha=0.3)
        panel.legend()
    for k in range(3):
        panel = figure.add_subplot(grid[2, k], projection="3d")
        draw_mode(panel, casing, shapes[:, k])
        panel.set_title(f"{frequencies[k]:.0f} Hz, casing alone")
    figure.savefig(path, dpi=110)
    print("wrote", path)


def draw_mode(panel: object, casing: Casing, shape: np.ndarray) -> None:
    """The faces of the mesh, moved; the x axis to the right, y up."""
    corners = casing.mesh.p.shape[1]
    motion = (casing.T @ shape).reshape(-1, 3)[:corners]
    motion *= SWING / np.linalg.norm(motion, axis=1).max()
    faces = outline(casing)
    places = (casing.mesh.p.T + motion)[faces][:, :, [0, 2, 1]]
    colour = colormaps["viridis"](np.linalg.norm(motion, axis=1)[faces].mean(axis=1) / SWING)
    panel.add_collection3d(Poly3DCollection(places, facecolors=colour, edgecolors="k", linewidths=0.15))
    low, high = places.min(axis=(0, 1)), places.max(axis=(0, 1))
    panel.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    panel.set_box_aspect(high - low)
    panel.view_init(elev=25, azim=-60)
    panel.set_axis_off()


def outline(casing: Casing) -> np.ndarray:
    """Corners (F, 4) of the outer faces, one after another round each: in the order with the shortest way."""
    faces = casing.mesh.facets[:, casing.mesh.boundary_facets()].T
    ways = np.array([faces[:, order] for order in ORDERS])
    places = casing.mesh.p.T[ways]
    lengths = np.linalg.norm(np.roll(places, -1, axis=2) - places, axis=3).sum(axis=2)
    return ways[lengths.argmin(axis=0), np.arange(len(faces))]
