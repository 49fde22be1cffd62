"""The lab in a real browser: from the upload to the fallen error, on a recording with a hidden effect."""

from __future__ import annotations

import os
import re
import signal
import socket
import struct
import subprocess
import sys
import time
import tomllib
import urllib.error
import urllib.parse
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("nicegui")
pytest.importorskip("playwright")

from browser import DESKTOP, PHONE, brightness, grave_faults, needs_chromium, opened, width_beyond
from scipy.signal import cont2discrete

import flexarm_env
from flexarm_env.recordings.recording import Recording

PROJECT = Path(flexarm_env.__file__).parents[1]
DEMO = Path(flexarm_env.__file__).parent / "demo"
ARM = """
[drive]
torque_constant = 0.33
gear_ratio = 1.5
motor_inertia = 0.00193
limit = 5.0
[hub]
inertia = 0.05
[sensors.arm_angle]
noise = "0.1 deg"
[effects.viscous]
coefficient = "0.1 Nms"
"""
#: Hidden in the recordings [Nm/rad, rad].
STIFFNESS, REST_ANGLE = 0.3, 0.2
PATIENCE = 180_000  # [ms], for a busy machine that compiles the plant first


def rigid_arm_with_a_cable(path: Path, seed: int) -> None:
    """Write a recording of the arm above with a cable, from the exact solution of J θ̈ + b θ̇ + k (θ − θ₀) = N K i."""
    inertia, viscous, torque = 0.05 + 1.5**2 * 0.00193, 0.1, 1.5 * 0.33
    a = np.array([[0.0, 1.0], [-STIFFNESS / inertia, -viscous / inertia]])
    b = np.array([[0.0, 0.0], [torque / inertia, STIFFNESS * REST_ANGLE / inertia]])
    step = 0.01
    f, g, *_ = cont2discrete((a, b, np.eye(2), np.zeros((2, 2))), step)
    draw = np.random.default_rng(seed)
    current = np.repeat(draw.uniform(-2.0, 2.0, 16), 25)
    state, angles = np.zeros(2), []
    for i in current:
        angles.append(state[0])
        state = f @ state + g @ [i, 1.0]
    noisy = np.array(angles) + draw.normal(0.0, np.deg2rad(0.1), len(angles))
    Recording.from_arrays("run", np.arange(len(current)) * step, "current", current, {"arm_angle": noisy}).write(path)


class Lab:
    """`flexarm lab` as a process."""

    def __init__(self, folder: Path, *arguments: str, before: str = "") -> None:
        program = f"{before}from flexarm_env.cli import main; main()"
        command = [sys.executable, "-c", program, "lab", "--port", "0", "--no-show", *arguments]
        environment = os.environ | {"PYTHONPATH": str(PROJECT), "PYTHONUNBUFFERED": "1"}
        self.log = (folder / "lab.log").open("w")
        self.process = subprocess.Popen(command, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=self.log, text=True)
        line = self.process.stdout.readline()
        self.url = re.search(r"http://127\.0\.0\.1:\d+/", line)[0]

    def end(self) -> int:
        self.process.send_signal(signal.SIGINT)
        try:
            return self.process.wait(30.0)
        finally:
            self.process.kill()
            self.process.stdout.close()
            self.log.close()


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    made = tmp_path_factory.mktemp("lab")
    (made / "bench.toml").write_text(ARM)
    for seed, name in enumerate(("monday", "tuesday")):
        rigid_arm_with_a_cable(made / f"{name}.csv", seed)
    return made


@pytest.fixture(scope="module")
def lab(folder) -> Iterator[Lab]:
    running = Lab(folder, "--arm", "bench.toml")
    yield running
    assert running.end() == 0
    assert "Traceback" not in (folder / "lab.log").read_text()


def upload(page, *paths: Path) -> None:
    page.get_by_label("Drop CSV files here").set_input_files(paths)


def shown_error(page) -> float:
    """The held-out error of the arm as it is now, once it has been worked out."""
    tile = page.locator(".tile").nth(1)
    page.wait_for_function("tile => /→ [0-9.]+$/.test(tile.querySelector('.number').textContent)", arg=tile.element_handle())
    return float(tile.locator(".number").inner_text().split("→")[1])


def wait_for_another_error(page, before: float) -> None:
    """Wait until the held-out error of the arm is another one than before."""
    number = page.locator(".tile .number").nth(1)
    page.wait_for_function(
        "([tile, old]) => tile.textContent.match(/→ ([0-9.]+)$/) && +RegExp.$1 !== old", arg=[number.element_handle(), before]
    )


