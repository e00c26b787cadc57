"""Linear elastic, isotropic material."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Material:
    """Young's modulus (Pa), Poisson's ratio and density (kg/m^3)."""

    youngs_modulus: float
    poisson_ratio: float
    density: float

    @property
    def shear_modulus(self) -> float:
        """G = E / (2 (1 + nu)), Pa."""
        return self.youngs_modulus / (2.0 * (1.0 + self.poisson_ratio))
