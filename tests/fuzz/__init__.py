"""A fuzzer of wearlaw: random calls and damaged files, each of which must work or end with an error of wearlaw.

    python -m tests.fuzz --seconds 600
    python -m tests.fuzz --target api --seed 1234 --cases 1

A case is a few files, drawn from a seed. What a target does with them must return what is true, or raise a
`WearlawError`. `harness.py` says what counts as a finding. `corpus/` holds an entry for each finding, which
`tests/test_fuzz.py` replays.
"""