@needs_chromium
def test_from_the_upload_to_the_fallen_error(lab, folder):
    with opened() as (page, errors):
        page.set_default_timeout(PATIENCE)
        page.goto(lab.url)
        upload(page, folder / "monday.csv", folder / "tuesday.csv")
        page.get_by_text("tuesday: 3.99 s at 100 Hz").wait_for()
        page.locator(".main-svg").first.wait_for()
        before = shown_error(page)
        assert before > 20.0

        page.get_by_role("button", name="Diagnose").click()
        page.get_by_text("Missing: cable_stiffness").wait_for()
        page.get_by_role("button", name="Add cable stiffness", exact=True).click()
        page.locator(".ranked", has_text="cable stiffness").get_by_text("added").wait_for()
        assert shown_error(page) < 1.2
        steps = page.locator(".results .ytick", has_text=re.compile(r"[0-9]$")).all_text_contents()
        falls = [float(re.search(r"[0-9.]+$", step)[0]) for step in reversed(steps)]
        assert falls[0] == pytest.approx(before, rel=0.01)
        assert falls[-2] < 1.2
        assert falls[-1] == 1.0  # the noise floor
        stiffness = page.locator(".effect", has_text="cable stiffness").locator(".value").first.inner_text()
        assert float(stiffness.split()[0]) == pytest.approx(STIFFNESS, rel=0.15)
        assert grave_faults(page) == []

        with page.expect_download() as caught:
            page.get_by_role("button", name="Arm file").click()
        table = tomllib.loads(Path(caught.value.path()).read_text())
        assert "cable_stiffness" in table["effects"]
        assert [one["name"] for one in table["origin"]["recordings"]] == ["monday", "tuesday"]
        with page.expect_download() as caught:
            page.get_by_role("button", name="Report").click()
        report = Path(caught.value.path()).read_text()
        assert "Missing: cable_stiffness" in report
        assert "flexarm diagnose monday.csv tuesday.csv" in report
        assert errors == []


@needs_chromium
def test_a_drag_moves_the_model_and_a_reload_keeps_the_state(lab, folder):
    with opened() as (page, errors):
        page.set_default_timeout(PATIENCE)
        page.goto(lab.url)
        upload(page, folder / "monday.csv")
        before = shown_error(page)
        page.get_by_role("checkbox", name="cable stiffness").click()
        slider = page.get_by_role("slider", name="cable_stiffness stiffness")
        slider.focus()
        for _ in range(20):
            slider.press("ArrowRight")
        wait_for_another_error(page, before)
        dragged = page.locator(".setting .value").first.inner_text()
        page.reload()
        page.get_by_text("monday: 3.99 s at 100 Hz").wait_for()
        page.get_by_text(dragged).first.wait_for()
        assert errors == []


@needs_chromium
def test_a_tab_that_makes_room_for_another_says_so(tmp_path):
    few = Lab(tmp_path, before="import flexarm_env.lab.server as s; s.MOST_SESSIONS = 2; ")
    try:
        with opened() as (page, errors):
            page.set_default_timeout(PATIENCE)
            page.goto(few.url)
            page.get_by_role("button", name="Start with the demo").click()
            shown_error(page)
            page.get_by_role("button", name="Diagnose").click()
            page.get_by_text(re.compile(r"Diagnosing, \d+ %")).wait_for()
            tabs = [page.context.browser.new_page() for _ in range(3)]
            for tab in tabs[:2]:
                tab.goto(few.url)
                tab.get_by_text("Drop recordings of the arm in").wait_for()
                tab.close()
            assert page.get_by_role("button", name="Stop").is_enabled()  # idle tabs that are closed made room
            tabs[2].goto(few.url)
            tabs[2].get_by_text("Drop recordings of the arm in").wait_for()
            last = page.context.browser.new_page()
            last.goto(few.url)
            tabs[2].get_by_role("alert").get_by_text("another tab took the place of this one").wait_for()
            assert page.get_by_role("button", name="Stop").is_enabled()  # nor does work that is under way
            assert errors == []
    finally:
        assert few.end() == 0
    assert "Traceback" not in (tmp_path / "lab.log").read_text()


@needs_chromium
def test_a_bad_upload_gets_its_line_and_another_tab_none_of_it(lab, folder):
    (folder / "bad.csv").write_text("time [s],current [A],arm_angle [rad]\n0,1,0\n0.1,one,0\n")
    with opened() as (page, errors):
        page.set_default_timeout(PATIENCE)
        page.goto(lab.url)
        upload(page, folder / "monday.csv", folder / "bad.csv")
        line = page.get_by_role("alert").get_by_text("bad.csv")
        line.wait_for()
        assert line.inner_text().startswith("bad.csv: row 3, column 'current': 'one' is not a number")
        page.get_by_text("monday: 3.99 s").wait_for()  # the good one is taken
        other = page.context.browser.new_page()
        other.goto(lab.url)
        other.get_by_text("Drop recordings of the arm in").wait_for()
        assert other.get_by_text("monday").count() == 0
        other.close()
        assert errors == []


@needs_chromium
def test_files_can_be_dropped_and_large_ones_are_not_taken(lab, folder):
    large = folder / "large.csv"
    with large.open("wb") as file:
        file.truncate(70 * 2**20)
    with opened() as (page, errors):
        page.set_default_timeout(PATIENCE)
        page.goto(lab.url)
        upload(page, large)
        page.get_by_role("alert").get_by_text("not taken: at most 12 files at once, of 64 MB together").wait_for()
        text = (folder / "monday.csv").read_text()
        made = "text => { const d = new DataTransfer(); d.items.add(new File([text], 'dropped.csv')); return d }"
        page.locator(".drop").dispatch_event("drop", {"dataTransfer": page.evaluate_handle(made, text)})
        page.get_by_text("dropped: 3.99 s at 100 Hz").wait_for()
        assert page.get_by_role("alert").is_hidden()
        assert errors == []


