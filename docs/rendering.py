"""Sphinx extension: pages that need no network, formulas as MathML, and the command line's own help."""

import re
import tempfile
import zlib
from functools import cache
from pathlib import Path
from typing import Any

import click
from docutils import nodes
from docutils.parsers.rst import Directive
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.errors import ExtensionError

from docs import reference
from wearlaw.cli import main
from wearlaw.contact.conditions import declared

PAGES = cache(reference.pages)

LOADED = re.compile(r'<(?:script|img|link|iframe)\b[^>]*\b(?:src|href)="(?:https?:)?//[^"]*"')
"""Addresses that a browser loads by itself, unlike the target of a link."""


OTHERS = {
    "numpy": ("https://numpy.org/doc/stable/", "reference/generated/{0}.html#{0}", ("numpy.ndarray",)),
    "pandas": ("https://pandas.pydata.org/docs/", "reference/api/{0}.html#{0}", ("pandas.DataFrame",)),
    "pint": ("https://pint.readthedocs.io/en/stable/", "api/base.html#{0}", ("pint.Quantity",)),
    "pydantic": ("https://docs.pydantic.dev/latest/", "api/base_model/#{0}", ("pydantic.BaseModel",)),
    "xarray": (
        "https://docs.xarray.dev/en/stable/", "generated/{0}.html#{0}", ("xarray.DataArray", "xarray.Dataset")
    ),
}  # fmt: skip
"""Documentation of other packages: its address, that of a page there, and the names that pages of wearlaw link to."""


def inventories() -> dict[str, tuple[str, str]]:
    """Return the packages for intersphinx, with inventories of the names above, so that a build needs no network."""
    folder, mapping = Path(tempfile.mkdtemp()), {}
    for package, (address, page, names) in OTHERS.items():
        lines = "".join(f"{name} py:class 1 {page.format(name)} -\n" for name in names)
        head = f"# Sphinx inventory version 2\n# Project: {package}\n# Version: \n# The rest is compressed with zlib.\n"
        (folder / package).write_bytes(head.encode() + zlib.compress(lines.encode()))
        mapping[package] = (address, str(folder / package))
    return mapping


def mathml(translator: Any, node: nodes.math | nodes.math_block) -> None:
    """Write a formula as MathML, which browsers draw themselves; Sphinx would load MathJax from the network."""
    block = isinstance(node, nodes.math_block)
    formula = tex2mathml(node.astext(), as_block=block)
    translator.body.append(f'<div class="formula">{formula}</div>' if block else formula)
    raise nodes.SkipNode


class CommandLine(Directive):
    """A section for each command, with the output of its --help."""

    def run(self) -> list[nodes.Node]:
        program = click.Context(main, info_name="wearlaw")
        commands = {name: main.get_command(program, name) for name in main.list_commands(program)}
        return [self._section(click.Context(command, program, name)) for name, command in commands.items()]

    def _section(self, command: click.Context) -> nodes.section:
        name, text = command.command_path, command.get_help()
        title = nodes.title(name, "", nodes.literal(name, name))
        return nodes.section("", title, nodes.literal_block(text, text, language="text"), ids=[nodes.make_id(name)])


def check_offline(app: Any, exception: Exception | None) -> None:
    """Raise an error for pages that would look different without a network."""
    loaded = {found for page in Path(app.outdir).rglob("*.html") for found in LOADED.findall(page.read_text("utf-8"))}
    if loaded and exception is None:
        raise ExtensionError(f"pages need the network: {', '.join(sorted(loaded))}")


def list_conditions(_: Any, what: str, name: str, method: Any, __: Any, lines: list[str]) -> None:
    """List the conditions of a rig below the docstring of its `problem`."""
    if what == "method" and name.endswith(".problem"):
        of_table = [one for one in declared(method).values() if one.table is not None]
        lines += [f":param {one.name}: {' '.join(one.meaning.split())}" for one in of_table]


def write_reference(_: Any, page: str, source: list[str]) -> None:
    """Put the entries of public names into the pages of the reference."""
    if page.startswith("reference/"):
        source[0] = source[0].replace(reference.MARK, PAGES()[page.removeprefix("reference/")])


def setup(app: Any) -> dict[str, bool]:
    app.add_html_math_renderer("mathml", inline_renderers=(mathml, None), block_renderers=(mathml, None))
    app.add_directive("command-line", CommandLine)
    app.connect("build-finished", check_offline)
    app.setup_extension("sphinx.ext.autodoc")
    app.connect("source-read", write_reference)
    app.connect("autodoc-process-docstring", list_conditions, priority=600)  # after napoleon
    return {"parallel_read_safe": True, "parallel_write_safe": True}
