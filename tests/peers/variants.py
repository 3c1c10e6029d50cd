"""What of MuJoCo is varied in every scene, and how a table is printed. `pip install mujoco numpy`."""
import platform
import sys

import mujoco

ELLIPTIC = mujoco.mjtCone.mjCONE_ELLIPTIC

# name -> changes of mjOption; "solref" acts on every geom.
VARIANTS = {
    "default (pyramidal)": {},
    "elliptic": {"cone": ELLIPTIC},
    "elliptic, impratio 10": {"cone": ELLIPTIC, "impratio": 10},
    "elliptic, impratio 100": {"cone": ELLIPTIC, "impratio": 100},
    "elliptic, noslip 10": {"cone": ELLIPTIC, "noslip_iterations": 10},
    "elliptic, impratio 10, noslip 10": {"cone": ELLIPTIC, "impratio": 10, "noslip_iterations": 10},
    "elliptic, impratio 10, solref 2 ms": {"cone": ELLIPTIC, "impratio": 10, "solref": (0.002, 1.0)},
}


def build(xml, changes):
    """A model of the text with a variant's changes, and its data."""
    model = mujoco.MjModel.from_xml_string(xml)
    for name, value in changes.items():
        if name == "solref":
            model.geom_solref[:] = value
        else:
            setattr(model.opt, name, value)
    return model, mujoco.MjData(model)


def show(title, header, rows):
    """Prints a table and writes it beside the script as .txt."""
    widths = [max(len(str(row[i])) for row in [header, *rows]) for i in range(len(header))]
    lines = [title, f"MuJoCo {mujoco.__version__}, Python {platform.python_version()}", ""]
    for row in [header, ["-" * w for w in widths], *rows]:
        lines.append("  ".join(str(cell).ljust(w) for cell, w in zip(row, widths)).rstrip())
    text = "\n".join(lines) + "\n"
    print(text)
    with open(sys.argv[0].removesuffix(".py") + ".txt", "w", encoding="utf-8") as file:
        file.write(text)
