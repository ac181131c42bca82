"""Odd inputs, streams and surroundings: a command says what is wrong and ends with the code of its kind."""

from __future__ import annotations

import contextlib
import http.client
import io
import json
import os
import re
import stat
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from conftest import SEED  # noqa: F401 (the seed is shown in the head of the report)

from building_samples import ROOM
from design_support import STUDY as DESIGN
from dsc_samples import temperatures
from fuzz_readers import epw_text
from idf_samples import IDF
from mascarin import cli
from mascarin._io.terminal import printable
from mascarin.examples import box, box_climate
from mascarin.pages.explore import Server, Session
from mascarin.pages.explore.server import HOST, TOKEN
from study_support import STUDY

posix = pytest.mark.skipif(os.name != "posix", reason="streams and limits of POSIX systems")
HIDDEN = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u202a-\u202e\u2066-\u2069]")


@pytest.fixture
def place(tmp_path: Path) -> Path:
    (tmp_path / "room.yaml").write_text(ROOM, encoding="utf-8")
    (tmp_path / "site.epw").write_text(epw_text(), encoding="utf-8")
    return tmp_path


def said(*words: str) -> tuple[int, str, str]:
    """Exit code, standard output and standard error of a command in this process."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = cli.main(list(words))
    return code, out.getvalue(), err.getvalue()


def started(*words: str, redirected: str = "", **options: Any) -> subprocess.CompletedProcess[str]:
    """A command in a process of its own; `redirected`: redirections of a shell."""
    command = [sys.executable, "-m", "mascarin.cli", *words]
    if redirected:
        command = ["/bin/sh", "-c", f'"$0" "$@" {redirected}', *command]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=120, **options)


def run(place: Path, *more: str) -> list[str]:
    return ["run", str(place / "room.yaml"), "--weather", str(place / "site.epw"), "--end", "1995-01-02",
            "--step", "1h", *more]  # fmt: skip


# --- odd files ----------------------------------------------------------------------------------------------

DSC = "temperature [degC],cp heating [J/(g K)]\n" + "".join(
    f"{t:.2f},{2.0:.2f}\n" for t in temperatures()[::8]
)
#: Channels of the weather that the measured table does not have.
ABSENT = (
    "wind_speed",
    "wind_direction",
    "dew_point",
    "global_horizontal",
    "diffuse_horizontal",
    "direct_normal",
)
#: Commands that read a file: its ending, a file that is read, and the words.
READ: dict[str, tuple[str, str, Callable[[str, Path], list[str]]]] = {
    "check": (".yaml", ROOM, lambda file, at: ["check", file]),
    "weather": (".csv", "time,a\n2001-01-01,1\n2001-01-02,2\n", lambda file, at: ["weather", file]),
    "epw": (".epw", epw_text()[:3000], lambda file, at: ["weather", file]),
    "measured": (
        ".csv",
        "time,a,b\n2001-01-01 00:00,1,2\n2001-01-01 01:00,2,3\n",
        lambda file, at: [
            "run", str(at / "room.yaml"), "--weather", file, "--column", "air_temperature=a",
            *(f"--column={name}=none" for name in ABSENT), "--timezone", "UTC",
        ],
    ),
    "dsc": (".csv", DSC, lambda file, at: ["dsc", file]),
    "convert": (".idf", IDF, lambda file, at: ["convert", file, "-o", str(at / "made.yaml")]),
    "epjson": (".epJSON", "{}", lambda file, at: ["convert", file, "-o", str(at / "made.yaml")]),
    "samples": (
        ".csv",
        "zones.room.volume\n40\n",
        lambda file, at: ["sweep", str(at / "room.yaml"), "--weather", str(at / "site.epw"), "-o",
                          str(at / "store"), "--samples", file, "--end", "1995-01-02", "--step", "3h",
                          "--objective", "max:room.air_temperature"],
    ),
    "ranges": (
        ".csv",
        "case,quantity,unit,min,max\nroom,annual_heating,MWh,1,2\n",
        lambda file, at: ["bestest", "--building", str(at / "room.yaml"), "--ranges", file],
    ),
    "design": (".yaml", DESIGN, lambda file, at: ["design", file, "--check"]),
    "study": (".yaml", STUDY, lambda file, at: ["validate", file]),
    "optimize": (".ini", "Simulation {", lambda file, at: ["optimize", file]),
}  # fmt: skip


def odd_contents(good: str) -> Iterator[tuple[str, bytes]]:
    """Contents that a hand, another program or a broken disk makes of a file."""
    plain = good.encode()
    yield "empty", b""
    yield "zeros", plain[:40] + b"\0\0" + plain[40:]
    yield "byte order mark", b"\xef\xbb\xbf" + plain
    yield "UTF-16", good.encode("utf-16")
    yield "no text", bytes(range(256)) * 8
    yield "a quote that does not end", plain + b'\n"' + b"y" * 140_000 + b"\n"
    yield "a long field", b"x" * 140_000 + b"," + plain
    yield "huge numbers", plain.replace(b"1", b"1e400")
    yield "many digits", plain.replace(b"1", b"1" * 5000, 2)
    yield "deep lists", plain + b"\nx: " + b"[" * 5000 + b"]" * 5000
    yield "deep JSON", b'{"a":' * 20_000 + b"1" + b"}" * 20_000
    yield (
        "aliases",
        b"a: &a [x,x,x,x,x,x,x,x,x]\n"
        + b"".join(
            b"%c: &%c [%s]\n" % (98 + k, 98 + k, b",".join([b"*%c" % (97 + k)] * 9)) for k in range(9)
        ),
    )
    yield "escapes", b'name: "\\e]0;x\\a\\e[31m\\u202e"\n' + plain
    yield "control characters", b"\x1b[31m\xc2\x9b31m\xe2\x80\xae: 3\n" + plain


@pytest.mark.parametrize("name", READ)
def test_an_odd_file_is_read_or_refused(name: str, place: Path) -> None:
    ending, good, words = READ[name]
    for kind, content in odd_contents(good):
        file = place / f"odd{ending}"
        file.write_bytes(content)
        code, out, err = said(*words(str(file), place))
        assert code in (0, 1, 2), (kind, err[-500:])
        assert code != 2 or err.startswith(("error: ", "warning: ")), (kind, err[-500:])
        assert not HIDDEN.search(out + err), kind


@posix
@pytest.mark.parametrize("name", READ)
def test_what_is_no_file_is_refused(name: str, place: Path) -> None:
    ending, _, words = READ[name]
    kinds = {kind: place / f"{kind}{ending}" for kind in ("folder", "pipe", "circle", "missing", "n" * 300)}
    kinds["folder"].mkdir()
    os.mkfifo(kinds["pipe"])
    kinds["circle"].symlink_to(kinds["circle"])
    names = [*map(str, kinds.values()), "/dev/full", "", ".", f"a\0b{ending}", f"\udcff{ending}"]
    for file in names:
        code, _, err = said(*words(file, place))
        # GenOpt has exit code 1 for an error.
        assert code in ((1, 2) if name == "optimize" else (2,)), (file, err[-500:])
        assert "defect" not in err


@posix
def test_what_cannot_be_written_is_refused(place: Path) -> None:
    room, weather = str(place / "room.yaml"), ["--weather", str(place / "site.epw")]
    short = [*weather, "--end", "1995-01-02", "--step", "3h"]
    outputs = {
        ".csv": [["run", room, *short], ["weather", weather[1]]],
        ".nc": [["run", room, *short]],
        ".parquet": [["run", room, *short]],
        ".html": [["view", room]],
        ".fmu": [["fmu", room, *short]],
        ".yaml": [["convert", str(place / "model.idf")]],
        "": [["sweep", room, *short, "--draw", "2", "--objective", "max:room.air_temperature"]],
    }
    (place / "model.idf").write_text(IDF, encoding="utf-8")
    (place / "file").write_text("x")
    for ending, commands in outputs.items():
        (place / f"folder{ending}").mkdir(exist_ok=True)
        (place / f"folder{ending}" / "kept").write_text("x")
        os.mkfifo(place / f"pipe{ending}")
        for command in commands:
            for name in ("folder", "pipe", "none/out", "file/out", "n" * 300, "a\0b", "\udcff/x", "\udcff"):
                if not ending and name == "none/out":
                    continue  # folders are made
                odd = str(place / f"{name}{ending}")
                option = "--csv" if command[0] == "weather" else "-o"
                code, _, err = said(*command, option, odd, *(["--no-open"] if command[0] == "view" else []))
                assert code == 2, (command[0], odd, err[-400:])
                assert "defect" not in err
    assert not list(place.rglob("*.part"))


NUMBERS = ("", "nan", "inf", "-1", "0", "1e400", "9" * 400, "1e-300", "x", "1h1h", "1e30 h", "\0", "\x1b[31m")
OPTIONS = ("--step", "--start", "--end", "--initial", "--interval", "--set", "--output")


@pytest.mark.parametrize("option", OPTIONS)
def test_an_odd_value_of_an_option_is_refused(option: str, place: Path) -> None:
    for value in NUMBERS:
        words = [*run(place), option, value]
        code, out, err = said(*words)
        possible = option == "--initial" and value in ("-1", "0", "1e-300")
        assert code == (0 if possible else 2), (value, err[-400:])
        assert not HIDDEN.search(out + err)


@posix
def test_inputs_may_have_names_that_are_no_text(place: Path) -> None:
    odd = place / "\udcff\x1b[31m.yaml"
    odd.write_text(ROOM, encoding="utf-8")
    words = ["run", str(odd), *run(place)[2:]]
    for more in (["-o", str(place / "o.csv")], ["-o", str(place / "o.nc")], ["--json"],
                 ["--report", str(place / "o.html")]):  # fmt: skip
        code, out, err = said(*words, *more)
        assert code == 0, err[-400:]
        assert not HIDDEN.search(out + err)
    assert "\\udcff\\u001b[31m.yaml" in (place / "o.html").read_text(encoding="utf-8")


@posix
@pytest.mark.skipif(os.name == "posix" and os.geteuid() == 0, reason="root may read and write everything")
def test_files_and_folders_that_may_not_be_used_are_refused(place: Path) -> None:
    (place / "room.yaml").chmod(0)
    assert said(*run(place))[0] == 2
    (place / "room.yaml").chmod(stat.S_IRUSR)
    place.chmod(stat.S_IRUSR | stat.S_IXUSR)
    assert said(*run(place, "-o", str(place / "out.csv")))[0] == 2
    place.chmod(stat.S_IRWXU)


def test_a_chain_of_2000_files_is_refused(tmp_path: Path) -> None:
    (tmp_path / "b0.yaml").write_text(ROOM, encoding="utf-8")
    for k in range(1, 2001):
        (tmp_path / f"b{k}.yaml").write_text(f"extends: b{k - 1}.yaml\n", encoding="utf-8")
    code, _, err = said("check", str(tmp_path / "b2000.yaml"))
    assert code == 2
    assert "more than 100 files that extend each other" in err
    assert said("check", str(tmp_path / "b90.yaml"))[0] == 0


# --- names that act on a terminal ---------------------------------------------------------------------------


@pytest.mark.parametrize("text", ["plain\ttext\nline", "é ü °C µ – “”"])
def test_text_without_hidden_characters_stays(text: str) -> None:
    assert printable(text) == text


def test_names_do_not_reach_a_terminal_as_commands(place: Path) -> None:
    name = "a\\e]0;PWNED\\a\\e[2J\\e[31mred\\e[8m hidden\\u202Ertl\\x9b5m\\x7f"
    text = ROOM.replace("name: ", f'name: "{name}" # ', 1)
    text = text.replace("materials:\n", "materials:\n  odd: {conductivity: 1, density: 2000, "
                        "specific_heat: 900, source: \"\\e[41m\\u2066\"}\n", 1)  # fmt: skip
    (place / "room.yaml").write_text(text, encoding="utf-8")
    file, page = str(place / "room.yaml"), place / "page.html"
    odd = "\x1b[31m\u202e"
    files = [[command, file] for command in ("check", "cite", "parameters", "outputs")]
    others = [["check", file, "--set", f"{odd}=3"], ["check", f"{odd}.yaml"], [odd], ["materials", odd]]
    for words in (*files, run(place), run(place, "--report", str(page)), *others):
        code, out, err = said(*words)
        assert code in (0, 1, 2)
        assert not HIDDEN.search(out + err), words
    assert not HIDDEN.search(page.read_text(encoding="utf-8").split("<body")[1].split("<script")[0])
    code, out, _ = said(*run(place, "--json"))
    assert not HIDDEN.search(out)
    assert "\x1b]0;PWNED\a" in json.loads(out)["building"]


# --- streams and surroundings -------------------------------------------------------------------------------


@posix
@pytest.mark.parametrize("shell", ["2>&-", "<&- 2>&-", "2>/dev/full", "2</dev/null"])
def test_messages_that_nobody_reads_do_not_stop_a_run(place: Path, shell: str) -> None:
    out = place / "out.csv"
    ended = started(*run(place, "-o", str(out)), redirected=shell)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert out.read_text(encoding="utf-8").count("\n") == 26


@posix
@pytest.mark.parametrize(
    ("shell", "words"), [(">&-", "standard output is closed"), (">/dev/full", "standard output")]
)
def test_results_that_cannot_be_written_are_an_error(place: Path, shell: str, words: str) -> None:
    ended = started("check", str(place / "room.yaml"), redirected=shell)
    assert ended.returncode == 2
    assert ended.stderr.startswith("error: ")
    assert words in ended.stderr


@posix
def test_a_run_into_a_file_needs_no_output(place: Path) -> None:
    assert started(*run(place, "-o", str(place / "out.csv")), redirected=">&-").returncode == 0
    assert started(*run(place, "-o", str(place / "out.csv")), redirected=">&- 2>&- <&-").returncode == 0


@posix
@pytest.mark.parametrize("ending", ["nc", "csv", "parquet", "html"])
def test_a_limit_of_the_size_of_files_is_an_error(place: Path, ending: str) -> None:
    option = "--report" if ending == "html" else "-o"
    words = run(place, option, str(place / f"out.{ending}"))
    command = [sys.executable, "-m", "mascarin.cli", *words]
    ended = subprocess.run(
        ["/bin/sh", "-c", 'ulimit -f 1; "$0" "$@"', *command],
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    assert ended.returncode == 2, ended.stderr[-500:]
    assert "error: " in ended.stderr
    assert not (place / f"out.{ending}").exists()
    assert [file.name for file in place.iterdir() if file.suffix == ".part"] == []


@posix
def test_odd_surroundings_are_no_defect(place: Path) -> None:
    bare = {
        "PATH": os.environ["PATH"],
        "PYTHONPATH": os.pathsep.join(sys.path),
        "TMPDIR": str(place / "none"),
    }
    ended = started(*run(place, "-o", str(place / "é.csv")), env={**bare, "LC_ALL": "C"}, cwd=place)
    assert ended.returncode == 0, ended.stderr[-500:]
    for file in (b"\xff.yaml", b"\xe9"):
        command = [os.fsencode(sys.executable), b"-m", b"mascarin.cli", b"check", file]
        odd = subprocess.run(command, capture_output=True, check=False, env=bare, cwd=place, timeout=120)
        assert odd.returncode == 2, odd.stderr[-500:]


# --- requests of explore ------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def server() -> Iterator[Server]:
    from mascarin.commands.explore import _values

    session = Session(box(), box_climate(), parameters=["zones.room.volume"], options={"step": "3h"})
    running = Server(
        lambda token: "page", {"/run": lambda content: session.run(_values(content), content.get("band"))}
    )
    thread = threading.Thread(target=running.serve_forever, kwargs={"poll_interval": 0.02}, daemon=True)
    thread.start()
    yield running
    running.shutdown()
    running.server_close()


def asked(server: Server, body: bytes, **headers: str) -> tuple[int, dict[str, Any]]:
    connection = http.client.HTTPConnection(HOST, server.server_port, timeout=60)
    connection.request("POST", "/run", body, {TOKEN: server.token, **headers})
    answer = connection.getresponse()
    reply = json.loads(answer.read())
    connection.close()
    return answer.status, reply


BODIES = [
    b"", b"null", b"[]", b"3", b'"text"', b"{", b"\xff", b"[" * 30_000, b'{"a":' * 10_000, b"NaN",
    b'{"values": null}', b'{"values": []}', b'{"values": 3}', b'{"values": {"zones.room.volume": null}}',
    b'{"values": {"zones.room.volume": NaN}}', b'{"values": {"zones.room.volume": "30"}}',
    b'{"values": {"zones.room.volume": [30]}}', b'{"values": {"zones.room.volume": true}}',
    b'{"values": {"zones.room.volume": 1e400}}', b'{"values": {"zones.room.volume": -1}}',
    b'{"values": {"zones.room.volume": 1' + b"0" * 400 + b"}}",
    b'{"values": {"zones.room.volume": 1' + b"0" * 5000 + b"}}",
    b'{"values": {"\\ud800": 1}}', b'{"values": {"\\u0000": 1}}', b'{"values": {"other": 1}}',
    b'{"band": 5}', b'{"band": "20 26"}', b'{"band": {}}', b'{"band": []}',
    b'{"band": {"low": 20, "high": 26}}',
    b'{"band": [26, 20]}', b'{"band": [20]}', b'{"band": [20, 26, 30]}', b'{"band": [null, 26]}',
    b'{"band": [NaN, 26]}', b'{"band": [20, Infinity]}', b'{"band": [[20], [26]]}', b'{"band": ["20", "26"]}',
    b'{"band": [1, 1' + b"0" * 400 + b"]}", b'{"band": false}', b'{"band": [true, 26]}',
]  # fmt: skip


@pytest.mark.parametrize("body", BODIES, ids=range(len(BODIES)))
def test_a_request_is_answered_or_refused(
    server: Server, body: bytes, capfd: pytest.CaptureFixture[str]
) -> None:
    status, reply = asked(server, body)
    assert status in (200, 400)
    assert "error" in reply or "refused" in reply, (body[:60], reply)
    assert capfd.readouterr().err == ""


def test_odd_requests_are_refused(server: Server, capfd: pytest.CaptureFixture[str]) -> None:
    assert "series" in asked(server, b"{}")[1]
    lengths = [
        b"POST /run HTTP/1.1\r\nContent-Length: " + length for length in (b"9" * 5000, b"-1", b"x", b"")
    ]
    for lines in (b"GET //[ HTTP/1.1", b"GET http://[ HTTP/1.1", *lengths):
        connection = http.client.HTTPConnection(HOST, server.server_port, timeout=60)
        connection.connect()
        assert connection.sock is not None
        connection.sock.sendall(lines + f"\r\nHost: {HOST}:{server.server_port}\r\n\r\n".encode())
        assert connection.sock.recv(100).startswith((b"HTTP/1.1 4", b"HTTP/1.0 4"))
        connection.close()
    assert "Traceback" not in capfd.readouterr().err


def test_a_defect_is_said_on_the_page_and_the_server_goes_on(capfd: pytest.CaptureFixture[str]) -> None:
    def broken(content: Any) -> Any:
        raise ZeroDivisionError("one over nothing")

    running = Server(lambda token: "page", {"/run": broken})
    threading.Thread(target=running.serve_forever, kwargs={"poll_interval": 0.02}, daemon=True).start()
    for _ in range(2):
        status, reply = asked(running, b"{}")
        assert status == 500
        assert reply["error"] == "a defect in Mascarin: ZeroDivisionError: one over nothing"
    running.shutdown()
    running.server_close()
    assert "Traceback" not in capfd.readouterr().err
