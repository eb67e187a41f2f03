"""The samplers that a scene can ask for by name, and what each of them promises."""

from dataclasses import dataclass

EXACT = 1e-13  # relative error of a value that is right to the last digits


@dataclass(frozen=True)
class Promise:
    """What others may rely on, whichever sampler it is."""

    # It draws single asperities, each with a radius of its own where summits have them, by the exact laws;
    # else sums of crowds, which are a little off: ``auto`` takes it where a scene allows that.
    one_by_one: bool = True
    own_laws: bool = False  # it adds up summit by summit: each can have breaks of its own in the contact law
    needs_density: bool = False  # it draws from that of the heights, which a list of measured ones has not
    not_done: tuple[str, ...] = ()  # what it spares, for people; {spared}: asperities that do not touch


_UNTOUCHED = "{spared:.4g} asperities per surface lie below every separation and are not drawn"
_CROWDED = "in crowded cells, Gaussian moments are drawn instead of asperities"

_PROMISES = {
    "direct": Promise(own_laws=True),
    "tail": Promise(own_laws=True, needs_density=True, not_done=(_UNTOUCHED,)),
    "cells": Promise(needs_density=True, not_done=(_UNTOUCHED,)),
    "aggregate": Promise(one_by_one=False, needs_density=True, not_done=(_UNTOUCHED, _CROWDED)),
}
SAMPLERS = ("auto", *_PROMISES)


def promise_of(sampler: str) -> Promise:
    """Return what a sampler promises; ``auto`` takes one that promises all."""
    return _PROMISES.get(sampler, Promise(own_laws=True))
