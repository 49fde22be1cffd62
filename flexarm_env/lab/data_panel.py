"""Panel of the recordings, uploaded, listed and removed, and of the arm that is compared with them."""

from __future__ import annotations

import contextlib
from collections.abc import AsyncIterator, Callable

from nicegui import events, html, run, ui

from flexarm_env.arm import Arm
from flexarm_env.arm_file import shipped_arms
from flexarm_env.errors import InputError
from flexarm_env.lab.guard import LARGEST_BODY
from flexarm_env.lab.session import Session
from flexarm_env.lab.uploads import MOST_RECORDINGS
from flexarm_env.recordings.formats.catalogue import suffixes
from flexarm_env.recordings.recording import Recording

DEMO_ARM = "thesis-fem"
ENVELOPE = 2**16  # [bytes], of a request's parts beside the files
NOT_TAKEN = (
    f"not taken: at most {MOST_RECORDINGS} files at once, of {LARGEST_BODY // 2**20} MB together, and room for them in a "
    "temporary file; cut them shorter, make room, or set TMPDIR"
)


class DataPanel:
    """The recordings of a session.

    Args:
        session: that holds the recordings.
        demo: reads the recordings of the demo.
        show_status: shows the work in progress.
        show_error: shows one line on bad input; an empty line removes it.
        changed: called when the recordings or the arm have changed.
    """

    def __init__(
        self,
        session: Session,
        demo: Callable[[], list[Recording]],
        show_status: Callable[[str], None],
        show_error: Callable[[str], None],
        changed: Callable[[], None],
    ) -> None:
        self.session, self.demo = session, demo
        self.show_status, self.show_error, self.changed = show_status, show_error, changed
        html.h2("Recordings")
        self.upload = ui.upload(
            multiple=True,
            auto_upload=True,
            max_total_size=LARGEST_BODY - ENVELOPE,
            max_files=MOST_RECORDINGS,
            on_multi_upload=self._uploaded,
            on_rejected=lambda: show_error(NOT_TAKEN),
        )
        self.upload.on("failed", self._failed, args=[])
        _drop_zone(self.upload)
        self.files = html.ul().classes("files")
        ui.button("Start with the demo", on_click=self._start_demo).props("outline")
        arms = sorted({*shipped_arms(), session.base.name})
        self.arm_choice = ui.select(arms, label="Arm", value=session.base.name, on_change=self._change_arm)

    def refresh(self) -> None:
        """List the session's recordings."""
        self.files.clear()
        with self.files:
            for one in self.session.recordings:
                with html.li():
                    ui.label(f"{one.name}: {one.duration:.3g} s at {1.0 / one.sample_time:.4g} Hz")
                    button = ui.button(icon="close", on_click=lambda _, one=one: self._remove(one)).props("flat dense round")
                    button.props["aria-label"] = f"remove {one.name}"

    @contextlib.asynccontextmanager
    async def _reading(self) -> AsyncIterator[None]:
        """Show a status while files are read, then the result or the error."""
        self.show_error("")
        self.show_status("Reading and simulating …")
        try:
            yield
        except InputError as error:
            self.show_error(str(error))
        finally:
            self.show_status("")
            self.changed()

    async def _uploaded(self, event: events.MultiUploadEventArguments) -> None:
        async with self._reading():
            files = [(file.name, await file.read()) for file in event.files]
            lines = await run.io_bound(self.session.upload, files)
            self.upload.reset()
            if lines:
                raise InputError(" — ".join(lines))

    def _failed(self) -> None:
        self.upload.reset()  # else the same files are sent again with the next ones
        self.show_error(NOT_TAKEN)

    async def _start_demo(self) -> None:
        async with self._reading():
            if self.session.base.name != DEMO_ARM:
                self.session.use([])
                self.session.change_arm(Arm.load(DEMO_ARM, self.session.base.known))
                self.arm_choice.set_value(DEMO_ARM)
            await run.io_bound(lambda: self.session.use(self.demo()))

    async def _change_arm(self) -> None:
        name = str(self.arm_choice.value)
        if name == self.session.base.name:
            return
        async with self._reading():
            try:
                await run.io_bound(self.session.change_arm, Arm.load(name, self.session.base.known))
            finally:
                self.arm_choice.set_value(self.session.base.name)

    async def _remove(self, gone: Recording) -> None:
        async with self._reading():
            await run.io_bound(self.session.use, [one for one in self.session.recordings if one is not gone])


def _drop_zone(upload: ui.upload) -> None:
    """Build a labelled drop zone that passes its files to an invisible upload.

    The upload's own button is one control within another, and a screen reader cannot separate them.
    """
    take = f"getElement({upload.id}).$refs.qRef.addFiles"
    with html.label().classes("drop") as zone:
        html.span("Drop CSV files here, or choose some")
        chosen = ui.element("input").props(f"type=file multiple accept={','.join(suffixes())}")
    chosen.on("change", js_handler=f"(e) => {{ {take}([...e.target.files]); e.target.value = '' }}")
    mark = "e.currentTarget.classList"
    zone.on("dragover", js_handler=f"(e) => {{ e.preventDefault(); {mark}.add('over') }}")
    zone.on("dragleave", js_handler=f"(e) => {mark}.remove('over')")
    zone.on("drop", js_handler=f"(e) => {{ e.preventDefault(); {mark}.remove('over'); {take}([...e.dataTransfer.files]) }}")
