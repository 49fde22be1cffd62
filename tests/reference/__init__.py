"""Tight reference solver of the flexible arm: slow, plain, and independent of the package.

The model is the consistent one of the thesis (eqs. 3.1-3.14 with the errata mended): n equal Euler-Bernoulli
elements on a hub that slips with Coulomb friction or sticks. The coordinates q = [hub angle, v_1, s_1, ...,
v_n, s_n] (deflection [m] and slope [rad] of each node) are absolute, measured from the line of the start:

    M q" + B q' + K q = [N k_phi i - T_f, 0, ...],   T_f = T_c sgn(hub speed) while the hub slips.

At zero hub speed the hub sticks as long as |hold torque| <= T_s; otherwise it slips the hold torque's way.

Two solvers share nothing but M, B and K:
- `ReferenceArm.simulate`: DOP853, restarted at every input step and every event. Each solver step's dense
  output is a polynomial of degree 7 in time, so all its roots are found: no pair of crossings can hide.
  The first root is then polished by Newton's method on true solver steps, not on the dense output.
- `witness`: matrix exponentials in absolute coordinates and extended precision, events by scan and brentq.
"""

from reference.arm import frequencies
from reference.currents import pulse_current, white_noise_current
from reference.events import ReferenceArm
from reference.witness import witness

__all__ = ["ReferenceArm", "frequencies", "pulse_current", "white_noise_current", "witness"]
