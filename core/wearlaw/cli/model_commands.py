"""Commands about models: list and explain them."""

from __future__ import annotations

import warnings

import click

from wearlaw.cli.explain import explain
from wearlaw.cli.shared import echo
from wearlaw.errors import PluginWarning
from wearlaw.plugins import loader


@click.command("plugins")
def list_plugins() -> None:
    """List what the installed plugins provide, by kind and name, and the plugins that failed to load."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PluginWarning)  # the listing below names what is left out
        found = loader.installed()
    rows = [("kind", "name", "distribution", "version")]
    rows += [(kind, name, origin.distribution, origin.version) for kind, name, origin in found.listing()]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        echo("  ".join(f"{cell:{width}}" for cell, width in zip(row, widths, strict=True)).rstrip())
    for plugin in found.broken:
        echo(f"left out: {plugin}", err=True)


@click.command()
@click.argument("name")
def show(name: str) -> None:
    """Explain anything that `wearlaw plugins` lists, by its name.

    A model shows its fields with units and defaults, its source, and what it declares; a material its values; a case
    its models and sweeps; a test set its source and columns; a section the cases that have it.
    """
    echo(explain(name))
