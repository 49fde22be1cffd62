"""Placeholder of the function that writes a reward's terms, so that kernel.py reads as a complete module.

It is never compiled: `compose` joins the text of the kernel's files without their imports, and writes a `write_terms` of the
task's own terms in front of kernel.py.
"""

from __future__ import annotations


def write_terms(a, weights, row, row_each, sample):
    """Write each weighted term of a sample to `a`, from `row` on in steps of `row_each`, and return their sum.

    Args:
        a: all numbers of the arms.
        weights: offset of the terms' weights in `a`.
        row: offset of the first term.
        row_each: distance from term to term.
        sample: flexarm_env.tasks.reward.Sample.

    Raises:
        NotImplementedError: always.
    """
    raise NotImplementedError("compose writes this function for the terms of a task")
