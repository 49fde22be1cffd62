"""What happens to many arms in a sample beside their physics: disturbances, sensors, target, reward, end.

The functions stand alone in this file, so that numba's cache, which sees edits in this file only, is never out of date.
Random numbers are hashes of a counter (Steele, Lea, Flood, OOPSLA 2014, SplitMix64): a draw depends on its key and its
place alone, not on how many arms there are or which of them ended when.
They count no references (_nrt), for the reasons given in plant/compose.py.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

# --- settings: one number each, for all arms
(
    INTERVAL, HALF_PERIOD, RANGE, LIMIT, TAP_CHANCE, TAP_TORQUE, TAP_SAMPLES, DROP_CHANCE, DROP_SAMPLES, TARGET_SCALE,
) = range(10)  # fmt: skip
WEIGHTS = 10
TERMS = 6
SETTINGS = WEIGHTS + TERMS

# --- columns of each arm's own numbers
FIRST_TARGET, FIRST_ANGLE, TAP_LEFT, TAP, DROP_LEFT, DROPPED, LENGTH, PER_TORQUE = range(8)
COLUMNS = 8

# --- rows of what is told of all arms, those of an info first: the truth, the target, the command, the reward's terms
TRUTH_ROWS = 4
TARGET, COMMAND, TERM = 4, 5, 6
REWARD, TERMINATED, SAMPLE = TERM + TERMS, TERM + TERMS + 1, TERM + TERMS + 2
ROWS = SAMPLE + 1

# --- columns of each sensor's numbers
NOISE, STEP, PER_STEP, LARGEST, PER_SCALE, WHOLE_DELAY, SHARE_OF_DELAY = range(7)
SENSOR = 7

# --- places: where each quantity stands in the arms' common array
(
    AT_SETTINGS, AT_SENSORS, AT_OWN, AT_LOOKS, LOOKS_EACH, AT_ASKED, AT_PUSHES, AT_HISTORY, AT_SHOWN, AT_TOLD, TOLD_EACH, SIGNALS,
    DEPTH,
) = range(13)  # fmt: skip

#: Distance [rad] at which closeness has fallen to 1/e.
NEAR = 0.05
#: Streams of draws of one episode.
SENSORS_STREAM, TAPS_STREAM, DROPS_STREAM = 1, 2, 3
#: Distance of SplitMix64's counters: 2⁶⁴ over the golden ratio.
GOLDEN = np.uint64(0x9E3779B97F4A7C15)

#: Layers of equal area under the normal density: their number, the lowest one's edge, their area (Doornik 2005).
LAYERS = 256
LOWEST_EDGE = 3.6541528853610088
LAYER_AREA = 0.00492867323399


def _edges():
    """Return the right edges (LAYERS + 1,) of the layers, from the lowest up."""
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
    """Return a hash of 64 bits (SplitMix64's finaliser)."""
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return x ^ (x >> np.uint64(31))


@njit(cache=True)
def uniform(key, stream, counter):
    """Return a number in [0, 1) for a key, a stream and a place in it."""
    own = mixed(key + np.uint64(stream) * GOLDEN)
    return float(mixed(own + (np.uint64(counter) + np.uint64(1)) * GOLDEN) >> np.uint64(11)) * 2.0**-53


@njit(cache=True)
def key_of(seed, name, episode):
    """Return the key of an episode: of an arm's seed, the hash of a name and the episode's number."""
    return mixed(mixed(mixed(np.uint64(seed) + GOLDEN) + np.uint64(name)) + np.uint64(episode) * GOLDEN)


@njit(cache=True, error_model="numpy", _nrt=False)
def normal(stream, counter):
    """Return a normal number of variance 1 for a stream's own key and a place in it.

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
    """Return a number from the tail beyond the lowest layer (Marsaglia 1964)."""
    while True:
        bits = mixed(bits + GOLDEN)
        further = -math.log(1.0 - share) / EDGES[1]
        if -2.0 * math.log(1.0 - float(bits >> np.uint64(11)) * 2.0**-53) > further**2:
            return EDGES[1] + further
        bits = mixed(bits + GOLDEN)
        share = float(bits >> np.uint64(11)) * 2.0**-53


@njit(cache=True, nogil=True, error_model="numpy", _nrt=False)
def after_step(arena, places, keys, observations, first, last):
    """Judge arms first to last - 1 after their physics, show them, and draw what disturbs their next sample.

    Args:
        arena: all numbers of the arms, one after another.
        places: where in it what stands.
        keys: (arms,) of the episodes.
        observations: (arms, signals + 1), to be written.
        first: of the arms.
        last: behind the last of them.
    """
    for arm in range(first, last):
        judge(arena, places, arm)
        tell_truth(arena, places, arm)
        sense(arena, places, keys[arm], observations, arm)
        arena[places[AT_PUSHES] + arm] = push(arena, places, keys[arm], arm)


@njit(cache=True, nogil=True, error_model="numpy", _nrt=False)
def after_reset(arena, places, keys, observations, arm):
    """Show an arm at the start of an episode, and draw what disturbs its first sample."""
    tell_truth(arena, places, arm)
    sense(arena, places, keys[arm], observations, arm)
    arena[places[AT_PUSHES] + arm] = push(arena, places, keys[arm], arm)


@njit(cache=True, nogil=True, error_model="numpy", _nrt=False)
def admit(actions, arena, places, limit):
    """Write what actions (arms,) ask for [A or V]; return the first arm whose action is not a number, or -1."""
    asked = places[AT_ASKED]
    for arm in range(len(actions)):
        action = actions[arm]
        if not math.isfinite(action):
            return arm
        arena[asked + arm] = min(max(action, -1.0), 1.0) * limit
    return -1


@njit(cache=True, error_model="numpy", _nrt=False, forceinline=True)
def tell_truth(a, places, arm):
    """Write an arm's truth into what is told of it."""
    truth = places[AT_LOOKS] + arm * places[LOOKS_EACH] + places[SIGNALS]
    told, row = places[AT_TOLD] + arm, places[TOLD_EACH]
    for i in range(TRUTH_ROWS):
        a[told + i * row] = a[truth + i]


@njit(cache=True, error_model="numpy", _nrt=False, forceinline=True)
def push(a, places, key, arm):
    """Return what a tap on the hub adds to the command of the next sample; taps start at random."""
    settings, own = places[AT_SETTINGS], places[AT_OWN] + arm * COLUMNS
    if a[own + TAP_LEFT] <= 0.0 and a[settings + TAP_CHANCE] > 0.0:
        counter = 2 * int(a[places[AT_TOLD] + SAMPLE * places[TOLD_EACH] + arm])
        if uniform(key, TAPS_STREAM, counter) < a[settings + TAP_CHANCE]:
            a[own + TAP_LEFT] = a[settings + TAP_SAMPLES]
            a[own + TAP] = a[settings + TAP_TORQUE] * (2.0 * uniform(key, TAPS_STREAM, counter + 1) - 1.0)
    if a[own + TAP_LEFT] <= 0.0:
        return 0.0
    a[own + TAP_LEFT] -= 1.0
    return a[own + TAP] * a[own + PER_TORQUE]


@njit(cache=True, error_model="numpy", _nrt=False, forceinline=True)
def sense(a, places, key, observations, arm):
    """Write what the sensors of an arm show, over their scales, then the target, to observations (arms, signals + 1).

    A sensor is late by its delay, noisy, goes in steps and ends at its largest reading; one that has dropped out shows
    what it last showed.
    """
    settings, signals, own = places[AT_SETTINGS], places[SIGNALS], places[AT_OWN] + arm * COLUMNS
    told, row = places[AT_TOLD] + arm, places[TOLD_EACH]
    sample = int(a[told + SAMPLE * row])
    looks, shown = places[AT_LOOKS] + arm * places[LOOKS_EACH], places[AT_SHOWN] + arm * signals
    dropped = _dropped(a, settings, own, key, sample, signals) if a[settings + DROP_CHANCE] > 0.0 else -1
    late = places[DEPTH] > 0
    stream = mixed(key + np.uint64(SENSORS_STREAM) * GOLDEN)
    for j in range(signals):
        sensor = places[AT_SENSORS] + j * SENSOR
        quantity = _late(a, places, sensor, sample, arm, j) if late else a[looks + j]
        reading = quantity + a[sensor + NOISE] * normal(stream, sample * signals + j)
        if a[sensor + STEP] > 0.0:
            reading = np.rint(reading * a[sensor + PER_STEP]) * a[sensor + STEP] + 0.0
        if not math.isfinite(reading) or j == dropped:
            reading = a[shown + j]
        reading = min(max(reading, -a[sensor + LARGEST]), a[sensor + LARGEST])
        a[shown + j] = reading
        observations[arm, j] = reading * a[sensor + PER_SCALE]
    observations[arm, signals] = a[told + TARGET * row] / a[settings + TARGET_SCALE]


@njit(cache=True, error_model="numpy", _nrt=False)
def _late(a, places, sensor, sample, arm, j):
    """Return what sensor j of an arm measured some samples ago, and keep what it measures now."""
    signals, depth = places[SIGNALS], places[DEPTH]
    history = places[AT_HISTORY] + arm * depth * signals + j
    a[history + (sample % depth) * signals] = a[places[AT_LOOKS] + arm * places[LOOKS_EACH] + j]
    late = sample - int(a[sensor + WHOLE_DELAY])
    quantity, before = a[history + (max(late, 0) % depth) * signals], a[history + (max(late - 1, 0) % depth) * signals]
    return quantity + a[sensor + SHARE_OF_DELAY] * (before - quantity)


@njit(cache=True, error_model="numpy", _nrt=False)
def _dropped(a, settings, own, key, sample, signals):
    """Return which sensor of an arm has dropped out, or -1."""
    may = a[own + DROP_LEFT] <= 0.0 and sample > 0
    if may and uniform(key, DROPS_STREAM, 2 * sample) < a[settings + DROP_CHANCE]:
        a[own + DROP_LEFT] = a[settings + DROP_SAMPLES]
        a[own + DROPPED] = math.floor(signals * uniform(key, DROPS_STREAM, 2 * sample + 1))
    if a[own + DROP_LEFT] <= 0.0:
        return -1
    a[own + DROP_LEFT] -= 1.0
    return int(a[own + DROPPED])


@njit(cache=True, error_model="numpy", _nrt=False, forceinline=True)
def judge(a, places, arm):
    """Move the target on and write the reward, its terms and whether the episode ends into what is told of an arm."""
    settings, own, asked = places[AT_SETTINGS], places[AT_OWN] + arm * COLUMNS, a[places[AT_ASKED] + arm]
    truth = places[AT_LOOKS] + arm * places[LOOKS_EACH] + places[SIGNALS]
    told, row = places[AT_TOLD] + arm, places[TOLD_EACH]
    sample, target, command = told + SAMPLE * row, told + TARGET * row, told + COMMAND * row
    a[sample] += 1.0
    change, a[command] = asked - a[command], asked
    if a[settings + HALF_PERIOD] > 0.0:
        half = math.floor(a[sample] * a[settings + INTERVAL] / a[settings + HALF_PERIOD] + 1e-9)
        a[target] = a[own + FIRST_TARGET] * (1.0 if half % 2 == 0 else -1.0)
    angle, tip, lost = a[truth], a[truth + 2], a[truth + 4] > 0.0
    failed = lost or not abs(angle - a[own + FIRST_ANGLE]) <= a[settings + RANGE]
    if lost:
        angle, tip = a[own + FIRST_ANGLE] + a[settings + RANGE], 0.0
    distance = abs(a[target] - angle)
    terms = (
        -distance,
        math.exp(-distance / NEAR),
        -abs(tip) / a[own + LENGTH],
        -((asked / a[settings + LIMIT]) ** 2),
        -((change / a[settings + LIMIT]) ** 2),
        -1.0 if failed else 0.0,
    )
    reward = 0.0
    for i in range(TERMS):
        term = terms[i] * a[settings + WEIGHTS + i]
        a[told + (TERM + i) * row] = term
        reward += term
    a[told + REWARD * row] = reward
    a[told + TERMINATED * row] = 1.0 if failed else 0.0
