"""What MkDocs builds the site from: the repository's own files under their own paths, a page for each module of the Python package, and
Rust's documentation below rust/."""

import re
import shutil
from pathlib import Path

import api
import mathematics
from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File

ROOT = Path(__file__).resolve().parent.parent
# Pages, pictures, and what pages link to.
SHOWN = (
    "*.md", "LICENSE-*", "CITATION.cff", "docs/*.md", "docs/*/*.md", "docs/*.png", "docs/*.svg", "docs/LICENSE-THIRD-PARTY",
    "python/README.md", "examples/*.py", "examples/*.ipynb", "examples/train/*.json", "examples/train/*.csv",
    "examples/train/schema/*.json", "packaging/build", "packaging/*.py", "packaging/*.c", ".github/workflows/*.yml",
)  # fmt: skip
RUST = ROOT / "target" / "doc"
BENCH = ROOT / "target" / "bench"
API = "python-api"


def shown():
    """Paths below the root of the repository of everything that is on the site."""
    return sorted({path.relative_to(ROOT).as_posix() for pattern in SHOWN for path in ROOT.glob(pattern)})


def on_config(config):
    """Adds the modules of the Python package to the navigation."""
    reference = next(section["Reference"] for section in config.nav if "Reference" in section)
    place = next(k for k, entry in enumerate(reference) if f"{API}.md" in entry.values())
    pages = [{name.removeprefix("wheelrail."): f"{API}/{name}.md"} for name in api.modules()]
    reference[place] = {"Python": [f"{API}.md", *pages]}
    return config


def on_files(files, config):
    """Adds the files of the repository, of rustdoc and, where it has been made, of the bench, and a page for each Python module."""
    for name in api.modules():
        files.append(File.generated(config, f"{API}/{name}.md", content=f"::: {name}\n    options: {{heading_level: 1}}\n"))
    if not (RUST / "wheelrail" / "index.html").is_file():
        raise PluginError(f"{RUST}/wheelrail/index.html does not exist: run `make docs`")
    for path in shown():
        files.append(File.generated(config, path.removeprefix("."), abs_src_path=str(ROOT / path)))
    for index in RUST.glob("*/index.html"):
        files.append(File.generated(config, f"rust/{index.relative_to(RUST).as_posix()}", abs_src_path=str(index)))
    for path in BENCH.rglob("*") if BENCH.is_dir() else ():
        if path.is_file():
            files.append(File.generated(config, f"bench/{path.relative_to(BENCH).as_posix()}", abs_src_path=str(path)))
    return files


def on_page_markdown(markdown, page, config, files):
    """Formulas of the theory are blocks of text on the forge."""
    markdown = markdown.replace("](../.github/", "](../github/")  # a name that begins with a dot is no part of a site
    if page.file.src_uri == "docs/bench.md" and BENCH.is_dir():
        markdown = markdown.replace("`bench/index.html`", "[bench/index.html](../bench/index.html)")
    if page.file.src_uri == f"{API}.md":
        names = "".join(f"| [`{name}`][{place}] | {text} |\n" for name, place, text in api.exported())
        rooms = "".join(f"| [`{name}`]({API}/{name}.md) | {text} |\n" for name, text in api.modules().items())
        markdown += f"\n## What `import wheelrail` gives\n\n| name | |\n|---|---|\n{names}\n## Modules\n\n| module | |\n|---|---|\n{rooms}"
    if page.file.src_uri.startswith("docs/theory/"):
        markdown = re.sub(r"^( *)```text$", r"\1```mathematics", markdown, flags=re.MULTILINE)
    return markdown


def on_page_content(html, page, config, files):
    """Symbols within the text of the theory."""
    return mathematics.symbols(html) if page.file.src_uri.startswith("docs/theory/") else html


def on_post_build(config):
    """All of rustdoc, to whose front pages the site links."""
    shutil.copytree(RUST, Path(config.site_dir) / "rust", dirs_exist_ok=True, ignore=shutil.ignore_patterns(".lock"))
