"""What a worker process does: it takes blocks from its standard input, and answers on its standard output."""

from __future__ import annotations

import functools
import os
import pickle
import signal
import sys
from collections.abc import Callable
from typing import BinaryIO

from wearlaw.errors import ModelError, described
from wearlaw.sweeping.evaluation import Job, Outputs, Seen, evaluate
from wearlaw.sweeping.points import Block, Points
from wearlaw.sweeping.store import write_block


def serve() -> None:
    """Evaluate blocks until there are no more; see `wearlaw.sweeping.processes` for who asks."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the process that asks decides what Ctrl-C ends
    tasks, answers = sys.stdin.buffer, os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a model prints must not come among the answers
    while True:
        try:
            task: bytes = pickle.load(tasks)
        except EOFError:
            return
        _answer(task, answers)


def _answer(task: bytes, answers: BinaryIO) -> None:
    try:
        job, block, part, store = pickle.loads(task)
        outputs, seen = evaluated(job_of(job), block, part, store)
    except BaseException as error:  # a model's SystemExit would end the worker, and Ctrl-C is not for it
        pickle.dump(_portable(error), answers)
    else:
        pickle.dump(seen, answers)
        for values in outputs.values():
            answers.write(values.data)
    answers.flush()


def evaluated(
    job: Job, block: Block, part: Points, store: str | None, on_block: Callable[[int], None] | None = None
) -> tuple[Outputs, Seen]:
    """Evaluate a block and return its outputs, or write them into a store and return none."""
    outputs, seen = evaluate(job, part, on_block)
    if store is None:
        return outputs, seen
    write_block(store, block, {name: values.reshape(part.shape) for name, values in outputs.items()})
    return {}, seen


@functools.lru_cache(maxsize=8)
def job_of(pickled: bytes) -> Job:
    """Return the job that was pickled, the same one for all blocks of a sweep."""
    job: Job = pickle.loads(pickled)
    return job


def _portable(error: BaseException) -> Exception:
    """Return the exception, or a `ModelError` if it would end a process or cannot be sent to one."""
    try:
        pickle.loads(pickle.dumps(error))
        return error if isinstance(error, Exception) else ModelError(described(error))
    except BaseException:
        return ModelError(described(error))