@needs_chromium
def test_files_that_were_not_taken_are_not_sent_again(lab, folder):
    with opened() as (page, _):
        page.set_default_timeout(PATIENCE)
        page.goto(lab.url)
        page.route("**/upload/**", lambda route: route.fulfill(status=507))
        upload(page, folder / "monday.csv")
        page.get_by_role("alert").get_by_text("room for them in a temporary file").wait_for()
        page.unroute("**/upload/**")
        upload(page, folder / "tuesday.csv")
        page.get_by_text("tuesday: 3.99 s at 100 Hz").wait_for()
        assert page.get_by_text("monday: 3.99 s").count() == 0


@needs_chromium
def test_a_diagnosis_shows_progress_and_stops(lab, folder):
    with opened() as (page, errors):
        page.set_default_timeout(PATIENCE)
        page.goto(lab.url)
        upload(page, folder / "monday.csv")
        shown_error(page)
        page.get_by_role("button", name="Diagnose").click()
        page.get_by_text(re.compile(r"Diagnosing, \d+ %")).wait_for()
        page.get_by_role("button", name="Stop").click()
        page.get_by_text("stopped").wait_for()
        assert page.get_by_role("button", name="Diagnose").is_enabled()
        assert errors == []


@needs_chromium
@pytest.mark.parametrize("viewport", [DESKTOP, PHONE], ids=["desktop", "phone"])
def test_axe_finds_no_serious_fault(lab, folder, viewport):
    with opened(viewport=viewport) as (page, errors):
        page.set_default_timeout(PATIENCE)
        page.goto(lab.url)
        page.get_by_text("Drop recordings of the arm in").wait_for()
        assert grave_faults(page) == []
        upload(page, folder / "monday.csv")
        shown_error(page)
        page.get_by_role("checkbox", name="coulomb", exact=True).click()
        page.get_by_role("slider", name="coulomb torque").wait_for()
        assert grave_faults(page) == []
        assert width_beyond(page) <= 0
        assert errors == []


@needs_chromium
def test_it_follows_a_dark_scheme(lab):
    with opened(color_scheme="dark") as (page, errors):
        page.set_default_timeout(PATIENCE)
        page.goto(lab.url)
        page.get_by_text("Drop recordings of the arm in").wait_for()
        corner, brightest = brightness(page)
        assert corner < 0.15
        assert brightest > 0.8
        assert errors == []


@needs_chromium
def test_the_demo_begins_with_a_click_and_an_effect_moves_its_error(lab):
    with opened() as (page, errors):
        page.set_default_timeout(PATIENCE)
        page.goto(lab.url)
        page.get_by_role("button", name="Start with the demo").click()
        before = shown_error(page)
        assert before > 10.0
        page.get_by_role("checkbox", name="backlash", exact=True).click()
        wait_for_another_error(page, before)
        assert page.get_by_role("button", name="Diagnose").is_enabled()
        assert errors == []


def answered(request: urllib.request.Request) -> int:
    try:
        with urllib.request.urlopen(request) as answer:
            return answer.status
    except urllib.error.HTTPError as refused:
        with refused:
            return refused.code


def test_only_the_machine_s_own_names_are_answered(lab):
    port = lab.url.rstrip("/").rpartition(":")[2]
    for host, status in ((f"127.0.0.1:{port}", 200), (f"evil.example:{port}", 421)):
        request = urllib.request.Request(lab.url, headers={"Host": host})
        assert answered(request) == status


def test_visitors_who_leave_at_once_leave_no_traceback(lab, folder):
    where = urllib.parse.urlsplit(lab.url)
    with urllib.request.urlopen(lab.url) as answer:
        files = re.findall(r'"(/_nicegui/[^"]+\.js)"', answer.read().decode())
    for number, path in enumerate(files * 10):
        with socket.create_connection((where.hostname, where.port)) as visitor:
            visitor.sendall(f"GET {path} HTTP/1.1\r\nHost: {where.netloc}\r\n\r\n".encode())
            time.sleep(0.001 * (number % 4))
            visitor.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))  # closed with a reset
    assert answered(urllib.request.Request(lab.url)) == 200
    assert "Traceback" not in (folder / "lab.log").read_text()


def test_a_taken_port_is_one_line(lab, folder):
    port = lab.url.rstrip("/").rpartition(":")[2]
    program = "from flexarm_env.cli import main; main()"
    command = [sys.executable, "-c", program, "lab", "--port", port, "--no-show"]
    run = subprocess.run(command, capture_output=True, text=True, env=os.environ | {"PYTHONPATH": str(PROJECT)}, check=False)
    assert run.returncode == 2
    assert len(run.stderr.splitlines()) == 1
    assert f"port {port} cannot be used" in run.stderr
