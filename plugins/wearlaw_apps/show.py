"""The commands `plugins` and `show`."""

from __future__ import annotations

import inspect
import json
import re
import textwrap
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Any, TypeGuard

import click
import pint
from click.shell_completion import CompletionItem

from wearlaw import loader
from wearlaw.configuration import Configuration, field_docstrings
from wearlaw.contact.conditions import Condition, of_table
from wearlaw.contact.material import Material
from wearlaw.contact.problem import PATCHES
from wearlaw.errors import InputError, PluginWarning, UnknownModelError
from wearlaw.fields import is_law_file, read_law
from wearlaw.hookspecs import Command
from wearlaw.late import load
from wearlaw.loader import Preset
from wearlaw.models.contact_model import ContactModel, Stage
from wearlaw.models.law import WEAR, Law
from wearlaw.models.model import Model
from wearlaw.models.reader import Reader
from wearlaw.pipeline.pipeline import Rig
from wearlaw.units.quantities import Q, from_si, text_of
from wearlaw.units.registry import symbol
from wearlaw.units.variables import UNITS

LAWS = ("wear law", "law", "parameter set")
"""Kinds of plugins that a law is named by."""


def completed(*kinds: str, listed: bool = False) -> Callable[..., list[CompletionItem]]:
    """Return what completes the names of some kinds of plugins in a shell, or paths; `listed` ones after a comma."""

    def complete(_: click.Context, __: click.Parameter, begun: str) -> list[CompletionItem]:
        before, comma, last = begun.rpartition(",") if listed else ("", "", begun)
        plugins = loader.discovered()
        names = {name for kind in kinds or plugins.shelves for name in plugins[kind].items() if name.startswith(last)}
        items = [CompletionItem(f"{before}{comma}{name}") for name in sorted(names)]
        return items or [CompletionItem(begun, type="file")]

    return complete


EXAMPLE = "example:"
"""The heading of code."""

DEEPER = 6
"""Spaces by which the fields of a table within a field are indented."""


