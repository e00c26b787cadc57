"""Plates and frames from their tables."""

from ..components import BarSection, Footprint, Frame, FrameBeam, Material, Plate, Section
from .structure_tables import BeamTable, FrameTable, PlateShape, PlateTable
from .train_tables import MaterialTable

Materials = dict[str, MaterialTable]


def build_plate(materials: Materials, table: PlateShape) -> Plate:
    """A plate whose material is known."""
    counts = table.elements if isinstance(table.elements, tuple) else (table.elements,) * 2
    return Plate(
        material=build_material(materials, table.material),
        centre=table.centre,
        lengths=table.lengths,
        thickness=table.thickness,
        elements=(counts[0], counts[1]),
        axes=(table.axis_1, table.axis_2),
        footprints={name: Footprint(item.centre, item.size) for name, item in table.footprints.items()},
        shear_coefficient=table.shear_coefficient,
        modal_damping=table.modal_damping if isinstance(table, PlateTable) else 0.0,
        loss_factor=table.loss_factor if isinstance(table, PlateTable) else 0.0,
    )


def build_frame(materials: Materials, table: FrameTable) -> Frame:
    """A frame whose materials are known."""
    return Frame(
        nodes=dict(table.nodes),
        beams={name: _beam(materials, beam) for name, beam in table.beams.items()},
        plates={name: build_plate(materials, plate) for name, plate in table.plates.items()},
        modal_damping=table.modal_damping,
        loss_factor=table.loss_factor,
    )


def build_material(materials: Materials, name: str) -> Material:
    """The material of that name."""
    return Material(**materials[name].model_dump())


def shear_coefficient_of(table: float | None, diameter: float, inner: float, poisson_ratio: float) -> float:
    """The given shear coefficient of a round bar, or Cowper's."""
    return Section(0.0, diameter, inner).cowper_coefficient(poisson_ratio) if table is None else table


def _beam(materials: Materials, table: BeamTable) -> FrameBeam:
    material = build_material(materials, table.material)
    kappa = shear_coefficient_of(table.shear_coefficient, table.diameter, table.inner_diameter, material.poisson_ratio)
    section = BarSection.round(table.diameter, table.inner_diameter)
    return FrameBeam(table.between, material, section, kappa, table.elements, beam=table.beam)
