"""`python -m gearpath`: the command line."""

from .cli import main

main()
