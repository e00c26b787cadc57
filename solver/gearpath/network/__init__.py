"""Components and joints as a network: mobility synthesis, power flow, reference solution."""
