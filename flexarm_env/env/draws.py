"""Random numbers that are hashes of a counter (Steele, Lea, Flood, OOPSLA 2014, SplitMix64).

A draw depends on its key and its place alone, not on how many arms there are or which of them ended when. The functions
stand alone in this file, so that numba's cache, which detects edits of this file only, is never out of date.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

#: Distance of SplitMix64's counters: 2⁶⁴ over the golden ratio.
GOLDEN = np.uint64(0x9E3779B97F4A7C15)

#: Layers of equal area under the normal density: their number, the lowest one's edge, their area (Doornik 2005).
LAYERS = 256
LOWEST_EDGE = 3.6541528853610088
LAYER_AREA = 0.00492867323399


def _edges():
    """Compute the right edges (LAYERS + 1,) of the layers, from the lowest up."""
    density = math.exp(-0.5 * LOWEST_EDGE**2)
    edges = [LAYER_AREA / density, LOWEST_EDGE]
    while len(edges) < LAYERS:
        density += LAYER_AREA / edges[-1]
        edges.append(math.sqrt(-2.0 * math.log(density)))
    return np.array([*edges, 0.0])


EDGES = _edges()
RATIOS = EDGES[1:] / EDGES[:-1]


@njit(cache=True)
def mixed(x):
    """Compute a hash of 64 bits (SplitMix64's finaliser)."""
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return x ^ (x >> np.uint64(31))


@njit(cache=True)
def uniform(key, stream, counter):
    """Draw a number in [0, 1) for a key, a stream and a place in it."""
    own = mixed(key + np.uint64(stream) * GOLDEN)
    return float(mixed(own + (np.uint64(counter) + np.uint64(1)) * GOLDEN) >> np.uint64(11)) * 2.0**-53


@njit(cache=True)
def key_of(seed, name, episode):
    """Compute the key of an episode from an arm's seed, the hash of a name and the episode's number."""
    return mixed(mixed(mixed(np.uint64(seed) + GOLDEN) + np.uint64(name)) + np.uint64(episode) * GOLDEN)


@njit(cache=True, error_model="numpy", _nrt=False)
def normal(stream, counter):
    """Draw a normal number of variance 1 for a stream's own key and a place in it.

    Source: Doornik, An Improved Ziggurat Method to Generate Normal Random Samples, 2005. Where a draw is refused, the
    next one comes from the hash of its bits.
    """
    bits = mixed(stream + (np.uint64(counter) + np.uint64(1)) * GOLDEN)
    while True:
        layer = np.int64(bits & np.uint64(LAYERS - 1))
        share = float(np.int64(bits) >> np.int64(11)) * 2.0**-52
        drawn = share * EDGES[layer]
        if abs(share) < RATIOS[layer]:
            return drawn
        bits = mixed(bits + GOLDEN)
        height = float(bits >> np.uint64(11)) * 2.0**-53
        if layer == 0:
            return math.copysign(_beyond(bits, height), share)
        upper = math.exp(-0.5 * (EDGES[layer] ** 2 - drawn**2))
        lower = math.exp(-0.5 * (EDGES[layer + 1] ** 2 - drawn**2))
        if lower + height * (upper - lower) < 1.0:
            return drawn
        bits = mixed(bits + GOLDEN)


@njit(cache=True)
def _beyond(bits, share):
    """Draw a number from the tail beyond the lowest layer (Marsaglia 1964)."""
    while True:
        bits = mixed(bits + GOLDEN)
        further = -math.log(1.0 - share) / EDGES[1]
        if -2.0 * math.log(1.0 - float(bits >> np.uint64(11)) * 2.0**-53) > further**2:
            return EDGES[1] + further
        bits = mixed(bits + GOLDEN)
        share = float(bits >> np.uint64(11)) * 2.0**-53
