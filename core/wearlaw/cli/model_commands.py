"""Commands about models: list and explain them."""

from __future__ import annotations

import warnings

import click
from rich.console import Console
from rich.table import Table

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
    table = Table("kind", "name", "distribution", "version", box=None, pad_edge=False)
    for kind, name, origin in found.listing():
        table.add_row(kind, name, origin.distribution, origin.version)
    Console().print(table)
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
