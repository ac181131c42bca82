"""Own files under mutation: results, stores, caches and records, as damaged or as made by someone else.

A cache gives what was kept or is computed again; a result is read or refused. The content of a sealed file is
also mutated below its seal: its hash fits, as in a file that someone made on purpose.
"""

from __future__ import annotations

import base64
import copy
import functools
import json
import random
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

import fuzz_mutation
from mascarin._io.sealed import own_files, own_records
from mascarin._io.sealed.cache import _read
from mascarin.building.outputs.output import Output
from mascarin.calibration import CalibrationProblem, Cost, Evaluator, FitParameter, FitSensor
from mascarin.calibration.base import evaluations
from mascarin.ensemble.members import Members
from mascarin.ensemble.store import Store
from mascarin.ensemble.work import Chunk
from mascarin.genopt import records as genopt_records
from mascarin.genopt.export.case import open_case
from mascarin.genopt.export.exchange import read_settings
from mascarin.genopt.records import Log, Record
from mascarin.pages.study import write_folder
from mascarin.simulation.checks.energy import FLOWS, EnergyLedger
from mascarin.simulation.checks.warning_kinds import RunWarning, WarningKind
from mascarin.simulation.records.provenance import Provenance
from mascarin.simulation.records.times import Times
from mascarin.simulation.results import Results
from mascarin.simulation.single_precision import Difference
from mascarin.study.context import step_cache as kept
from mascarin.study.context.storage import Workspace
from mascarin.study.steps.findings import PredictionIntervals
from mascarin.tables.timezones import parse_timezone

CODES = (
    "<f8",
    "<f4",
    "<i8",
    "|b1",
    "<U9",
    "<U99999999",
    "|O",
    "V8",
    "<M8[ns]",
    "f8,f8",
    "x",
    "|S4",
    "<c16",
    "",
)


@dataclass
class OwnReader:
    """A reader of own files, as `fuzz_readers.Reader`, with its own mutation of each file."""

    name: str
    files: dict[str, bytes]
    mutated: tuple[str, ...]
    read: Callable[[Path], object]
    #: Kind of the sealed files, by name.
    kinds: dict[str, str]

    def changed(self, name: str, draw: random.Random) -> bytes:
        """A mutation of a file."""
        content = self.files[name]
        kind = self.kinds.get(name)
        if kind is not None and name.endswith(".jsonl"):
            return _record(content, kind, draw)
        if kind is not None and draw.random() < 0.7:
            inner = own_files.opened(kind, content)
            return own_files.sealed(
                kind, _packed(inner, draw) if name[-8:] != ".parquet" else _bytes(inner, draw)
            )
        if name.endswith((".json", ".jsonl")) and draw.random() < 0.7:
            return _json(content, draw)
        return _bytes(content, draw)


def _bytes(content: bytes, draw: random.Random) -> bytes:
    """Bits, bytes, words of eight bytes, cuts and repetitions."""
    changed = bytearray(content)
    for _ in range(draw.choice((1, 1, 2, 4, 20))):
        if not changed:
            break
        at = draw.randrange(min(len(changed), draw.choice((300, 4000, len(changed)))))
        match draw.randrange(6):
            case 0:
                changed[at] ^= 1 << draw.randrange(8)
            case 1:
                changed[at] = draw.choice((0, 255, 127, draw.randrange(256)))
            case 2 if draw.random() < 0.2:
                del changed[max(at, 1) :]
            case 3:
                changed[at:at] = changed[at : at + 16]
            case 4:
                changed[at : at + 8] = draw.choice((b"\xff" * 8, bytes(8), (2**40).to_bytes(8, "little")))
            case _:
                del changed[at : at + draw.randrange(1, 9)]
    return bytes(changed)


def _json(content: bytes, draw: random.Random) -> bytes:
    """Values of a JSON text, or of one of its lines; or its words."""
    if draw.random() < 0.2:
        return fuzz_mutation.mutated(content, draw)
    lines = content.split(b"\n")
    try:
        trees = [json.loads(content)]
    except ValueError:
        k = draw.randrange(max(len(lines) - 1, 1))
        lines[k] = json.dumps(_tree(json.loads(lines[k]), draw)).encode()
        return b"\n".join(lines)
    return json.dumps(_tree(trees[0], draw)).encode()


