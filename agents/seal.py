"""Content of a file sealed by a mark and a digest, so that no damaged one is read."""

from __future__ import annotations

import hashlib

DIGEST = hashlib.sha256().digest_size


def sealed(mark: bytes, content: bytes) -> bytes:
    """Put the mark of a kind of file and the digest of its content before the content."""
    return mark + hashlib.sha256(content).digest() + content


def unsealed(mark: bytes, whole: bytes) -> bytes | None:
    """Take the content from what `sealed` returned; None for anything else."""
    content = whole[len(mark) + DIGEST :]
    return content if whole == sealed(mark, content) else None
