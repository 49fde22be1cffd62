"""The lab's server, on the loopback interface."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import os
import socket
from collections.abc import Callable, Sequence
from pathlib import Path

from nicegui import app, background_tasks, run, ui

from flexarm_env.errors import InputError
from flexarm_env.lab.guard import Guard
from flexarm_env.lab.live import Live
from flexarm_env.lab.page import LabPage
from flexarm_env.lab.session import Session
from flexarm_env.lab.sessions import MOST_SESSIONS, Sessions
from flexarm_env.recordings.recording import Recording

HOST = "127.0.0.1"
DEMO = Path(__file__).resolve().parent.parent / "demo"


def serve(start: Callable[[], Session], recordings: Sequence[Recording], port: int, show: bool) -> None:
    """Serve the lab until Ctrl-C.

    Args:
        start: makes the session of a tab, without recordings.
        recordings: initial ones of every tab.
        port: to listen at; 0 takes a free one.
        show: whether to open a browser.

    Raises:
        InputError: if the port is taken, or the recordings do not fit the arm.
    """
    if recordings:
        Live(start().base, recordings)  # refuses unsuitable recordings before the server starts
    port = _free(port)
    os.environ.pop("PYTEST_CURRENT_TEST", None)  # with it NiceGUI would take a lab under test for its own
    sessions = Sessions(MOST_SESSIONS)

    @ui.page("/", title="FlexArm lab")
    async def lab() -> None:
        client = ui.context.client
        await client.connected()
        tab = client.tab_id or client.id
        session = sessions.get(tab) or await run.io_bound(_started, start, recordings)
        if not client.is_deleted:  # a tab that was closed meanwhile has no page to fill
            sessions.show(tab, session, client)
            client.on_disconnect(lambda: sessions.use(tab))
            LabPage(session, lambda: Recording.read_all(DEMO))

    @app.on_shutdown
    def end() -> None:
        sessions.stop()

    hosts = (f"{HOST}:{port}", f"localhost:{port}")
    app.config.quasar_config["loadingBar"] = {"skipHijack": True}  # the bar has no name for a screen reader
    app.add_middleware(Guard, hosts=hosts)
    app.on_startup(lambda: background_tasks.create(_announce(port)))
    logging.getLogger("uvicorn.error").addFilter(_is_relevant)
    with contextlib.suppress(KeyboardInterrupt):
        ui.run(host=HOST, port=port, title="FlexArm lab", reload=False, show=show, show_welcome_message=False, language="en-US")


def _is_relevant(record: logging.LogRecord) -> bool:
    """Filter from the server's log the lines on visitors who left before the answer, an error to Starlette."""
    error = record.exc_info[1] if record.exc_info else None
    return not (isinstance(error, RuntimeError) and str(error) == "No response returned.")


async def _announce(port: int) -> None:
    """Print the lab's address once it answers."""
    while True:
        with contextlib.suppress(OSError):
            _, writer = await asyncio.open_connection(HOST, port)
            writer.close()
            break
        await asyncio.sleep(0.02)
    print(f"FlexArm lab at http://{HOST}:{port}/ (Ctrl-C ends it)", flush=True)


def _started(start: Callable[[], Session], recordings: Sequence[Recording]) -> Session:
    session = start()
    if recordings:
        session.use(list(recordings))
    return session


def _free(port: int) -> int:
    """Check that the port is free; choose a free one for 0.

    Raises:
        InputError: if it is taken.
    """
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((HOST, port))
        except OSError as error:
            raise InputError(f"port {port} cannot be used: {error.strerror}; name another with --port, 0 for any") from None
        return int(probe.getsockname()[1])
