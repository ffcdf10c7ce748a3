"""Print docs/api.md, the reference of the Python package, from its docstrings."""

from __future__ import annotations

import importlib
import inspect
import re

PAGES = [
    ("petves.simulation", "Simulation", "Simulate"),
    ("petves.dataset", "load", "Read"),
    ("petves.run", "Run", ""),
    ("petves.quantities", "vorticity", "Quantities"),
    ("petves.quantities", "stream_function", ""),
    ("petves.quantities", "wall_shear_stress", ""),
    ("petves.quantities", "total_pressure", ""),
    ("petves.quantities", "probe", ""),
    ("petves.quantities", "line", ""),
    ("petves.views.plot", "plot_run", "Draw, film, report"),
    ("petves.views.figures", "Look", ""),
    ("petves.views.movie", "movie", ""),
    ("petves.views.watch", "watch", ""),
    ("petves.views.report", "report", ""),
    ("petves.views.compare", "compare", "Compare, sweep"),
    ("petves.sweeps", "sweep", ""),
    ("petves.laboratory", "numbers", "Laboratory"),
    ("petves.rheology", "stresslets", "Suspensions"),
    ("petves.rheology", "velocity_profile", ""),
    ("petves.rheology", "area_fraction_profile", ""),
    ("petves.rheology", "centers", ""),
    ("petves.rheology", "mean_square_displacement", ""),
    ("petves.measures", "turned_angle", "Tumbling"),
    ("petves.measures", "half_periods", ""),
    ("petves.theory", "keller_skalak_angle", "Theory"),
    ("petves.theory", "ellipse_axes", ""),
    ("petves.errors", "Error", "Errors"),
    ("petves.run", "RunError", ""),
]
HEAD = """# Python reference

Made from the docstrings by `python/make_api.py`. docs/tutorial.ipynb shows the package at work, python/examples has
scripts, and [options.md](options.md) the options.
"""


def signature(thing: object) -> str:
    """Return a callable's parameters as Python code, without types of the result."""
    text = str(inspect.signature(thing).replace(return_annotation=inspect.Signature.empty))
    return (
        re.sub(r"'([^']*)'", r"\1", re.sub(r": '([^']*)'", r": \1", text))
        .replace("(self, ", "(")
        .replace("(self)", "()")
    )


def body(text: str) -> str:
    """Return a docstring as Markdown: NumPy's sections as bold words, parameters as a list."""
    lines, result, section = inspect.cleandoc(text).splitlines(), [], ""
    k = 0
    while k < len(lines):
        if k + 1 < len(lines) and re.fullmatch(r"-{3,}", lines[k + 1]):
            section = lines[k]
            result += [f"**{section}**", ""]
            k += 2
            continue
        line = lines[k]
        if section in ("Parameters", "Attributes", "Returns", "Raises", "Yields") and line and not line.startswith(" "):
            name, _, kind = line.partition(" : ")
            result.append(f"- `{name}`" + (f" ({kind})" if kind else ""))
        elif section == "Examples":
            result.append("    " + line if line else "")
        else:
            result.append("  " + line.strip() if section and line else line)
        k += 1
    return "\n".join(result).strip()


def members(cls: type) -> list[tuple[str, object]]:
    """Return public methods and properties in the order in which they are written, those of base classes last."""
    seen: dict[str, object] = {}
    for owner in cls.__mro__[:-1]:
        if not owner.__module__.startswith("petves"):
            continue
        for name, value in vars(owner).items():
            known = isinstance(value, (property, classmethod)) or inspect.isfunction(value)
            if not name.startswith("_") and known:
                seen.setdefault(name, value)
    return list(seen.items())


def describe(module: str, name: str) -> list[str]:
    """Return the lines about one public name."""
    thing = getattr(importlib.import_module(module), name)
    public = name if hasattr(importlib.import_module("petves"), name) else f"{module}.{name}"
    public = f"petves.{name}" if public == name and name in importlib.import_module("petves").__all__ else public
    if inspect.isclass(thing) and issubclass(thing, Exception):
        return [f"### {public}", "", body(thing.__doc__), ""]
    lines = [f"### {public}", "", f"    {public}{signature(thing)}", "", body(thing.__doc__), ""]
    for member, value in members(thing) if inspect.isclass(thing) else []:
        if isinstance(value, property):
            lines += [f"#### {member}", "", body(value.fget.__doc__), ""]
        else:
            function = value.__func__ if isinstance(value, classmethod) else value
            call = signature(function).replace("(cls, ", "(").replace("(cls)", "()")
            lines += [f"#### {member}{call}", "", body(function.__doc__), ""]
    return lines


def main() -> None:
    """Print the reference."""
    lines = [HEAD]
    for module, name, heading in PAGES:
        if heading:
            lines += [f"## {heading}", ""]
        lines += describe(module, name)
    print("\n".join(lines).rstrip())


if __name__ == "__main__":
    main()
