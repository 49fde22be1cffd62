"""What happens to many arms in a sample beside their physics: disturbances, sensors, target, reward, end.

The functions stand alone in this file, so that numba's cache, which sees edits in this file only, is never out of date.
Random numbers are hashes of a counter (Steele, Lea, Flood, OOPSLA 2014, SplitMix64): a draw depends on its key and its
place alone, not on how many arms there are or which of them ended when.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

# --- settings: one number each, for all arms
(
    INTERVAL, HALF_PERIOD, RANGE, LENGTH, LIMIT, TAP_CHANCE, TAP_TORQUE, TAP_SAMPLES, DROP_CHANCE, DROP_SAMPLES, PER_TORQUE,
    TARGET_SCALE,
) = range(12)  # fmt: skip
WEIGHTS = 12
TERMS = 6
SETTINGS = WEIGHTS + TERMS

# --- columns of each arm's own numbers
(
    TARGET, FIRST_TARGET, FIRST_ANGLE, COMMAND, SAMPLE, TAP_LEFT, TAP, DROP_LEFT, DROPPED, TERMINATED, REWARD,
) = range(11)  # fmt: skip
TERM = 11
COLUMNS = TERM + TERMS

# --- columns of each sensor's numbers
NOISE, STEP, LARGEST, SCALE, WHOLE_DELAY, SHARE_OF_DELAY = range(6)
SENSOR = 6

# --- places: where each quantity stands in the arms' common array
(
    AT_SETTINGS, AT_SENSORS, AT_OWN, AT_LOOKS, LOOKS_EACH, AT_ASKED, AT_PUSHES, AT_HISTORY, AT_SHOWN, SIGNALS, DEPTH,
) = range(11)  # fmt: skip

#: Distance [rad] at which closeness has fallen to 1/e.
NEAR = 0.05
#: Streams of draws of one episode.
SENSORS_STREAM, TAPS_STREAM, DROPS_STREAM = 1, 2, 3


@njit(cache=True)
def mixed(x):
    """Return a hash of 64 bits (SplitMix64's finaliser)."""
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return x ^ (x >> np.uint64(31))


@njit(cache=True)
def uniform(key, stream, counter):
    """Return a number in [0, 1) for a key, a stream and a place in it."""
    golden = np.uint64(0x9E3779B97F4A7C15)
    own = mixed(key + np.uint64(stream) * golden)
    return float(mixed(own + (np.uint64(counter) + np.uint64(1)) * golden) >> np.uint64(11)) * 2.0**-53


@njit(cache=True)
def key_of(seed, name, episode):
    """Return the key of an episode: of an arm's seed, the hash of a name and the episode's number."""
    golden = np.uint64(0x9E3779B97F4A7C15)
    return mixed(mixed(mixed(np.uint64(seed) + golden) + np.uint64(name)) + np.uint64(episode) * golden)


@njit(cache=True, nogil=True)
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
    settings = arena[places[AT_SETTINGS] : places[AT_SETTINGS] + SETTINGS]
    for arm in range(first, last):
        own = arena[places[AT_OWN] + arm * COLUMNS : places[AT_OWN] + (arm + 1) * COLUMNS]
        looks = arena[places[AT_LOOKS] + arm * places[LOOKS_EACH] : places[AT_LOOKS] + (arm + 1) * places[LOOKS_EACH]]
        judge(settings, own, looks[places[SIGNALS] :], arena[places[AT_ASKED] + arm])
        sense(settings, arena, places, own, keys[arm], looks, observations, arm)
        arena[places[AT_PUSHES] + arm] = push(settings, own, keys[arm])


@njit(cache=True, nogil=True)
def after_reset(arena, places, keys, observations, arm):
    """Show an arm at the start of an episode, and draw what disturbs its first sample."""
    settings = arena[places[AT_SETTINGS] : places[AT_SETTINGS] + SETTINGS]
    own = arena[places[AT_OWN] + arm * COLUMNS : places[AT_OWN] + (arm + 1) * COLUMNS]
    looks = arena[places[AT_LOOKS] + arm * places[LOOKS_EACH] : places[AT_LOOKS] + (arm + 1) * places[LOOKS_EACH]]
    sense(settings, arena, places, own, keys[arm], looks, observations, arm)
    arena[places[AT_PUSHES] + arm] = push(settings, own, keys[arm])


@njit(cache=True)
def push(settings, own, key):
    """Return what a tap on the hub adds to the command of the next sample; taps start at random."""
    if own[TAP_LEFT] <= 0.0 and settings[TAP_CHANCE] > 0.0:
        counter = 2 * int(own[SAMPLE])
        if uniform(key, TAPS_STREAM, counter) < settings[TAP_CHANCE]:
            own[TAP_LEFT] = settings[TAP_SAMPLES]
            own[TAP] = settings[TAP_TORQUE] * (2.0 * uniform(key, TAPS_STREAM, counter + 1) - 1.0)
    if own[TAP_LEFT] <= 0.0:
        return 0.0
    own[TAP_LEFT] -= 1.0
    return own[TAP] * settings[PER_TORQUE]


@njit(cache=True)
def sense(settings, arena, places, own, key, looks, observations, arm):
    """Write what the sensors of an arm show, over their scales, then the target, to observations (arms, signals + 1).

    A sensor is late by its delay, noisy, goes in steps and ends at its largest reading; one that has dropped out shows
    what it last showed.
    """
    signals, depth, sample = places[SIGNALS], places[DEPTH], int(own[SAMPLE])
    history = arena[places[AT_HISTORY] + arm * depth * signals :]
    shown = arena[places[AT_SHOWN] + arm * signals :]
    dropped = _dropped(settings, own, key, sample, signals)
    radius, turn = 0.0, 0.0
    for j in range(signals):
        sensor = arena[places[AT_SENSORS] + j * SENSOR : places[AT_SENSORS] + (j + 1) * SENSOR]
        history[(sample % depth) * signals + j] = looks[j]
        if j % 2 == 0:
            counter = sample * (signals + signals % 2) + j
            radius = math.sqrt(-2.0 * math.log(1.0 - uniform(key, SENSORS_STREAM, counter)))
            turn = 2.0 * math.pi * uniform(key, SENSORS_STREAM, counter + 1)
        draw = radius * (math.cos(turn) if j % 2 == 0 else math.sin(turn))
        late = sample - int(sensor[WHOLE_DELAY])
        quantity = history[(max(late, 0) % depth) * signals + j]
        if sensor[SHARE_OF_DELAY] > 0.0:
            quantity += sensor[SHARE_OF_DELAY] * (history[(max(late - 1, 0) % depth) * signals + j] - quantity)
        reading = quantity + sensor[NOISE] * draw
        if sensor[STEP] > 0.0:
            reading = np.rint(reading / sensor[STEP]) * sensor[STEP] + 0.0
        if not math.isfinite(reading) or j == dropped:
            reading = shown[j]
        reading = min(max(reading, -sensor[LARGEST]), sensor[LARGEST])
        shown[j] = reading
        observations[arm, j] = reading / sensor[SCALE]
    observations[arm, signals] = own[TARGET] / settings[TARGET_SCALE]


@njit(cache=True)
def _dropped(settings, own, key, sample, signals):
    """Return which sensor of an arm has dropped out, or -1."""
    may = own[DROP_LEFT] <= 0.0 and settings[DROP_CHANCE] > 0.0 and sample > 0
    if may and uniform(key, DROPS_STREAM, 2 * sample) < settings[DROP_CHANCE]:
        own[DROP_LEFT] = settings[DROP_SAMPLES]
        own[DROPPED] = math.floor(signals * uniform(key, DROPS_STREAM, 2 * sample + 1))
    if own[DROP_LEFT] <= 0.0:
        return -1
    own[DROP_LEFT] -= 1.0
    return int(own[DROPPED])


@njit(cache=True)
def judge(settings, own, truth, command):
    """Move the target on and write the reward, its terms and whether the episode ends into the arm's own numbers."""
    own[SAMPLE] += 1.0
    change, own[COMMAND] = command - own[COMMAND], command
    if settings[HALF_PERIOD] > 0.0:
        half = math.floor(own[SAMPLE] * settings[INTERVAL] / settings[HALF_PERIOD] + 1e-9)
        own[TARGET] = own[FIRST_TARGET] * (1.0 if half % 2 == 0 else -1.0)
    angle, tip, lost = truth[0], truth[2], truth[4] > 0.0
    failed = lost or not abs(angle - own[FIRST_ANGLE]) <= settings[RANGE]
    if lost:
        angle, tip = own[FIRST_ANGLE] + settings[RANGE], 0.0
    distance = abs(own[TARGET] - angle)
    own[TERM] = -distance
    own[TERM + 1] = math.exp(-distance / NEAR)
    own[TERM + 2] = -abs(tip) / settings[LENGTH]
    own[TERM + 3] = -((command / settings[LIMIT]) ** 2)
    own[TERM + 4] = -((change / settings[LIMIT]) ** 2)
    own[TERM + 5] = -1.0 if failed else 0.0
    own[REWARD] = 0.0
    for i in range(TERMS):
        own[TERM + i] *= settings[WEIGHTS + i]
        own[REWARD] += own[TERM + i]
    own[TERMINATED] = 1.0 if failed else 0.0
