"""Labelled results of the solver: power flow and frequency responses as xarray objects."""
