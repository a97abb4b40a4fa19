"""Reading contacts that other programs have solved, by the readers of plugins."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Sequence
from glob import escape
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from wearlaw import loader
from wearlaw.arrays import Array
from wearlaw.contact.contact import TOTALS, Contact
from wearlaw.contact.parts import Body, Strips
from wearlaw.contact.problem import ARRAYS, Problem
from wearlaw.errors import DataError, InputError, ModelError, UnknownModelError, did_you_mean, shown
from wearlaw.models.model import CONDITIONS, Blame, fault
from wearlaw.models.reader import Reader, Solved, flat
from wearlaw.numerics.solving import Solver

File: TypeAlias = str | os.PathLike[str]
"""The path of a file."""

HEAD = 4096
"""Bytes by which a reader recognises a file."""


def read_contact(paths: File | Sequence[File], /, *, reader: str | Reader | None = None, **options: Any) -> Contact:
    """Return the contact that another program has solved and written to a file, or a batch of contacts.

    `Prediction.of` predicts the wear of the contact.

    Parameters
    ----------
    paths : str, path, or sequence of these
        The file of one contact. Several files make a batch in their order, padded with nodes of no area to the most
        nodes of a file; their bodies must be of the same materials.
    reader : str or Reader, optional
        Name of the reader, such as "contact_mat"; ``installed("reader")`` lists all. By default it is the one that
        recognises the file. Or a reader itself.
    **options
        The reader's fields, for what the file does not hold; ``wearlaw show NAME`` lists them. And conditions that laws
        declare, such as ``relative_humidity="40 %"``, each one value or one for each file.

    Raises
    ------
    DataError
        If a file is missing or no reader recognises it.
    UnknownModelError
        If there is no such reader, or several readers recognise a file.
    InputError
        If the content of a file is wrong, or the contacts cannot be in one batch.
    ModelError
        If the reader fails, or returns a contact with impossible values.
    """
    loader.discovered()  # so that the conditions of installed laws are known
    conditions = {name: value for name, value in options.items() if name in CONDITIONS}
    fields = {name: value for name, value in options.items() if name not in conditions}
    if isinstance(paths, str | os.PathLike):
        contact = _read(Path(paths), reader, fields)
        return contact.at(**conditions)
    files = [Path(path) for path in paths]
    if not files:
        raise InputError("paths: give at least one file")
    return _stacked(files, [_read(path, reader, fields) for path in files]).at(**conditions)


def _read(path: Path, chosen: str | Reader | None, options: dict[str, Any]) -> Contact:
    """Return the contact in a file, checked."""
    head = _head(path)
    if isinstance(chosen, Reader):
        reader: Reader = chosen.model_copy(update=options) if options else chosen
    else:
        kind = _recognised(path, head) if chosen is None else loader.discovered().find("reader", chosen)
        reader = kind(**options)
    with Blame(reader):
        contact = reader.read(path)
    if not isinstance(contact, Contact) or contact.problem is None:
        raise fault(reader, f"returned {shown(contact)}, not a wearlaw.Contact with its problem")
    model = Solved(contact=flat(contact, contact.problem), read_by=reader)
    try:
        Solver(model).check(model.contact, model.contact.problem, totals=True)
    except ModelError as error:
        raise ModelError(f"{shown(path)}: {error}") from None
    return contact


def _head(path: Path) -> bytes:
    """Return the first bytes of a file."""
    try:
        with path.open("rb") as file:
            return file.read(HEAD)
    except FileNotFoundError:
        beside = sorted(entry.name for entry in path.parent.glob(f"[!.]*{escape(path.suffix)}"))
        raise DataError(f"there is no file {shown(path)}{did_you_mean(path.name, beside)}") from None
    except OSError as error:
        raise DataError(f"cannot read {shown(path)}: {error.strerror}") from None


def _recognised(path: Path, head: bytes) -> type[Reader]:
    """Return the one reader for the ending and the content of a file."""
    every: dict[str, list[tuple[type[Reader], Any]]] = loader.discovered()["reader"].providers
    candidates = [
        (reader, f"{shown(name)} of {origin}")
        for name, providers in every.items()
        for reader, origin in providers
        if path.suffix.lower() in reader.suffixes
    ]
    if not candidates:
        endings = sorted(
            {suffix for providers in every.values() for reader, _ in providers for suffix in reader.suffixes}
        )
        raise DataError(
            f"cannot read {shown(path)}: no reader reads files that end in {shown(path.suffix)}; those of the"
            f" installed readers end in {', '.join(endings)}. If it is a file of theirs, name the reader, as in"
            " read_contact(path, reader=...)"
        )
    if len(candidates) == 1:
        return candidates[0][0]  # whose error says what is wrong with the content
    fitting = [(reader, name) for reader, name in candidates if reader.recognises(head)]
    if len(fitting) == 1:
        return fitting[0][0]
    names = " and ".join(name for _, name in fitting or candidates)
    which = "several readers recognise it" if fitting else "none of the readers for its ending recognises it"
    raise UnknownModelError(
        f"cannot read {shown(path)}: {which}, {names}; name one, as in read_contact(path, reader=...)"
    )


def _stacked(paths: Sequence[Path], contacts: Sequence[Contact]) -> Contact:
    """Return contacts of one operating point each as a batch."""
    problems = [_single(path, contact) for path, contact in zip(paths, contacts, strict=True)]
    first = problems[0]
    for path, problem in zip(paths, problems, strict=True):
        if problem.geometry != first.geometry or (problem.strips is None) != (first.strips is None):
            raise InputError(
                f"{shown(path)}: is of geometry '{problem.geometry}', but {shown(paths[0])} is of '{first.geometry}'"
            )
        _check_bodies(path, problem, paths[0], first)
    problem = _stacked_problem(problems)
    nodes = tuple(np.max([contact.pressure.shape for contact in contacts], axis=0).tolist())
    fields: dict[str, Any] = {name: np.array([getattr(contact, name) for contact in contacts]) for name in TOTALS}
    for name in ("pressure", "traction", "slip", "traction_bound", "area", "x", *COMPONENTS):
        fields[name] = np.array([_padded(getattr(contact, name), nodes) for contact in contacts])
    if not contacts[0].on_strips:
        return Contact(**{name: value for name, value in fields.items() if name not in COMPONENTS}, problem=problem)
    for name, shape in (("y", nodes), ("strip_width", nodes[1:])):
        fields[name] = np.array([_padded(getattr(contact, name), shape) for contact in contacts])
    return Contact(**fields, problem=problem)


COMPONENTS = ("traction_x", "traction_y", "slip_x", "slip_y")


def _single(path: Path, contact: Contact) -> Problem:
    problem = contact.problem
    if problem is None or problem.batch_shape:
        raise InputError(f"{shown(path)}: holds several operating points; read it alone")
    return problem


def _check_bodies(path: Path, problem: Problem, first_path: Path, first: Problem) -> None:
    """Raise an error unless the bodies of two problems are of the same materials and both roll or both do not."""
    materials, others = (
        {name: body.material for name, body in bodies.items()} for bodies in (problem.bodies, first.bodies)
    )
    if materials != others:
        raise InputError(
            f"{shown(path)}: its bodies are of other materials than those of {shown(first_path)}, {materials} and not"
            f" {others}; read these files apart"
        )
    for name, body in problem.bodies.items():
        if np.isinf(body.rolling_radius) != np.isinf(first.bodies[name].rolling_radius):
            without, with_radius = (path, first_path) if np.isinf(body.rolling_radius) else (first_path, path)
            raise InputError(
                f"{shown(without)}: has no radius of {shown(name)}, but {shown(with_radius)} has one; give the radius"
                " in the options of the reader, or read these files apart"
            )


def _stacked_problem(problems: Sequence[Problem]) -> Problem:
    fields: dict[str, Any] = {}
    for name in ARRAYS:
        values = [getattr(problem, name) for problem in problems]
        some = any(value is not None for value in values)
        fields[name] = np.array([0.0 if value is None else value for value in values]) if some else None
    strips = [problem.strips for problem in problems if problem.strips is not None]
    if strips:
        count = (max(strip.y.size for strip in strips),)
        names = ("y", "width", "half_length", "max_pressure")
        fields["strips"] = Strips(
            **{name: np.array([_padded(getattr(strip, name), count) for strip in strips]) for name in names}
        )
    bodies = {name: _stacked_body([problem.bodies[name] for problem in problems]) for name in problems[0].bodies}
    return problems[0].replaced(**fields, bodies=bodies)


def _stacked_body(bodies: Sequence[Body]) -> Body:
    fields: dict[str, Any] = {"rolling_radius": np.array([float(body.rolling_radius) for body in bodies])}
    if all(body.profile_position is not None for body in bodies):
        for name in ("profile_position", "profile_direction"):
            fields[name] = np.array([float(getattr(body, name)) for body in bodies])
    else:
        fields["profile_position"] = None
    return dataclasses.replace(bodies[0], **fields)


def _padded(values: Array, shape: tuple[int, ...]) -> Array:
    """Return an array of a larger shape, with zeros after its own values, as strips that fill up a batch have."""
    return np.pad(values, [(0, whole - size) for whole, size in zip(shape, values.shape, strict=True)])
