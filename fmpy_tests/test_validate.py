"""The packed FMU is well-formed and complete."""

import re
import subprocess
import sys
import zipfile
from pathlib import Path

import fmpy
from conftest import ROOT
from fmpy import simulate_fmu
from fmpy.validation import validate_fmu
from lxml import etree

LARGEST = 30e6  # bytes


def test_fmpy_finds_no_problem(packed):
    assert validate_fmu(str(packed)) == []


def schema_errors(description):
    """What the schema of the standard has against a model description."""
    schema = etree.XMLSchema(file=str(Path(fmpy.__file__).parent / "schema" / "fmi2" / "fmi2ModelDescription.xsd"))
    schema.validate(etree.fromstring(description))
    return [str(error) for error in schema.error_log]


def test_description_follows_the_schema_of_the_standard(packed):
    with zipfile.ZipFile(packed) as archive:
        description = archive.read("modelDescription.xml")
    assert schema_errors(description) == []
    assert schema_errors(description.replace(b'causality="output"', b'causality="outcome"', 1))


def fmutool_check(path):
    """Exit code and words of `fmutool -input path -check`."""
    command = "from fmu_manipulation_toolbox.cli.fmutool import fmutool; fmutool()"
    arguments = [sys.executable, "-c", command, "-input", str(path), "-check"]
    done = subprocess.run(arguments, capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def test_fmutool_finds_no_problem(packed, tmp_path):
    code, words = fmutool_check(packed)
    assert code == 0 and "compliant with FMI-2.0" in words and "ERROR" not in words, words
    broken = tmp_path / "broken.fmu"
    with zipfile.ZipFile(packed) as source, zipfile.ZipFile(broken, "w") as target:
        description = source.read("modelDescription.xml")
        target.writestr("modelDescription.xml", description.replace(b'initial="calculated"', b'initial="exact"', 1))
    code, words = fmutool_check(broken)
    assert code != 0 and "ERROR" in words, words


def test_package_is_complete(packed):
    with zipfile.ZipFile(packed) as archive:
        names = set(archive.namelist())
        description = archive.read("modelDescription.xml")
    presets = {f"resources/{path.name}" for path in (ROOT / "resources").glob("*.json")}
    texts = [*ROOT.glob("LICENSE*"), *ROOT.glob("docs/LICENSE*"), ROOT / "docs" / "license.txt"]
    licences = {f"documentation/licenses/{path.name}" for path in texts}
    pages = [path.stem.replace("README", "index") for path in (ROOT / "docs" / "theory").glob("*.md")]
    theory = {f"documentation/theory/{page}.html" for page in pages}
    expected = {"binaries/linux64/wheelrail.so", "documentation/index.html", "model.png"} | presets | licences | theory
    assert len(licences) == 4 and expected <= names
    assert description == (ROOT / "modelDescription.xml").read_bytes()
    assert packed.stat().st_size < LARGEST


def test_documentation_has_figure_theory_references_and_every_variable(fmu, packed):
    with zipfile.ZipFile(packed) as archive:
        page = archive.read("documentation/index.html").decode()
        linked = set(re.findall(r'href="(theory/[^"]+)"', page))
        assert {f"documentation/{name}" for name in linked} <= set(archive.namelist()) and len(linked) > 5
    assert etree.HTML(page) is not None and not re.search(r"\{[a-z]+\}", page)
    for section in ("signs", "model", "theory", "use", "masters", "limits", "references", "licence", "variables"):
        assert f'<h2 id="{section}">' in page and f'href="#{section}"' in page, section
    assert "<svg" in page and "Chalmers" in page and "Permission is hereby granted" in page and "Apache License" in page
    for variable in fmu.description.modelVariables:
        name = variable.name.replace("[1]", "[1 … 61]")
        assert f"<code>{name}</code>" in page or "[" in name, name


def test_generation_tool_has_a_semantic_version(fmu):
    assert re.fullmatch(r"wheelrail \d+\.\d+\.\d+(-[0-9A-Za-z.-]+)?", fmu.description.generationTool)


def test_readme_snippet_simulates(packed):
    start = {"initial.velocity": 20.0, "drive.moment": -5000.0}
    outputs = ["wheel.velocity", "contact.creepage"]
    result = simulate_fmu(str(packed), stop_time=0.5, output_interval=1e-3, start_values=start, output=outputs)
    assert len(result) == 501
    assert result["wheel.velocity"][-1] < 19.8
    assert 1e-4 < result["contact.creepage"][-1] < 1e-2
