"""Which tab's session makes room for another one."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from flexarm_env import Arm, simulate
from flexarm_env.lab.session import Session
from flexarm_env.lab.sessions import Sessions

ARM = Arm.load("cu-rigid")


@dataclass
class Page:
    """A page that a browser shows, or showed."""

    has_socket_connection: bool = True


@dataclass
class Running:
    """Work under way."""

    state: str = "running"

    def stop(self) -> None:
        self.state = "stopped"


def filled(*tabs: str, most: int = 3) -> tuple[Sessions, dict[str, Page], dict[str, Session]]:
    """Sessions of tabs that are opened one after another, with their pages."""
    sessions, pages, own = Sessions(most), {tab: Page() for tab in tabs}, {tab: Session(ARM) for tab in tabs}
    for tab in tabs:
        sessions.show(tab, own[tab], pages[tab])
    return sessions, pages, own


@pytest.mark.parametrize(
    ("closed", "busy", "dropped"),
    [
        ("", "", "a"),
        ("b", "", "b"),
        ("bc", "", "b"),
        ("", "a", "b"),
        ("abc", "a", "b"),
        ("b", "b", "b"),  # whoever closed its tab does not wait for it
        ("", "abc", "a"),
    ],
)
def test_a_session_that_nobody_looks_at_makes_room(closed, busy, dropped):
    sessions, pages, own = filled("a", "b", "c")
    for tab in closed:
        pages[tab].has_socket_connection = False
    for tab in busy:
        own[tab].job = Running()
    sessions.show("d", Session(ARM), Page())
    assert [tab for tab in "abcd" if sessions.get(tab) is None] == [dropped]
    assert [tab for tab in "abc" if own[tab].dropped] == [dropped]


def test_a_tab_that_was_left_last_is_kept_longest():
    sessions, pages, _ = filled("a", "b", "c")
    for tab in "bca":
        pages[tab].has_socket_connection = False
        sessions.use(tab)
    for tab in "def":
        sessions.show(tab, Session(ARM), Page())
        assert [left for left in "bca" if sessions.get(left) is None] == list("bca")[: "def".index(tab) + 1]


def test_a_reload_keeps_the_session():
    sessions, pages, own = filled("a", "b", "c")
    pages["a"].has_socket_connection = False
    sessions.show("a", sessions.get("a"), Page())
    sessions.show("d", Session(ARM), Page())
    assert sessions.get("a") is own["a"]
    assert own["b"].dropped


def test_a_dropped_session_has_let_go_of_its_work_and_recordings():
    sessions, _, own = filled("a", most=1)
    own["a"].use([simulate(ARM, "pulse", duration=0.5, rate=100.0)])
    work = own["a"].job = Running()
    sessions.show("b", Session(ARM), Page())
    assert work.state == "stopped"
    assert (own["a"].recordings, own["a"].live, own["a"].busy) == ([], None, False)
