"""A command from outside."""

import click

import wearlaw as wl


@click.command()
@click.argument("mass")
def weigh(mass: str) -> None:
    """Print the weight of a MASS, such as "20 kg"."""
    click.echo(f"{wl.parse(mass).m_as('kg') * 9.81:.1f} N")
