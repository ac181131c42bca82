from __future__ import annotations

import json
from pathlib import Path

import pytest

from mascarin import cli


def run(capsys: pytest.CaptureFixture[str], *words: str, code: int = 0) -> tuple[str, str]:
    assert cli.main(["materials", *words]) == code
    out, err = capsys.readouterr()
    return out, err


def test_list(capsys: pytest.CaptureFixture[str]) -> None:
    out, _ = run(capsys, "--melting", "22..24", "--kind", "salt hydrate")
    assert [line.split()[0] for line in out.splitlines()] == ["product", "savE-HS22", "ClimSel-C21", "SP24E"]
    assert "23.9" in out


def test_one_in_full(capsys: pytest.CaptureFixture[str]) -> None:
    out, _ = run(capsys, "rt25hc")
    assert "198.904 kJ/kg" in out
    assert "my_pcm: {product: RT25HC}" in out
    assert "Data sheet Rubitherm RT25HC" in out
    out, _ = run(capsys, "SmartBoard-21")
    assert "far above the 21 of the name" in out


def test_json(capsys: pytest.CaptureFixture[str]) -> None:
    (one,) = json.loads(run(capsys, "Energain", "--json")[0])
    assert (one["latent_heat"], one["specific_heat"], one["curves"]) == (71000, [3134, 2833], {})
    assert one["freezing_temperature"] is None
    assert one["law"] == {"kind": "tanh", "width": 1.0}
    assert len(json.loads(run(capsys, "--json")[0])) >= 25


def test_plot(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "sp.svg"
    _, err = run(capsys, "SP2", "--plot", str(file))
    assert err == f"wrote {file}\n"
    assert "SP26E, heating" in file.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("RT25HD",), "Did you mean 'RT25HC'"),
        (("--kind", "salt"), "salt hydrate"),
        (("--melting", "22-28"), "expected LOW..HIGH"),
        (("--melting", "28..22"), "lower end first"),
        (("--plot", "x.svg"), "narrow the search"),
    ],
)
def test_refusals(words: tuple[str, ...], message: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert message in run(capsys, *words, code=2)[1]
