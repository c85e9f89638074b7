"""A controller that imports the package gets numpy and the standard library, nothing else."""

import os
import subprocess
import sys

PROGRAM = """
import sys
from tuning_tables import decide_for, read_json
table = read_json(sys.argv[1])
assert decide_for(table, 0, 4.0, 9.0) == 1
heavy = {"h5py", "scipy", "numba", "matplotlib", "control", "pydantic", "synth", "plant_models"}
print(sorted(heavy & set(sys.modules)))
"""


def test_loading_and_asking_a_table_imports_nothing_heavy(linear_table, tmp_path):
    from tuning_tables import write_json

    write_json(linear_table, tmp_path / "table.json")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-c", PROGRAM, str(tmp_path / "table.json")]
    ended = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert ended.stdout.strip() == "[]"
