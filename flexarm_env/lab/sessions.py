"""Sessions of the lab's tabs, of which a number is kept."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from flexarm_env.lab.session import Session

#: Tabs whose session is kept.
MOST_SESSIONS = 16


class Page(Protocol):
    """A page in a browser, as far as it matters here: a client of NiceGUI."""

    @property
    def has_socket_connection(self) -> bool:
        """Whether a browser shows the page."""


@dataclass(frozen=True)
class Kept:
    """A session, and the pages that have shown it: one after another, where a tab is loaded again."""

    session: Session
    pages: tuple[Page, ...]

    @property
    def is_shown(self) -> bool:
        """Whether a browser shows it."""
        return any(page.has_socket_connection for page in self.pages)


class Sessions:
    """Sessions by tab. Beyond their number one is dropped: of those that no browser shows, else of those without work.

    Among equal ones it is the one whose page was opened or closed the longest time ago.

    Args:
        most: number of them.
    """

    def __init__(self, most: int) -> None:
        self.most = most
        self._kept: dict[str, Kept] = {}  # in the order of their last use

    def get(self, tab: str) -> Session | None:
        """Look up the session of a tab; None where there is none."""
        return self._kept[tab].session if tab in self._kept else None

    def show(self, tab: str, session: Session, page: Page) -> None:
        """Keep the session of a tab that a page shows from now on, and drop another one where there are too many."""
        before = self._kept.pop(tab, None)
        earlier = () if before is None else tuple(one for one in before.pages if one.has_socket_connection)
        self._kept[tab] = Kept(session, (*earlier, page))
        if len(self._kept) > self.most:
            others = [name for name in self._kept if name != tab]
            least = min(others, key=lambda name: (self._kept[name].is_shown, self._kept[name].session.busy))
            self._kept.pop(least).session.drop()

    def use(self, tab: str) -> None:
        """Note that a tab was in use until now."""
        if tab in self._kept:
            self._kept[tab] = self._kept.pop(tab)

    def stop(self) -> None:
        """Stop the work of all."""
        for kept in self._kept.values():
            kept.session.stop()