@click.command("plugins")
def list_plugins() -> None:
    """List what the installed plugins provide, by kind and name, and the plugins that failed to load."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PluginWarning)  # the listing below names what is left out
        plugins = loader.discovered()
    rows = [("kind", "name", "distribution", "version")]
    rows += [
        (kind, name, origin.distribution, origin.version)
        for kind, shelf in plugins.shelves.items()
        for name, provided in sorted(shelf.providers.items())
        for _, origin in provided
    ]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        click.echo("  ".join(f"{cell:{width}}" for cell, width in zip(row, widths, strict=True)).rstrip())
    for plugin in plugins.broken:
        click.echo(f"left out: {plugin}", err=True)


@click.command()
@click.argument("name", shell_complete=completed())
@click.option("--markdown", is_flag=True, help="Write Markdown, such as for a README.")
def show(name: str, markdown: bool) -> None:
    """Explain anything that `wearlaw plugins` lists, by its name, or a law by its file, such as fit/law.toml.

    A model shows its fields with units and defaults, its source, and what it declares; a material its values; a case
    its title; a test set its source and columns; a section the cases that have it.
    """
    text = explain(name)
    click.echo(in_markdown(text) if markdown else text)


def in_markdown(text: str) -> str:
    """Return a description as Markdown: headings, a list item for each field, and the example as code."""
    lines: list[str] = []
    section = ""
    for line in text.splitlines():
        bare = line.strip()
        level, within = divmod(len(line) - len(bare) - 2, DEEPER)
        if re.fullmatch("[a-z ]+:", line):
            section = line
            lines += [f"## {line[:1].upper()}{line[1:-1]}", "", *(["```python"] if section == EXAMPLE else [])]
        elif head := re.fullmatch(r"(\S+): (an? .* of .*)", line):
            section = ""
            lines += [f"# {head[1]}", "", f"{head[2][:1].upper()}{head[2][1:]}."]
        elif section == EXAMPLE:
            lines.append(line[2:])
        elif section and bare and within == 0:
            of_name = re.match(r"\w+( \[.*?\])?( = .*| \(must be given\))?$", bare)
            lines.append(f"{'  ' * level}- {f'`{bare}`' if of_name else bare}")
        else:
            lines.append(f"{'  ' * (level + 1)}{bare}" if section else line)
    return "\n".join([*lines, *(["```"] if section == EXAMPLE else [])])


def explain(name: str) -> str:
    """Return the descriptions of everything with a name, separated by blank lines, or of the law in a file.

    Raises
    ------
    InputError
        If the file cannot be read.
    UnknownModelError
        If there is nothing of that name, or two distributions provide a thing of one kind.
    """
    if is_law_file(name):
        law = read_law(name)
        return describe(type(law), f"{name}: parameters for", law)
    plugins = loader.discovered()
    kinds = [kind for kind, shelf in plugins.shelves.items() if name in shelf]
    if not kinds:
        names = dict.fromkeys(entry for shelf in plugins.shelves.values() for entry in shelf.items())
        raise UnknownModelError(plugins.unknown("model, material, case, test set or section", name, names))
    return "\n\n".join(_explained(kind, name, plugins.find(kind, name)) for kind in kinds)


def _explained(kind: str, name: str, item: Any) -> str:
    plugins = loader.discovered()
    head = f"{name}: a {kind} of {plugins[kind].origin(name)}"
    if kind == "parameter set":
        return describe(type(item), f"{head}, for", item)
    if kind in loader.MODELS:
        return describe(item)
    tell = _TELL.get(kind)
    if tell is None:
        module, _, function = plugins.explanations[kind].partition(":")
        tell = load(module, function, f"wearlaw show {name}")
    return "\n".join([head, "", *tell(name, item)])


def _material(name: str, material: Material) -> Iterator[str]:
    yield (inspect.getdoc(type(material)) or "").partition("\n\n")[0]  # the rest is for authors of classes
    yield from ("", "fields:", *fields_of(type(material), material))
    yield from ("", f'In a case: material = "{name}". In Python: wl.material("{name}").')


def _material_type(name: str, cls: type[Material]) -> Iterator[str]:
    yield inspect.getdoc(cls) or ""
    yield from ("", "fields:", *fields_of(cls, None))
    yield from ("", f'In a case: material = {{type = "{name}", ...}} with these fields.')


def _preset(name: str, preset: Preset) -> Iterator[str]:
    yield inspect.getdoc(preset.make) or ""
    yield from ("", f'In a case: rig = {{preset = "{name}"}}, beside what overrides its values.')


def _command(name: str, command: Command) -> Iterator[str]:
    yield command.help
    yield from ("", f"wearlaw {name} --help lists its options.")


_TELL: dict[str, Callable[[str, Any], Iterator[str]]] = {
    "preset": _preset,
    "material": _material,
    "material type": _material_type,
    "command": _command,
}
"""What makes the lines of the kinds that are no models."""


def describe(model: type[Model], head: str | None = None, law: Law | None = None) -> str:
    """Return the description of a model: theory, source, fields with defaults, and declarations.

    With a law, such as a parameter set, the fields and declarations are its own, and the head says what it is.
    """
    default: Model | None = law
    if law is None:
        with suppress(InputError):  # some fields have no default
            default = model()
    headline = f"{model.name}: a {model.kind} of {loader.discovered()[model.kind].origin(model.name, model)}"
    lines = [*([head] if head else []), headline, "", inspect.getdoc(model) or ""]
    lines += [
        "",
        *wrapped("source: ", getattr(model, "source", "not stated")),
        "",
        "fields:",
        *fields_of(model, default),
    ]
    if isinstance(model.conditions, type):
        lines += ["", "conditions beside those of the rig:", *_conditions(of_table(model.conditions))]
    if issubclass(model, Rig):
        lines += ["", "conditions:", *_conditions(model.conditions(), model.choices), *_example(model)]
    declared = list(_declared(model, default))
    if declared:
        lines += ["", "declares:", *(f"  {text}" for text in declared)]
    return "\n".join(lines)


def fields_of(model: type[Configuration], default: Configuration | None) -> Iterator[str]:
    """Yield lines about each field of a model or material, with the values of `default`, or the class's own."""
    schema = model.model_json_schema(by_alias=False).get("properties", {})
    shown: dict[type, str] = {}
    for name, text in field_docstrings(model).items():
        yield f"  {name} {_value(model, default, name)}"
        if choices := _choices(schema[name]):
            yield f"      one of {', '.join(choices)}"
        yield from wrapped("      ", text)
        part = model.model_fields[name].annotation
        if not _is_table(part):
            continue
        if part in shown:
            yield f"      a table with the fields of {shown[part]}"
        else:
            shown[part] = name
            yield from ("      a table with these fields:", *(f"      {line}" for line in fields_of(part, None)))
    if not schema:
        yield "  none"


def _is_table(part: Any) -> TypeGuard[type[Configuration]]:
    """Return whether a field is a table of fields of its own in a file; models and materials have names too."""
    if not (isinstance(part, type) and issubclass(part, Configuration)) or issubclass(part, Model | Material):
        return False
    written: dict[str, Any] = part.model_json_schema(by_alias=False).get("properties", {})
    return field_docstrings(part).keys() <= written.keys()


def _conditions(conditions: Mapping[str, Condition], choices: Iterable[Sequence[str]] = ()) -> Iterator[str]:
    """Yield lines about each condition."""
    for name, condition in conditions.items():
        unit = condition.unit and (symbol(Q(1.0, condition.unit.unit).units, "~P") or "-")
        yield f"  {name}{f' [{unit}]' if unit else ''}{' (must be given)' if condition.required else ''}"
        yield from wrapped("      ", condition.meaning)
    yield from (f"  exactly one of {', '.join(names)} must be given" for names in choices)


def _example(rig: type[Rig]) -> Iterator[str]:
    """Yield lines of Python that predict the wear of the example."""
    if not rig.example:
        return
    yield from ("", "example:", "  import wearlaw as wl")
    yield from _call("rig = wl.rig", json.dumps(rig.name), *_keywords(rig.example_fields))
    fits = {"line": "exact", None: "fastsim"}  # which solves lines and ellipses
    model = fits.get(rig.patch_geometry, "strip_theory")
    yield f'  predict = rig | wl.contact_model("{model}") | wl.wear_law("kth")'
    yield from _call("predict", *_keywords(rig.example))