def _record(content: bytes, kind: str, draw: random.Random) -> bytes:
    """Bytes of a record, or values of one of its lines, which is sealed again in half of the cases."""
    if draw.random() < 0.3:
        return _bytes(content, draw)
    lines = content.splitlines(keepends=True)
    k = draw.randrange(len(lines))
    head = kind if k == 0 else own_records.seal_of(lines[0].decode())
    entry = _tree(own_records.opened(head, lines[k]), draw)
    sealed = isinstance(entry, dict) and draw.random() < 0.5
    try:
        changed = own_records.sealed(head, entry) if sealed else json.dumps(entry) + "\n"
    except ValueError:  # a number that is not finite cannot be written
        changed = json.dumps(entry) + "\n"
    lines[k] = changed.encode()
    if k == 0 and sealed:  # the others are bound to the new first line
        first = own_records.seal_of(content.split(b"\n")[0].decode())
        further = [own_records.opened(first, line) for line in lines[1:]]
        head = own_records.seal_of(changed)
        lines[1:] = [own_records.sealed(head, line).encode() for line in further]
    return b"".join(lines)


def _tree(tree: Any, draw: random.Random) -> Any:
    for _ in range(draw.choice((1, 1, 2, 4))):
        if draw.random() < 0.05:
            return copy.deepcopy(draw.choice(fuzz_mutation.VALUES))
        if draw.random() < 0.05:
            return functools.reduce(lambda inner, _: [inner], range(draw.choice((50, 70, 900))), tree)
        fuzz_mutation.mutate(tree, draw)
    return tree


def _packed(content: bytes, draw: random.Random) -> bytes:
    """Notes, names, kinds and shapes of packed arrays."""
    if draw.random() < 0.2:
        return _bytes(content, draw)
    last = 8 + int.from_bytes(content[:8], "little")
    head = json.loads(content[8:last])
    if head["arrays"] and draw.random() < 0.4:
        entry = draw.choice(head["arrays"])
        match draw.randrange(4):
            case 0:
                entry[1] = draw.choice(CODES)
            case 1:
                entry[2] = draw.choice(
                    ([], [10**11], [-1], [2**63], [0], [1, 2, 3], [[1]], None, [1.0], [4, 4])
                )
            case 2:
                entry[0] = draw.choice(("a0", "", 5, None, "tree", "column x"))
            case _:
                head["arrays"].append(entry)
    else:
        head["notes"] = _tree(head["notes"], draw)
    text = json.dumps(head).encode()
    length = len(text) if draw.random() < 0.95 else draw.choice((0, 2**62, len(content)))
    return length.to_bytes(8, "little") + text + content[last:]


def results() -> Results:
    """Results of a run, made up."""
    outputs = [
        Output("room.air_temperature", "degC", "air_temperature", zone=0),
        Output("roof.outside_temperature", "degC", "face_temperature", surface=0, side=0),
    ]
    records = np.random.default_rng(1).normal(20.0, 2.0, (48, 2))
    return Results(
        outputs=outputs, times=Times(0.0, 3600.0 * 47, 3600.0, parse_timezone("UTC+1")), records=records,
        energy=EnergyLedger(dict.fromkeys(FLOWS, 1.0), 1.0, 2.0, 1e-12),
        provenance=Provenance("box", "ab", {"file": "x"}, 3600.0, "sdirk2", "repeat", {}, 5),
        warnings=(RunWarning("warm", WarningKind.LATENT),), vapour=None,
    )  # fmt: skip


def _of_run(at: Path, ending: str) -> None:
    read = Results.open(at / f"run{ending}")
    read.to_dataframe()
    repr(read)


MANIFEST: dict[str, Any] = {
    "mascarin_version": "1", "building": "box", "climate": {}, "measurements": None, "identity": "a",
    "samples": "b", "members": 4, "paths": ["zones.room.volume"],
    "sample_units": {"zones.room.volume": "m3"}, "seed": 1, "outputs": ["room.air_temperature"],
    "objectives": [], "kept": {"room.air_temperature": "degC"}, "step_seconds": 3600.0, "scheme": "sdirk2",
    "precision": "double", "timezone": "UTC+01:00", "time": ["2020-01-01 00:00:00", "2020-01-01 01:00:00"],
}  # fmt: skip


