"""The README: its Python runs, its case file is valid, its commands exist."""

import re
import tomllib
from pathlib import Path

import pytest
from typer.testing import CliRunner

from sphframe.cases import load_case
from sphframe.cli.app import app

ROOT = Path(__file__).parent.parent
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", TEXT, flags=re.DOTALL)


@pytest.mark.parametrize("block", blocks("python"), ids=lambda block: block.splitlines()[0])
def test_python_runs(block: str) -> None:
    exec(compile(block, "README.md", "exec"), {})


def test_case_file_is_valid(tmp_path: Path) -> None:
    text = next(block for block in blocks("toml") if "[[walls]]" in block)
    (tmp_path / "slope.toml").write_text(text)
    load_case(tmp_path / "slope.toml")


def test_every_toml_block_is_toml() -> None:
    for block in blocks("toml"):
        tomllib.loads(block)


def test_commands_exist() -> None:
    commands = set(re.findall(r"(?:^    |`|uv run )sphframe ([a-z-]+)", TEXT, flags=re.MULTILINE))
    assert {"run", "list", "show", "verify"} <= commands
    for command in commands:
        assert CliRunner().invoke(app, [command, "--help"]).exit_code == 0, command


def test_commands_run_in_their_order(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """At tiny settings; commands that run many cases, such as ``compare`` and ``rank``, are tested elsewhere."""
    monkeypatch.chdir(tmp_path)
    lines = re.findall(r"^    (?:.* && )?uv run sphframe (.*?)(?: +# .*)?$", TEXT, flags=re.MULTILINE)
    tiny = ["--set", "particle_spacing=0.06", "--until", "0.02", "--threads", "1"]
    ran = []
    for line in lines:
        name, *arguments = re.sub(r" --set particle_spacing=\S+| --preset \S+", "", line).split()
        if name not in ("bench", "compare", "rank", "reproduce", "watch"):
            again = name == "run" and arguments[0].endswith(".nc")
            extra = tiny if name == "run" and not again else []
            extra += ["--output", "paper.nc"] if "--preset" in line else []  # its parameters would take long
            arguments = ["0.01" if argument == "0.5" else argument for argument in arguments]
            result = CliRunner().invoke(app, [name, *arguments, *extra])
            assert result.exit_code == 0, f"{line}\n{result.output}"
            ran.append(name)
    assert {"run", "animate", "plot", "list", "show"} <= set(ran)
    for made in ("dam-break.nc", "dam-break.png", "dam-break.mp4", "again.nc"):
        assert (tmp_path / made).stat().st_size > 1000


def test_links_lead_somewhere() -> None:
    for target in re.findall(r"\]\(([^)]+)\)", TEXT):
        if not target.startswith("http"):
            assert (ROOT / target).exists(), f"README.md links to {target}"


def test_every_command_is_run_by_uv() -> None:
    assert not re.findall(r"^    sphframe .*", TEXT, flags=re.MULTILINE)
    assert "git clone https://github.com/sphframe/sphframe" in TEXT


def test_test_command_is_the_one_that_runs_in_ci() -> None:
    command = "pip install uv && uv run pytest"
    assert f"    {command}\n" in TEXT
    assert command in (ROOT / ".ci" / "run").read_text(encoding="utf-8").splitlines()
