#!/usr/bin/env python3
"""Main job: a model file becomes FMUs of both kinds, their validation and a report.

python build_fmu.py models/gearbox.toml                      everything, into build/gearbox/
python build_fmu.py models/gearbox.toml -o gearbox.fmu       one FMU
python build_fmu.py --help                                   all options
"""

import sys

if sys.version_info < (3, 11):  # noqa: UP036 - run by hand, by any Python
    sys.exit("Gearpath needs Python 3.11 or newer; this is " + sys.version.split()[0])

try:
    import typer

    from gearpath import cli, console
except ImportError as missing:
    print(
        f"error: {missing}; use the Python that Gearpath is installed in, see README.md (.venv/bin/python)",
        file=sys.stderr,
    )
    sys.exit(2)


def main() -> None:
    """Run `gearpath build` under this script's own name."""
    with console.mistakes_explained():
        app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)
        app.command()(cli.build)
        app()


if __name__ == "__main__":
    main()