def _store(folder: Path, count: int) -> Store:
    """A store with some members run."""
    folder.mkdir(parents=True, exist_ok=True)
    store = Store.begin(folder, MANIFEST)
    for first in range(0, count, 2):
        members = Members({"zones.room.volume": np.array([20.0, 30.0])}, {})
        residuals, zeros = np.array([1e-12, 1e-13]), np.zeros(2)
        chunk = Chunk(first, np.ones((2, 2, 1)), residuals, zeros, {}, zeros, zeros)
        store.add(chunk, members)
    return store


def _files(folder: Path) -> dict[str, bytes]:
    return {
        file.relative_to(folder).as_posix(): file.read_bytes()
        for file in sorted(folder.rglob("*"))
        if file.is_file() and file.name not in (".lock", "lock")
    }


def _shown(at: Path) -> None:
    store = Store(at)
    repr(store)
    store.to_dataframe()
    store.warnings()
    store.to_xarray()


def _continued(at: Path) -> None:
    store = Store.begin(at, MANIFEST)
    for first, _ in store.gaps():
        assert first in (0, 2)
    if not store.gaps():
        store.finish([Difference("room.air_temperature", "K", 1e-3, 2e-3, 4)])
        store.to_xarray()


INPUTS = {"mascarin_version": "1", "study": "ab"}


def _study(folder: Path) -> None:
    """What a study keeps."""
    with Workspace(folder, INPUTS) as workspace:
        _use(workspace)
        (folder / "tables").mkdir(exist_ok=True)
        (folder / "tables" / "a.csv").write_text("a\n")
        workspace.record("study", [folder / "tables" / "a.csv"])
        workspace.keep("sensitivity-x", 0, {"values": np.ones((2, 3, 1)), "judged": np.zeros((2, 2))})


def _use(workspace: Workspace) -> None:
    problem = object()
    intervals = PredictionIntervals(
        0.95, np.ones((3, 2)), np.zeros((3, 2)), np.ones(2), {"blind": np.array([0.5])}, np.ones(1)
    )
    content = (intervals, problem, {"a": [1, 2.5, None], "b": (True, "x")}, np.float64(0.1))
    kept.kept(workspace, "key", lambda: content, (problem,))


def _again(at: Path) -> None:
    with Workspace(at, INPUTS) as workspace:
        _use(workspace)
        list(workspace.kept("sensitivity-x"))
        workspace.record("study", [])
        workspace.drop("sensitivity")


def _problem() -> CalibrationProblem:
    return CalibrationProblem(
        (FitParameter("level", 0.0, 10.0),),
        (FitSensor("room", np.array([4.0, 6.0]), 0.1),),
        lambda x: np.tile(x[:, :, None], (1, 2, 1)),
    )


def _recorded(at: Path) -> None:
    with Evaluator(Cost(_problem(), "rmse"), at / "record.jsonl", keep_residuals=True) as evaluator:
        evaluator.costs(np.array([[5.0], [6.0]]))
        evaluator.residuals(np.array([[5.0]]))
        evaluator.trace()


def _resumed(at: Path) -> None:
    log = Log(at / "log.jsonl")
    try:
        log.resume({"a": "b"})
    finally:
        log.close()


def _report_files() -> dict[str, bytes]:
    times = pd.date_range("2024-01-01", periods=6, freq="1h")
    table = pd.DataFrame({"time": [t.isoformat() for t in times], "room.measured": 20.0, "room.fitted": 20.5})
    study = {
        "title": "A study", "sensor_info": {"room": {"label": "Room", "output": "room.air_temperature",
        "unit": "degC", "uncertainty": 0.2}}, "models": {"fitted": {"label": "fitted"}},
        "periods": {"identification": {"label": "I", "note": "n",
                                       "spans": [["2024-01-01T00:00", "2024-01-01T05:00"]]}},
        "parameters": {"a.b": {"nominal": 1.0, "fitted": 2.0, "low": 1.5, "high": 2.5, "unit": "-",
        "interval": [1.5, 2.5], "range": [0, 3]}},
    }  # fmt: skip
    return {"study.json": json.dumps(study).encode(), "tables/series.csv": table.to_csv(index=False).encode()}


