"""The pages say what the code does."""

import re
import tomllib
from pathlib import Path

import pytest

from stackloft.contracts.stack_file import StackFile, parse_stack_file

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


def blocks(page, language):
    return re.findall(rf"```{language}\n(.*?)```", page.read_text(encoding="utf-8"), flags=re.DOTALL)


def test_the_stack_toml_shown_is_read_and_every_key_is_explained():
    page = ROOT / "docs" / "stack-toml.md"
    (example,) = blocks(page, "toml")
    said = parse_stack_file(example)
    assert said.pixel_size == 0.3
    assert set(tomllib.loads(example)) | {"positions"} == set(StackFile.model_fields)
    for key in StackFile.model_fields.keys() - {"slice"}:
        assert f"| `{key}` |" in page.read_text(encoding="utf-8"), key


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_flag_shown_exists(stackloft, page):
    known = {"--help", "--no-build-isolation", "--no-deps"}  # the last two are pip's
    for command in (
        "measure",
        "info",
        "mesh",
        "phantom",
        "regress",
        "convergence",
        "accuracy",
        "plugins list",
    ):
        known |= set(re.findall(r"--[a-z-]+", stackloft(*command.split(), "--help").stdout))
    shown = set(re.findall(r"(?<=[\s`])--[a-z][a-z-]*[a-z]\b(?!-)", page.read_text(encoding="utf-8")))
    assert shown <= known


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_link_leads_somewhere(page):
    for target in re.findall(r"\]\((?!https?:)([^)#]+)", page.read_text(encoding="utf-8")):
        assert (page.parent / target).exists(), target


def test_every_target_the_readme_names_is_in_the_makefile():
    makefile = (ROOT / "Makefile").read_text()
    for target in re.findall(r"make ([a-z]+)", (ROOT / "README.md").read_text(encoding="utf-8")):
        assert re.search(rf"^{target}:", makefile, flags=re.MULTILINE), target


def test_the_python_shown_runs(capsys):
    (snippet,) = blocks(ROOT / "README.md", "python")
    exec(snippet.replace("sample_stacks", str(ROOT / "sample_stacks")), {})
    value, unit = capsys.readouterr().out.split()
    assert unit == "mm³"
    assert float(value) > 1e5
