"""Reduced models of the whole network: few coordinates, joints still explicit, and a certificate of the error."""

from .certificate import Certificate, Comparison
from .choice import METHODS, Reduced, reduced_network

__all__ = ["METHODS", "Certificate", "Comparison", "Reduced", "reduced_network"]
