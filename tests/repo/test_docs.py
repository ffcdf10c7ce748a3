"""README and docs/: every link leads somewhere, every page is in the list of pages and in the site, which needs no network."""

import csv
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from harness import PROGRAMS, ROOT

PAGES = [ROOT / f"{name}.md" for name in ("README", "CONTRIBUTING", "CHANGELOG")] + sorted(ROOT.glob("docs/**/*.md"))
CHROMIUM = shutil.which("chromium-headless-shell") or shutil.which("chromium")
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")


def prose(text: str) -> str:
    """Return a page without its equations, its blocks of code and its spans of code."""
    text = re.sub(r"^\$\$$.*?^\$\$$|\$[^$\n]+\$", "", text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"(?<=\n\n)(?:(?: {4}|\t).*\n|\n(?= {4}))+", "", text)
    return re.sub(r"`[^`\n]*\n?[^`\n]*`", " ", text)


def anchors(text: str) -> set[str]:
    """Return the anchors of a page's headings, as MkDocs and GitHub make them."""
    heads = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    return {re.sub(r"[\s]+", "-", re.sub(r"[^\w\s-]", "", head.lower()).strip()) for head in heads}


def broken(page: Path, text: str) -> list[str]:
    """Return a line for each link of a page that leads nowhere; those to other hosts are not followed."""
    wrong = []
    for link in LINK.findall(prose(text)):
        target, _, anchor = link.partition("#")
        if re.match(r"[a-z]+:", link):
            continue
        path = page.parent / target if target else page
        if not path.is_file():
            wrong.append(f"{page.name}: {link}: no such file")
        elif anchor and anchor not in anchors(path.read_text()):
            wrong.append(f"{page.name}: {link}: no such heading")
    return wrong


def test_links_lead_somewhere():
    assert sum(len(LINK.findall(prose(page.read_text()))) for page in PAGES) > 100, "links were found"
    assert not [line for page in PAGES for line in broken(page, page.read_text())]


def test_a_broken_link_is_found():
    page = ROOT / "docs" / "pages.md"
    text = "[a](options.md) [b](nowhere.md) [c](options.md#units) [d](options.md#none) `[e](code.md)`\n"
    assert broken(page, text) == ["pages.md: nowhere.md: no such file", "pages.md: options.md#none: no such heading"]


def has_heading(page: str, words: str) -> bool:
    """Return whether a page has a heading that the words begin with, or that begins with the words."""
    heads = re.findall(r"^#+ (.*)$", (ROOT / page).read_text(), re.MULTILINE)
    return any(head.startswith(words) or words.startswith(head) for head in heads)


def test_pages_that_the_source_names_are_there():
    """A comment's docs/nearfield.md, Box part is a page and a heading that begins so."""
    files = [path for folder in ("src", "include", "python", "tests", "runs") for path in (ROOT / folder).rglob("*.*")]
    text = "\n".join(path.read_text() for path in files if path.suffix in (".c", ".h", ".py", ".opts", ".sh"))
    named = set(re.findall(r"\bdocs/\w+(?:/\w+)?\.(?:md|csv|json|ipynb)\b", text))
    assert len(named) > 10 and not [name for name in named if not (ROOT / name).is_file()]
    text = re.sub(r"\n[ *#]*", " ", text)
    headings = re.findall(r"\b(docs/\w+\.md), \"?([A-Z][\w ]+)", text)
    assert len(headings) > 30 and not [found for found in headings if not has_heading(*found)]


def test_every_page_is_in_the_list_and_in_the_site():
    listed, site = (ROOT / "docs" / "pages.md").read_text(), (ROOT / "mkdocs.yml").read_text()
    pages = {page.name for page in ROOT.glob("docs/*.md")}
    assert pages - {"pages.md"} == set(re.findall(r"\((\w+\.md)\)", listed)), "docs/pages.md"
    assert pages == set(re.findall(r" ([a-z]\w+\.md)$", site, re.MULTILINE)) - {"index.md"}, "mkdocs.yml"
    assert len((ROOT / "README.md").read_text().splitlines()) <= 200


LOADED = r"<(?:script|img|iframe)[^>]* src=\"?(?:https?:)?//|<link[^>]* href=\"?(?:https?:)?//"


