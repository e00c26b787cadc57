"""What an FMU carries beside description, data and binaries: terminals, icons, reference results, a page to read."""

from collections.abc import Sequence

from .._version import __version__
from ..network.modal import ModalNetwork
from ..numerics.arrays import Real
from .description import Experiment
from .documentation import BAND
from .documentation import documentation as documentation_page
from .icon import icon_png, icon_svg, terminal_png
from .reference_files import reference_files
from .terminals import terminals_and_icons
from .variables import Variable

DEFAULT_EXPERIMENT = Experiment(0.0, 0.1, 1e-5)


def supplements(
    network: ModalNetwork,
    variables: Sequence[Variable],
    fmi: str = "2.0",
    *,
    description: str = "",
    version: str = __version__,
    experiment: Experiment = DEFAULT_EXPERIMENT,
    documentation: bool = True,
    reference: bool = True,
    band: tuple[float, float] = BAND,
    frequencies: Real | None = None,
) -> dict[str, bytes]:
    """All supplementary files by their path in the FMU; the same arguments give the same bytes.

    `variables` are those of the FMU for this version of FMI. `documentation` adds plots over the `band` (Hz; or at
    `frequencies`) and the modes of the assembly to the page; `reference` adds reference inputs and outputs.
    """
    page = documentation_page(
        network,
        variables,
        fmi=fmi,
        description=description,
        version=version,
        experiment=experiment,
        plots=documentation,
        reference=reference,
        band=band,
        frequencies=frequencies,
    )
    files = {
        "documentation/index.html": page,
        "terminalsAndIcons/terminalsAndIcons.xml": terminals_and_icons(network, variables),
        "terminalsAndIcons/icon.png": icon_png(),
        "terminalsAndIcons/icon.svg": icon_svg(),
        "terminalsAndIcons/joint.png": terminal_png("joint"),
        "terminalsAndIcons/excitation.png": terminal_png("excitation"),
    }
    if fmi == "2.0":
        files["model.png"] = icon_png()
    return {**files, **(reference_files(network, variables, experiment) if reference else {})}