def readers(folder: Path) -> list[OwnReader]:
    """Every reader of own files."""
    folder.mkdir(parents=True, exist_ok=True)
    run = results()
    for ending in (".nc", ".csv", ".parquet"):
        run.write(folder / f"run{ending}")
    done, half, study = (Path(tempfile.mkdtemp(dir=folder)) for _ in range(3))
    _store(done, 4).finish()
    _store(half, 4)
    _study(study)
    with Evaluator(Cost(_problem(), "rmse"), folder / "record.jsonl", keep_residuals=True) as evaluator:
        evaluator.costs(np.array([[5.0], [6.0]]))
        evaluator.residuals(np.array([[5.0]]))
    slopes = {"x": [5.0], "j": base64.b64encode(np.ones(2).tobytes()).decode()}
    first = (folder / "record.jsonl").read_text().splitlines()[0]
    with (folder / "record.jsonl").open("a") as file:
        file.write(own_records.sealed(own_records.seal_of(first), slopes))
    log = Log(folder / "log.jsonl")
    log.begin({"a": "b"})
    for k in range(3):
        log.add(Record((1, (0.5, float(k)), (1,)), (1.0,), 0.1, 1, "", k + 1))
    log.close()
    packed = own_files.packed({"format": 2, "inputs": {"files": ["/dev/zero"]}}, {"forcing": np.ones(3)})
    weather = own_files.packed({"grid": {"start": 1.0}}, {"column a": np.ones(4), "lines": np.ones(4)})
    run_files = {name: (folder / name).read_bytes() for name in ("run.nc", "run.csv", "run.parquet")}
    beside = {"run.csv-metadata.json": (folder / "run.csv-metadata.json").read_bytes()}
    kinds = {name: Path(name).name for name in _files(half) if name.startswith("pieces/")}
    sealed = {name: Path(name).stem for name in _files(study) if name.endswith(".npz")}
    sealed |= {name: Path(name).name for name in _files(study) if name.endswith(".npy")}
    nc, csv, parquet = (functools.partial(_of_run, ending=e) for e in (".nc", ".csv", ".parquet"))
    return [
        OwnReader("own NetCDF", {"run.nc": run_files["run.nc"]}, ("run.nc",), nc, {}),
        OwnReader("own CSV", {"run.csv": run_files["run.csv"], **beside}, ("run.csv", *beside), csv, {}),
        OwnReader("own Parquet", {"run.parquet": run_files["run.parquet"]}, ("run.parquet",), parquet, {}),
        OwnReader("own store", _files(done), tuple(_files(done)), _shown, {}),
        OwnReader("own store resumed", _files(done), tuple(_files(done)), _continued, {}),
        OwnReader("own pieces", _files(half), tuple(_files(half)), _shown, kinds),
        OwnReader("own pieces resumed", _files(half), tuple(_files(half)), _continued, kinds),
        OwnReader("own study", _files(study), tuple(_files(study)), _again, sealed),
        OwnReader("own record", {"record.jsonl": (folder / "record.jsonl").read_bytes()}, ("record.jsonl",),
                  _recorded, {"record.jsonl": evaluations._KIND}),
        OwnReader("own log", {"log.jsonl": (folder / "log.jsonl").read_bytes()}, ("log.jsonl",),
                  _resumed, {"log.jsonl": genopt_records._KIND}),
        OwnReader("own case", {"case.npz": own_files.sealed("compiled case", packed)}, ("case.npz",),
                  lambda at: open_case(at / "case.npz", "study.yaml"), {"case.npz": "compiled case"}),
        OwnReader("own weather", {"a.bin": own_files.sealed("weather", weather)}, ("a.bin",),
                  lambda at: _read(at / "a.bin"), {"a.bin": "weather"}),
        OwnReader("own settings", {"coupling.json": b'{"mascarin_coupling": 1, "study": "study.yaml"}'},
                  ("coupling.json",), read_settings, {}),
        OwnReader("own report", _report_files(), tuple(_report_files()), write_folder, {}),
    ]  # fmt: skip
