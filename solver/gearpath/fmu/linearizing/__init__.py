"""The steps of a linearisation: open the FMU, go to the operating point, differentiate there."""
