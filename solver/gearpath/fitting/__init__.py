"""Fits of measured mobilities: few real modes, passive by construction."""

from .fit import fit_mobility, fit_modes
from .quantity import QUANTITIES, as_mobility
from .record import DataCheck, ModalFit, Place

__all__ = ["QUANTITIES", "DataCheck", "ModalFit", "Place", "as_mobility", "fit_mobility", "fit_modes"]
