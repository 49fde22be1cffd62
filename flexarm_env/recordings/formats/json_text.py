"""JSON in which no key of an object comes twice, of which Python would keep the last without a word."""

from __future__ import annotations

import json
from collections import Counter
from typing import Any

from flexarm_env.errors import InputError
from flexarm_env.recordings.messages import quoted


def load_json(content: bytes) -> Any:
    """Read JSON.

    Args:
        content: of a file or a message.

    Raises:
        InputError: for a key that comes twice in one object.
        ValueError: for what is no JSON.
    """
    return json.loads(content, object_pairs_hook=_object)


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        twice = Counter(key for key, _ in pairs).most_common(1)[0][0]
        raise InputError(f"an object has {quoted(twice)} twice; keep one of the two")
    return found
