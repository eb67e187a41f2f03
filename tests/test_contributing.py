"""The examples of CONTRIBUTING.md run as they stand there."""

import re
from pathlib import Path

TEXT = (Path(__file__).parents[1] / "CONTRIBUTING.md").read_text(encoding="utf-8")


def test_a_contact_law_of_ones_own(capsys):
    (example,) = re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL)
    lines = example.split("surface =")[0].strip().splitlines()[2:]
    assert len([line for line in lines if line]) <= 15
    exec(compile(example, "CONTRIBUTING.md", "exec"), {})
    assert "Ensemble of 100 surfaces of 300 asperities" in capsys.readouterr().out
