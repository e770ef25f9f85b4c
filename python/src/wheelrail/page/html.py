"""The page itself: text, tables, packed data and the drawing library in one file that asks no network for anything."""

import base64
import gzip
import importlib.util
import json
from html import escape
from importlib import resources
from pathlib import Path

from ..files import BadFile

# The browser itself refuses whatever is not in the page.
POLICY = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; font-src data:"
DRAWING = "package_data/plotly.min.js"


def drawable():
    """Where plotly.js is in the Python package plotly, which itself is not imported; None if it is not installed."""
    found = importlib.util.find_spec("plotly")
    script = Path(found.submodule_search_locations[0], DRAWING) if found and found.submodule_search_locations else None
    return script if script and script.is_file() else None


def library():
    """plotly.js."""
    script = drawable()
    if script is None:
        raise BadFile("the page is drawn by plotly, which is not installed: pip install 'wheelrail[report]'")
    return script.read_bytes()


def packed(content):
    """Bytes as text for a page: gzip, which the browser unpacks, in base64."""
    return base64.b64encode(gzip.compress(content, 9, mtime=0)).decode()


def own(name):
    """A file beside this module."""
    return resources.files(__package__).joinpath(name).read_text(encoding="utf-8")


def document(title, body, data):
    """The whole page: `body` in HTML, `data` for page.js."""
    figures = json.dumps(data, separators=(",", ":"), allow_nan=False).encode()
    return "\n".join((
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">',
        f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n<meta name="color-scheme" content="light dark">',
        f'<title>{escape(title)}</title>\n<link rel="icon" href="data:,">',
        f"<style>\n{own('page.css')}</style>\n</head>\n<body>\n{body}",
        f'<script type="application/gzip" id="library">{packed(library())}</script>',
        f'<script type="application/gzip" id="data">{packed(figures)}</script>',
        f"<script>\n{own('page.js')}\n{own('film.js')}</script>\n</body>\n</html>\n",
    ))  # fmt: skip


def head(title, subtitle, tiles):
    """Heading with key figures: label and value."""
    cells = "".join(f"<div><dt>{escape(label)}</dt><dd>{escape(value)}</dd></div>" for label, value in tiles)
    return f'<header>\n<h1>{escape(title)}</h1>\n<p class="sub">{escape(subtitle)}</p>\n<dl class="tiles">{cells}</dl>\n</header>'


def section(key, title, content, note="", folded=False):
    """A section with a heading, at whose click a `folded` one opens."""
    words, head = f'<p class="note">{escape(note)}</p>' if note else "", f"<h2>{escape(title)}</h2>"
    if not folded:
        return f'<section id="{key}">\n{head}\n{words}{content}\n</section>'
    inside = f'{words}<div class="inside">{content}</div>'
    return f'<section id="{key}" class="folded">\n<details><summary>{head}</summary>\n{inside}\n</details>\n</section>'


def table(rows, kind="", header=True):
    """A table of texts; the first row is the head."""
    row = lambda cells, tag: "<tr>" + "".join(f"<{tag}>{escape(str(cell))}</{tag}>" for cell in cells) + "</tr>"
    top, rest = (f"<thead>{row(rows[0], 'th')}</thead>", rows[1:]) if header else ("", rows)
    body = "".join(row(cells, "td") for cells in rest)
    return f'<div class="scroll"><table class="{kind}">{top}<tbody>{body}</tbody></table></div>'


def notice(lines):
    """A box of warnings."""
    return '<ul class="warnings">' + "".join(f"<li>{escape(line)}</li>" for line in lines) + "</ul>"


FILM = """<div class="film">
<div class="readings" aria-live="off"></div>
<div id="film" class="plot tall"></div>
</div>"""
MAP = """<div class="map">
<label>shown <select id="quantity"></select></label>
<div id="map" class="plot tall"></div>
</div>"""
READINGS = '<div class="readings" aria-live="off"></div>'
ABOVE = '<label class="seen">shown <select id="seen"></select></label><div id="above" class="plot"></div>'
BAR = """<div id="bar" role="group" aria-label="time of the film">
<button id="play" type="button" aria-pressed="false">▶ play</button>
<input id="slider" type="range" min="0" value="0" step="1" aria-label="time of the film">
<output id="clock" for="slider"></output>
<select id="pace" aria-label="pace">
<option value="30">slow</option><option value="12" selected>normal</option><option value="5">fast</option>
</select>
<label class="follow"><input id="follow" type="checkbox"> fit axes</label>
</div>"""
EMPTY = (
    '<noscript><p class="note">Figures need JavaScript; tables do not.</p></noscript><p id="trouble" class="warnings" hidden></p>'
)


def charts(key="charts"):
    """The place of curves."""
    return f'<div id="{key}" class="charts"></div>'


def choices(names):
    """Buttons that choose one of several stops."""
    buttons = "".join(
        f'<label><input type="radio" name="view" value="{escape(name)}"{" checked" if k == 1 else ""}> {escape(name)}</label>'
        for k, name in enumerate(names)
    )
    return f'<fieldset class="views"><legend>curves of</legend>{buttons}</fieldset>'
