"""Signals, or commands, that run against the model."""

from __future__ import annotations

from flexarm_env.identify.inspect.evidence import Evidence
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.report import fault
from flexarm_env.identify.inspect.series import HUB


def signs(evidence: Evidence) -> list[Fault]:
    """Find signals that run against the model while others run with it; the command where all run against it."""
    least = evidence.numbers.shared_motion
    if evidence.hub is not None and evidence.hub_in_step and evidence.hub.gain < 0.0:
        return [_fault(evidence, min(HUB, key=lambda signal: evidence.at_once[signal].gain), "")]
    shown = {signal: found.gain for signal, found in evidence.at_once.items() if found.share > least}
    against = [signal for signal, gain in shown.items() if gain < 0.0 and not evidence.is_like_model_later(signal)]
    if len(against) < len(shown):
        return [_fault(evidence, signal, "") for signal in against]
    if not against or len(shown) < len(evidence.signals):
        return []
    command = evidence.recording.input_kind
    if len(against) > 1:
        return [_fault(evidence, command, "")]
    (signal,) = against
    mended = evidence.replayer.free_run(-1.0).agreement(signal, signal)
    first, second = (command, signal) if mended.share > evidence.at_once[signal].share else (signal, command)
    return [_fault(evidence, first, second)]


def _fault(evidence: Evidence, signal: str, rival: str) -> Fault:
    also = f" (or {rival} does: with one signal alone the two look alike)" if rival else ""
    text, hint = f"runs against the model{also}", f"{signal} = {{ sign = -1 }}"
    return fault(evidence.recording, signal, "sign", -1.0, text, hint, other=rival)
