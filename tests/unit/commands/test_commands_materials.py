from __future__ import annotations

import json
from pathlib import Path

import pytest

from building_samples import ROOM
from dsc_samples import LATENT, heat, temperatures, write
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
        (("RT25HC", "--plot", "x.doc"), "--plot: found 'x.doc'; expected a file ending in .svg"),
    ],
)
def test_refusals(words: tuple[str, ...], message: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert message in run(capsys, *words, code=2)[1]


def test_a_material_from_a_calorimeters_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    t = temperatures()
    file = write(tmp_path / "my wax.csv", {"temperature [degC]": t, "cp [J/(g K)]": heat(t) / 1000})
    out, picture = tmp_path / "wax.yaml", tmp_path / "wax.svg"
    words = [
        "dsc",
        str(file),
        "-o",
        str(out),
        "--law",
        "tanh",
        "--conductivity",
        "0.22,0.18",
        "--density",
        "855",
    ]
    assert cli.main([*words, "--plot", str(picture)]) == 0
    printed, err = capsys.readouterr()
    assert "latent heat    150.0 kJ/kg" in printed
    assert f"wrote {out}" in err
    assert picture.stat().st_size > 1000
    building = tmp_path / "building.yaml"
    lines = "\n".join(
        line for line in out.read_text(encoding="utf-8").splitlines() if not line.startswith("#")
    )
    building.write_text(ROOM.replace("materials:", lines), encoding="utf-8")
    assert cli.main(["parameters", str(building), "materials.my_wax.*"]) == 0
    listed = capsys.readouterr()[0]
    assert "materials.my_wax.law.width" in listed
    assert cli.main(["dsc", str(file), "--json"]) == 0
    found = json.loads(capsys.readouterr()[0])
    assert found["runs"]["heating"]["latent_heat"] == pytest.approx(LATENT, rel=2e-3)
    assert found["material"]["law"]["kind"] == "table"
    assert cli.main(["dsc", str(file), "--density", "heavy"]) == 2
    assert "expected VALUE or SOLID,LIQUID" in capsys.readouterr()[1]