def in_browser(address: str) -> str:
    """Return what a browser without network makes of a page."""
    words = ["--no-sandbox", "--virtual-time-budget=10000", "--host-resolver-rules=MAP * 0.0.0.0", "--dump-dom"]
    return subprocess.run([CHROMIUM, *words, address], capture_output=True, text=True, timeout=60).stdout


@pytest.mark.skipif(not (PROGRAMS.parent / "site-tools" / "mkdocs").is_dir(), reason="PyPI's MkDocs is not there")
def test_site_is_whole_and_needs_no_network():
    """README with its pictures, notebooks, tables, docstrings; in a browser equations and the search, from files."""
    done = subprocess.run(["make", "-C", ROOT, "docs", f"BUILD={PROGRAMS.parent}"], capture_output=True, text=True)
    assert done.returncode == 0 and "WARNING" not in done.stderr, done.stdout + done.stderr
    site = ROOT / "build" / "docs"
    home, tour, reference = ((site / f"{name}.html").read_text() for name in ("index", "tutorial", "api"))
    assert "Three numbers that describe a vesicle" in home and 'src="shear.png"' in home and '="docs/' not in home
    assert (site / "shear.png").is_file() and 'href="CONTRIBUTING.html"' in home
    assert "finished at t = 6" in tour and '<img alt="' in tour
    assert 'id="petves.Simulation.run"' in reference and 'id="petves.plot"' in reference
    assert (site / "errors.html").read_text().count("<tr>") > 100
    assert not [page.name for page in site.rglob("*.html") if re.search(LOADED, page.read_text())]
    if CHROMIUM:
        equations = in_browser(f"file://{site}/method.html")
        assert 'class="katex-display"' in equations and "katex-error" not in equations
        assert "matching documents" in in_browser(f"file://{site}/index.html?q=tension")


def test_tables_stand_in_the_pages_that_are_made(tmp_path):
    """A link to a CSV file alone in its line becomes a table: rows are those of the file, options are code."""
    command = [sys.executable, ROOT / "python" / "page_tables.py", ROOT / "docs", tmp_path]
    assert subprocess.run(command, check=False).returncode == 0
    with (ROOT / "tests" / "repo" / "messages" / "words.csv").open(newline="") as file:
        first = list(csv.reader(file))[1]
    made = (tmp_path / "errors.md").read_text()
    assert f"| `{first[0]}` | {first[1]} | {first[2]} |\n" in made and ".csv)" not in made
    assert len({page.name for page in tmp_path.glob("*.md")}) == len(list(ROOT.glob("docs/*.md")))
    made = sorted(tmp_path.rglob("*.md"))
    assert not [line for page in made for line in broken(page, page.read_text()) if "../" not in line], "with pictures"
    assert (tmp_path / "reproduction" / "tables.md").is_file() and len(list(tmp_path.glob("*/*.png"))) > 30


def unknown(text: str) -> set[str]:
    """Return the words of a page that neither the speller's British dictionary nor tests/repo/words.txt has."""
    text = re.sub(r"\]\([^)]*\)|<!--.*?-->", " ", prose(text), flags=re.DOTALL)
    text = re.sub(r"\S*[_/^\\=\d]\S*|\b\w+\.[a-z]{1,5}\b", " ", text)  # names of files and options, formulas
    words = ["aspell", "list", "--lang=en_GB", "--encoding=utf-8"]
    found = subprocess.run(words, input=text, capture_output=True, text=True, check=True).stdout.split()
    known = (ROOT / "tests" / "repo" / "words.txt").read_text().split()
    return {word.removesuffix("'s") for word in found} - set(known)


@pytest.mark.skipif(not shutil.which("aspell"), reason="aspell is not installed")
def test_words_are_spelt_well():
    assert not {page.name: words for page in PAGES if (words := unknown(page.read_text()))}
    assert unknown("The velosity of the membrane `velosity`, at runs/velosity.opts") == {"velosity"}


@pytest.mark.skipif(not shutil.which("codespell"), reason="codespell is not installed")
def test_code_is_spelt_well():
    """Frequent misspellings, in comments and names too; nd is an ordering, tread what a tank has."""
    folders = ["src", "include", "python", "studies", "tests", "bench", "runs", "docs", "README.md", "Makefile"]
    skipped = "*.ipynb,*.json,*.csv,*.png,words.txt,test_docs.py,*.pyc"
    words = ["codespell", "-L", "nd,tread", "-S", skipped, *folders]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