def _call(function: str, *arguments: str) -> Iterator[str]:
    line = f"  {function}({', '.join(arguments)})"
    if len(line) <= 100:
        yield line
    else:
        yield from (f"  {function}(", *(f"      {argument}," for argument in arguments), "  )")


def _keywords(values: Mapping[str, Any]) -> list[str]:
    """Return arguments as Python code, with quantities as text."""
    return [f"{name}={json.dumps(value, ensure_ascii=False, default=text_of)}" for name, value in values.items()]


def _value(model: type[Configuration], default: Configuration | None, name: str) -> str:
    """Return the default of a field, or that it must be given."""
    field = model.model_fields[name]
    if default is not None:
        return f"= {_shown(getattr(default, name))}"
    if field.is_required():
        return "(must be given)"
    value = field.get_default(call_default_factory=True)
    return f"= {value if field.validate_default else _shown(value)}"  # text to be validated is a quantity's


def _shown(value: Any) -> str:
    return text_of(value) if isinstance(value, pint.Quantity) else " ".join(repr(value).split())


def _choices(schema: Mapping[str, Any]) -> list[str]:
    """Return the words that a field accepts, from its JSON Schema."""
    options: list[Mapping[str, Any]] = [schema, *schema.get("anyOf", [])]
    return [repr(word) for option in options for word in option.get("enum", [])]


def _declared(model: type[Model], default: Model | None) -> Iterator[str]:
    """Yield the declarations of a model: those of its class, and those of the model with its defaults."""
    if issubclass(model, Reader):
        yield f"reads files that end in {', '.join(model.suffixes)}"
    elif issubclass(model, Stage):
        if model.alters_problem_only():
            yield "changes the problem before the contact model solves it, and leaves the solved contact as it is"
        else:
            yield "works around the contact model, and may change the solved contact"
        if model.gives_means:
            yield "gives the means of the whole patch, for laws stated for them"
    elif issubclass(model, Law) and model.outcome.name != WEAR:
        outcome = model.outcome
        of = "mean over the area of the patch" if outcome.of == "area mean" else "one value for the whole patch"
        unit = symbol(Q(1.0, outcome.unit).units, "~P") or "-"
        yield f"predicts: {outcome.name} [{unit}], {of}{', may be negative' if outcome.sign == 'any' else ''}"
        if outcome.meaning:
            yield f"  {outcome.meaning}{f', {outcome.symbol}' if outcome.symbol else ''}"
    if isinstance(default, Law):
        yield from _of_law(default)
    elif isinstance(default, ContactModel):
        yield "scale: the means of the patch" if default.scale == "patch" else "scale: the patch resolved into cells"
        if default.uses_measured_traction:
            yield "takes a measured traction_coefficient"
        yield from accuracies(default)
    elif default is None and issubclass(model, Law | ContactModel):
        yield "what depends on its fields"
    if default is not None:
        yield from (f"does not keep {claim}: {reason}" for claim, reason in default.exemptions.items())


def accuracies(model: ContactModel) -> Iterator[str]:
    """Yield the declared errors of sums over the nodes, by the shape of the patch; one node of means has none."""
    if model.scale == "cells":
        for geometry in model.geometries():
            error = model.accuracy if geometry == "line" else model.elliptic_accuracy
            yield f"accuracy of sums over {PATCHES[geometry]}: {error:.2g}"


def _of_law(law: Law) -> Iterator[str]:
    if law.body is not None:
        yield f"for one body: {law.body}"
    yield "scale: means of the whole patch only" if law.scale == "patch" else "scale: patch means or cells"
    if law.calibration is not None:
        yield f"fitted for: {law.calibration}; {law.calibration.materials}; {law.calibration.source}"
    if law.monotone_in:
        yield f"never falls with: {', '.join(law.monotone_in)}"
    breakpoints = law.breakpoints(law.numbers)
    if breakpoints is None:
        yield "branches: not declared"
    for variable, values in (breakpoints or {}).items():
        yield f"branches in {variable} at {', '.join(_level(law, variable, value) for value in values)}"
    for variable, values in law.jumps(law.numbers).items():
        yield f"jumps in {variable} at {', '.join(_level(law, variable, value) for value in values)}"
    for variable, (low, high) in law.valid_range.items():
        yield f"known range of mean {variable} from {_level(law, variable, low)} to {_level(law, variable, high)}"
    if law.band() is not None:
        yield "band: published parameter ranges give a low, a middle and a high law"


def _level(law: Law, variable: str, value: float) -> str:
    declared = law.variables.get(variable)
    return repr(from_si(value, declared.unit if declared else UNITS[variable]))


def wrapped(prefix: str, text: str) -> list[str]:
    """Return a text with a prefix, wrapped at 100 characters."""
    indent = " " * (len(prefix) if not prefix.strip() else 2)
    return textwrap.wrap(" ".join(text.split()), 100, initial_indent=prefix, subsequent_indent=indent)
