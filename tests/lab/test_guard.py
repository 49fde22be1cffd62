"""What the lab's server refuses before it reads."""

from __future__ import annotations

import asyncio
import errno
import os

import pytest

from flexarm_env.lab.guard import Guard

HOSTS = ("127.0.0.1:8071", "localhost:8071")


def answer(method: str = "GET", kind: str = "http", **headers: str) -> list[dict]:
    """What a guarded application sends for a request."""
    sent: list[dict] = []

    async def application(scope, receive, send) -> None:
        await send({"type": "http.response.start", "status": 200, "headers": []})

    async def send(message) -> None:
        sent.append(message)

    given = {"host": HOSTS[0]} | {key.replace("_", "-"): value for key, value in headers.items()}
    scope = {"type": kind, "method": method, "headers": [(k.encode(), v.encode()) for k, v in given.items()]}
    asyncio.run(Guard(application, HOSTS, largest=1000)(scope, None, send))
    return sent


@pytest.mark.parametrize(
    ("status", "request_"),
    [
        (200, {}),
        (200, {"host": "localhost:8071", "origin": "http://localhost:8071"}),
        (200, {"method": "POST", "content_length": "1000"}),
        (421, {"host": "evil.example"}),
        (421, {"host": "evil.example:8071"}),
        (421, {"host": "127.0.0.1:9000"}),
        (421, {"host": ""}),
        (403, {"origin": "http://evil.example"}),
        (403, {"origin": "null"}),
        (413, {"method": "POST", "content_length": "1001"}),
        (411, {"method": "POST"}),
        (411, {"method": "PUT", "content_length": "-1"}),
    ],
)
def test_requests(status, request_):
    assert answer(**request_)[0]["status"] == status


def test_a_websocket_from_elsewhere_is_closed():
    assert answer(kind="websocket", origin="http://evil.example")[0]["type"] == "websocket.close"
    assert answer(kind="websocket", origin=f"http://{HOSTS[0]}")[0]["type"] != "websocket.close"


@pytest.mark.parametrize("begun", [False, True])
def test_a_body_without_room_is_answered(begun):
    """Unless an answer was under way: then the fault is another one."""
    sent: list[dict] = []

    async def application(scope, receive, send) -> None:
        if begun:
            await send({"type": "http.response.start", "status": 200, "headers": []})
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    async def send(message) -> None:
        sent.append(message)

    headers = [(b"host", HOSTS[0].encode()), (b"content-length", b"10")]
    work = Guard(application, HOSTS)({"type": "http", "method": "POST", "headers": headers}, None, send)
    if begun:
        with pytest.raises(OSError, match="No space left"):
            asyncio.run(work)
        return
    asyncio.run(work)
    assert sent[0]["status"] == 507
    assert sent[1]["body"] == b"The lab cannot keep what was sent: No space left on device; make room, or set TMPDIR."


@pytest.mark.parametrize("request_", [{}, {"host": "evil.example"}, {"origin": "http://evil.example"}])
def test_no_page_may_frame_an_answer(request_):
    headers = dict(answer(**request_)[0]["headers"])
    assert headers[b"content-security-policy"] == b"frame-ancestors 'none'"
    assert headers[b"x-frame-options"] == b"DENY"
    assert headers[b"x-content-type-options"] == b"nosniff"
