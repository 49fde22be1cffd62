"""Refusal of requests before they are read: foreign host names, other sites' pages, and bodies that are too large."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, MutableMapping
from typing import Any

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]
App = Callable[[Scope, Receive, Send], Awaitable[None]]

#: Of every answer: no page may show the lab within its own, where a visitor would click what he does not see.
PROTECTION = (
    (b"content-security-policy", b"frame-ancestors 'none'"),
    (b"x-frame-options", b"DENY"),
    (b"x-content-type-options", b"nosniff"),
)
#: Largest body of a request [bytes]: room for several recordings.
LARGEST_BODY = 64 * 2**20


class Guard:
    """ASGI middleware against pages of other sites that reach the lab through the visitor's browser.

    A foreign name that resolves to this machine (DNS rebinding) appears in the Host header, a request from another site's
    page in Origin.

    Args:
        app: the guarded application.
        hosts: "name:port" at which the lab is served.
        largest: limit on the size of a body [bytes].
    """

    def __init__(self, app: App, hosts: tuple[str, ...], largest: int = LARGEST_BODY) -> None:
        self.app, self.hosts, self.largest = app, hosts, largest

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, or refuse it."""
        if scope["type"] not in ("http", "websocket"):
            return await self.app(scope, receive, send)
        headers = {key.decode("latin-1").lower(): value.decode("latin-1") for key, value in scope["headers"]}
        refused = self._refusal(scope, headers)
        if refused is None:
            return await self._pass_on(scope, receive, send)
        if scope["type"] == "websocket":
            return await send({"type": "websocket.close", "code": 1008, "reason": refused[1]})
        await _answer(send, *refused)

    async def _pass_on(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on; answer one whose body finds no room in a temporary file."""
        began = False

        async def sending(message: MutableMapping[str, Any]) -> None:
            nonlocal began
            began = True
            await send(message)

        try:
            await self.app(scope, receive, _protected(sending))
        except OSError as error:
            if began or scope["type"] != "http":
                raise
            await _answer(send, 507, f"The lab cannot keep what was sent: {error.strerror}; make room, or set TMPDIR.")

    def _refusal(self, scope: Scope, headers: dict[str, str]) -> tuple[int, str] | None:
        if headers.get("host", "") not in self.hosts:
            return 421, f"The lab answers only at {self.hosts[0]}."
        origin = headers.get("origin")
        if origin is not None and origin.partition("://")[2] not in self.hosts:
            return 403, "The lab answers only its own page."
        if scope["type"] == "http" and scope["method"] not in ("GET", "HEAD"):
            length = headers.get("content-length", "")
            if not length.isdigit():
                return 411, "The lab takes no body without its length."
            if int(length) > self.largest:
                return 413, f"The lab takes at most {self.largest // 2**20} MB at once; cut the recordings or drop fewer."
        return None


async def _answer(send: Send, status: int, words: str) -> None:
    """Answer in plain text, and close the connection."""
    plain = [(b"content-type", b"text/plain; charset=utf-8"), (b"connection", b"close"), *PROTECTION]
    await send({"type": "http.response.start", "status": status, "headers": plain})
    await send({"type": "http.response.body", "body": words.encode()})


def _protected(send: Send) -> Send:
    """Add the protection to the headers of an answer."""

    async def sending(message: MutableMapping[str, Any]) -> None:
        if message["type"] == "http.response.start":
            message = {**message, "headers": [*message.get("headers", ()), *PROTECTION]}
        await send(message)

    return sending
