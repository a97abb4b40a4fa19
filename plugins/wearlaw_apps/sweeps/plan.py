"""How a sweep is divided: blocks by the time that its points take, and other processes where they are worth it."""

from __future__ import annotations

import math
import time
from collections import Counter

from wearlaw_apps.sweeps.evaluation import Job, evaluate
from wearlaw_apps.sweeps.points import Points, rectangle

START_S = 1.5
"""Time that a sweep must save to be worth other processes [s]: they need about one second to start.

Where other programs take the processors, a start takes as many times longer as the sample of points does. 3.4 s were
measured where a sample took 2.1 times its processor time.
"""

BUSIEST = 8.0
"""Most that a start is lengthened by, since a model that waits for another program takes hardly any processor time."""

SENT_S = 1.5e-8
"""Time that a number takes from another process into the result [s], as measured."""

BLOCK_S = 1.0
"""Time that a block takes [s], as far as its size lies within the bounds."""

EACH = 4
"""Blocks for each of several processes, so that all end at about the same time."""

LARGEST = 2_000_000
"""Most operating points in a block, a file of 16 MB for each output; of a table most numbers in its rows."""

SAMPLE_S = 0.01
"""Least time of a sample of points that tells the time of all [s]; the samples take some 0.1 s in all."""

FIRST = 100
"""Most points of the first sample."""


def planned(job: Job, points: Points, workers: int, stored: bool) -> tuple[Points, bool]:
    """Return the points in blocks for a sweep, and whether it is worth other processes.

    Parameters
    ----------
    job : Job
    points : Points
    workers : int
        Number of processes that may evaluate the blocks.
    stored : bool
        Whether each block becomes a file.
    """
    if points.size <= points.room or not (stored or workers > 1):
        return points, False
    pace, busy = seconds_per_point(job, points)
    sent = 0.0 if stored or job.summed else SENT_S * points.size * points.weight * len(job.units)
    several = workers > 1 and pace * points.size * (1.0 - 1.0 / workers) > START_S * busy + sent
    if job.summed or not (stored or several):
        return points, several
    columns = max(Counter(column.dim for column in points.coordinates().values()).values(), default=1)
    room = min(BLOCK_S / pace, LARGEST / points.weight / columns)
    return points.divided_by(min(room, points.size / (EACH * workers)) if several else room), several


def seconds_per_point(job: Job, points: Points) -> tuple[float, float]:
    """Return the time of an operating point [s] and, from 1 on, that over its processor time, at the first points."""
    count = max(min(FIRST, points.size // FIRST), 1)
    while True:
        block = rectangle(points.shape, count)
        part = points.part(slice(0, length) for length in block)
        took, worked = min(_time(job, part) for _ in range(2))  # the first time may load kernels
        if took > SAMPLE_S or count >= min(points.size, points.room):
            busy = took / worked if worked > 0.0 else BUSIEST
            return took / math.prod(block), min(max(busy, 1.0), BUSIEST)
        count = min(math.ceil(count * min(10.0, 2.0 * SAMPLE_S / took)), points.room)


def _time(job: Job, part: Points) -> tuple[float, float]:
    """Return the time that some points take, and the processor time in it [s]."""
    start, worked = time.perf_counter(), time.process_time()
    evaluate(job, part)
    return time.perf_counter() - start, time.process_time() - worked
