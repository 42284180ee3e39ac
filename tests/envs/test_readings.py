"""Names of observations, infos and watched quantities follow their values, whatever the order of rows."""

import subprocess
import sys
import textwrap

import numpy as np
import pytest

from slipgym._numba.compiled import compiled
from slipgym._numba.generate import generate
from slipgym.config import load
from slipgym.envs.infos import NUMBERS
from slipgym.envs.nan_guard import QUANTITIES
from slipgym.envs.observation import SENSORS
from slipgym.envs.privileged import PRIVILEGED
from slipgym.envs.readings import row_writer
from slipgym.tasks.task import Column

RECORD = np.dtype([("x", "f8"), ("force", "f8", 2)])
TABLE = (
    Column("x", 0.0, 1.0, "m", "position", "records[i].x"),
    Column("force_1", 0.0, 1.0, "N", "force", "records[i].force[0]"),
    Column("force_2", 0.0, 1.0, "N", "force", "records[i].force[1]"),
)


def written(table, name):
    """Name -> value of environment 1."""
    write = row_writer(name, [column.read for column in table], ("records",), __file__, "Write the table.")
    records, row = np.zeros(2, RECORD), np.zeros(len(table))
    records[1] = (1.0, (2.0, 3.0))
    write(row, 1, records)
    return dict(zip((column.name for column in table), row.tolist(), strict=True))


def test_names_follow_values_when_rows_are_swapped():
    expected = {"x": 1.0, "force_1": 2.0, "force_2": 3.0}
    assert written(TABLE, "in_order") == expected
    assert written((TABLE[2], TABLE[0], TABLE[1]), "swapped") == expected


def test_no_name_and_no_expression_stands_twice():
    infos = [(info.name, read) for info in NUMBERS for read in info.reads]
    tables = {
        "sensors": [(reading.name, reading.read) for reading in SENSORS],
        "privileged": [(reading.name, reading.read) for reading in PRIVILEGED],
        "quantities": [(quantity.name, quantity.read) for quantity in QUANTITIES],
    }
    for name, rows in tables.items():
        assert len({row[0] for row in rows}) == len(rows), name
    for name, rows in {**tables, "infos": infos}.items():
        assert len({row[1] for row in rows}) == len(rows), name


def test_observation_columns_name_the_values_of_the_simulation(make):
    env = make("slipgym/LinearSlip-v0", observation_mode="dict")
    env.reset(seed=0)
    for _ in range(5):
        observation, _, _, _, info = env.step(np.array([-0.8], np.float32))
    simulation = env.simulation
    measured = dict(zip((column.name for column in env.columns), observation["policy"], strict=True))
    names = (column.name for column in env.privileged_columns)
    true = dict(zip(names, observation["privileged"], strict=True))
    for f in (0, 1):
        for k, name in enumerate(("f_x", "f_y", "f_n", "tau")):
            assert measured[f"{name}_{f + 1}"] == np.float32(simulation.wrenches[0, f, k])
        for k, name in enumerate(("v_x", "v_y", "omega")):
            assert measured[f"{name}_{f + 1}"] == np.float32(simulation.twists[0, f, k])
        for k, name in enumerate(("friction_x", "friction_y", "friction_tau")):
            assert true[f"{name}_{f + 1}"] == np.float32(info["contact_wrench"][f, k])
        assert true[f"grip_force_{f + 1}"] == np.float32(info["grip_force"][f])
    assert measured["commanded_force"] == np.float32(simulation.episode["command"][0])
    for k, name in enumerate(("mu_s", "mu_c", "r")):
        assert measured[name] == np.float32(info["estimated"][k])
        assert measured[f"confidence_{name}"] == np.float32(simulation.estimated[0, 3 + k])
        assert true[name] == np.float32(info["true"][k])
    assert true["object_mass"] == np.float32(simulation.plant.world["mass"][0])


def test_limits_follow_the_configuration():
    config = load({"gripper": {"force_limit": 50.0}})
    columns = {reading.name: reading.column(config) for reading in (*SENSORS, *PRIVILEGED)}
    assert columns["commanded_force"].high == columns["grip_force_1"].high == 50.0
    assert columns["friction_x_1"].high == 500.0
    assert columns["f_x_1"].low == -config.sensors.force_torque.force_range


def test_an_expression_that_is_no_python_names_its_line():
    with pytest.raises(SyntaxError):
        generate("broken", ("row",), ["row[0] = 1 +"], {}, compiled, __file__, "")


@pytest.mark.slow
def test_another_process_loads_it_from_the_cache_and_a_changed_constant_is_noticed(tmp_path):
    (tmp_path / "table.py").write_text(
        textwrap.dedent("""
        import sys
        import numpy as np
        from slipgym._numba.compiled import compiled
        from slipgym._numba.generate import generate

        body = [f"row[0] = scale * {sys.argv[1]}"]
        write = generate("write", ("row",), body, {"scale": 2.0}, compiled, __file__, "Write.")
        row = np.zeros(1)
        write(row)
        print(row[0], sum(write.stats.cache_hits.values()))
        """)
    )

    def run(factor):
        command = [sys.executable, str(tmp_path / "table.py"), factor]
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.split()

    assert run("3.0") == ["6.0", "0"]
    assert run("3.0") == ["6.0", "1"]
    assert run("4.0") == ["8.0", "0"]
    assert run("3.0") == ["6.0", "1"]
