"""Files for the command lines that are attacked: right ones, wrong ones, and right ones that are damaged by a draw."""

import json
import shutil
from pathlib import Path
from random import Random

import numpy as np
from tests.helpers.everything import machine_with_everything

import flexapod as fx

#: Right files of every kind that a command reads; their machine is full.toml, or that of lengths.csv and mukherjee-i.
TABLES = {
    "way.csv": "t,x,y,z,roll,pitch,yaw\n0,0,0,0.89,0,0,0\n1,0,0,0.9,0,0,0\n",
    "from_home.csv": "t,x_mm,y,z,roll,pitch,yaw,weight\n0,0,0,0,0,0,0,1\n0.5,1,0,0.001,0,0.1,0,1\n1,0,0,0,0,0,0,1\n",
    "lengths.csv": "leg1,leg2,leg3,leg4,leg5,leg6\n" + ",".join(["0.12"] * 6) + "\n",
    "full_lengths.csv": "leg1,leg2,leg3,leg4,leg5,leg6\n" + ",".join(["0.268"] * 6) + "\n",
    "poses.csv": "x_mm,y,z,roll,pitch_rad,yaw\n0,0,0.244,0,0,0\n1,0,0.2445,0.1,0.001,0\n",
    "psd.csv": "frequency_hz,z_g2/Hz\n1,1e-9\n300,1e-9\n",
    "load.csv": "frequency_hz,force_z,moment_x_N2_m2_per_Hz\n1,1,1\n300,1,1\n",
    "cases.csv": "case,elevation,force_x_kN,at_z_mm,moment_z\na,90,0.1,10,0\nb,45,0,0,1\n",
    "payloads.csv": "case,mass,x,y,z,ixx,iyy,izz,force_x\nfull,5,0,0,0.1,0.1,0.1,0.1,0\nwind,0,0,0,0,0,0,0,9\n",
    "recording.csv": "time,z_um,roll_deg\n0,0,0\n0.01,1,0.001\n0.02,0,0\n0.03,-1,0\n",
}
CELLS = (
    "",
    " ",
    "nan",
    "inf",
    "-1",
    "0",
    "1e308",
    "1e-320",
    "1e9",
    "x",
    "1,5",
    '"',
    "\0",
    "1_0",
    "\u00b2",
    "=1+1",
    "1" * 400,
)
UNITS = ("_mm", "_kg", "_deg", "_rad", "_N", "_lb", "_Hz", "_per_Hz", "_g2/Hz", " [m]", " (s)", "_", "_um2", "1")
_WRONG = {
    "file": "x",
    "empty.csv": "",
    "odd.csv": "t;x;t\n1;2\n\u00b2;;;\n",
    "long.csv": "t,x\n0," + "1" * 200_000 + "\n",
    "bad.toml": "name = 3\n[legs]\nstiffness = 'x'\n",
    "deep.toml": ".".join(["a"] * 2000) + "=1\n",
}
NAMES = ("", ".", "nothing.csv", *_WRONG, *TABLES, "bytes.csv", "none.npy", "objects.npy", "fields.npy", "complex.npy", "zip.npy",
         "proved.json", "full.toml", "a\0b", "folder")  # fmt: skip
DAMAGED = "damaged.csv"  #: made anew for each command line


def write(folder: Path) -> None:
    """All of these files."""
    (folder / "folder").mkdir()
    for name, text in {**_WRONG, **TABLES}.items():
        (folder / name).write_text(text, encoding="utf-8")
    (folder / "bytes.csv").write_bytes(bytes(range(256)))
    (folder / "none.npy").write_bytes(b"")
    np.save(folder / "objects.npy", np.array([{}]), allow_pickle=True)
    np.save(folder / "fields.npy", np.zeros(3, dtype=[("x", "f8")]))
    np.save(folder / "complex.npy", np.ones((2, 6)) * 1j)
    np.savez(folder / "zip.npz", a=np.ones(6))
    shutil.move(folder / "zip.npz", folder / "zip.npy")
    full = machine_with_everything()
    full.save(folder / "full.toml")
    fx.certify(full, fx.Box.about(fx.home_pose(full), 1e-4, 1e-3), at_least=1.0, path=folder / "proved.json")


def damage(folder: Path, draw: Random) -> None:
    """DAMAGED: one of the right tables, or the certificate, with one to three things wrong."""
    name = draw.choice([*TABLES, "proved.json"])
    text = (folder / name).read_text(encoding="utf-8")
    for _ in range(draw.choice((1, 1, 2, 3))):
        text = _of_json(text, draw) if name.endswith(".json") else _of_table(text, draw)
    (folder / DAMAGED).write_text(text, encoding="utf-8")


def _of_table(text: str, draw: Random) -> str:
    rows = [row.split(",") for row in text.splitlines()]
    at = draw.randrange(len(rows))
    row = rows[at]
    kind = draw.randrange(8)
    if kind == 0 and row:
        row[draw.randrange(len(row))] = draw.choice(CELLS)
    elif kind == 1 and rows[0]:
        rows[0][draw.randrange(len(rows[0]))] += draw.choice(UNITS)
    elif kind == 2:
        rows.insert(at, list(row))  # twice
    elif kind == 3:
        draw.shuffle(rows)
    elif kind == 4 and row:
        row.pop()
    elif kind == 5:
        del rows[at]
    elif kind == 6 and row:
        column = draw.randrange(len(row))
        rows = [[*one, *one[column : column + 1]] for one in rows]  # a column twice
    else:
        between = draw.choice((";", "\t", " ", ", ", "|"))
        return draw.choice(("", "\ufeff", "# made by hand\n")) + "\n".join(between.join(one) for one in rows)
    return "\n".join(",".join(one) for one in rows) + "\n"


def _of_json(text: str, draw: Random) -> str:
    """A key with another value, or bytes lost; a document that is read no more stays as it is."""
    try:
        document = json.loads(text)
    except ValueError:
        return text
    if draw.random() < 0.2 or not isinstance(document, dict):
        return text[: draw.randrange(len(text))]
    document[draw.choice(sorted(document))] = draw.choice([None, "", "x", 0, -1, 1e308, [], {}, [[1]], True, "nan"])
    return json.dumps(document)
