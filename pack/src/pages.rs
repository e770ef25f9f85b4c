//! Pages of the documentation: the Markdown of `docs` as HTML that needs no network. Mathematics is written in the
//! characters of Unicode there, in code, and stays as it is.

use pulldown_cmark::{CowStr, Event, HeadingLevel, Options, Parser, Tag, TagEnd, html};

/// A page, by its path below `docs`.
pub struct Page {
    path: &'static str,
    text: &'static str,
}

/// Paths below `docs`, with what is there.
macro_rules! files {
    ($include:ident: $($path:literal),* $(,)?) => {
        [$(($path, $include!(concat!("../../docs/", $path)))),*]
    };
}

/// The pages, in the order in which they are read.
const PAGES: [(&str, &str); 29] = files![include_str:
    "profiles.md",
    "patches.md",
    "coupling.md",
    "your-controller-as-an-fmu.md",
    "what-the-next-wheel-meets.md",
    "versions.md",
    "theory/README.md",
    "theory/ale-balance.md",
    "theory/condensation.md",
    "theory/time-formula.md",
    "theory/track-support.md",
    "theory/sideways.md",
    "theory/rail-ends.md",
    "theory/damping.md",
    "theory/contact.md",
    "theory/elastic-layer.md",
    "theory/lever-arms.md",
    "theory/lines.md",
    "theory/profiles.md",
    "theory/heat.md",
    "theory/material-history.md",
    "theory/width-of-conduction.md",
    "theory/friction-and-coupling.md",
    "theory/limits-of-steel.md",
    "theory/wear.md",
    "theory/equivalent-width.md",
    "theory/structural-width.md",
    "validation.md",
    "speed.md",
];

/// Pictures on the pages, by their paths below `docs`, which they keep.
pub const PICTURES: [(&str, &[u8]); 7] = files![include_bytes:
    "flat.png", "hunting.png", "masters.png", "own_vehicle.png", "sideways.svg", "surfaces.png", "suspension.png"
];

/// All pages.
pub fn pages() -> impl Iterator<Item = Page> {
    PAGES.into_iter().map(|(path, text)| Page { path, text })
}

/// Path of the HTML file of a page; the same for links between pages. That of a `README` is the index of its folder.
fn html_path(path: &str) -> String {
    path.replace("README.md", "index.html").replace(".md", ".html")
}

/// The path below `docs` that a link on the page `from` means.
fn resolved(from: &str, link: &str) -> String {
    let mut parts: Vec<&str> = from.split('/').collect();
    parts.pop();
    for part in link.split('#').next().unwrap_or_default().split('/') {
        match part {
            ".." => drop(parts.pop()),
            part => parts.push(part),
        }
    }
    parts.join("/")
}

/// Plain text for HTML.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

impl Page {
    /// Path of its HTML file below `documentation`.
    pub fn file(&self) -> String {
        html_path(self.path)
    }

    /// Its heading, plain.
    pub fn title(&self) -> String {
        let heading = |event: &Event| matches!(event, Event::End(TagEnd::Heading(HeadingLevel::H1)));
        let text = |event| match event {
            Event::Text(text) | Event::Code(text) => Some(text.into_string()),
            _ => None,
        };
        Parser::new(self.text).take_while(|event| !heading(event)).filter_map(text).collect()
    }

    /// True if it is a chapter of the theory.
    pub fn is_theory(&self) -> bool {
        self.path.starts_with("theory/")
    }

    /// The page as HTML.
    pub fn html(&self) -> String {
        let up = "../".repeat(self.path.matches('/').count());
        let mut body = String::new();
        html::push_html(&mut body, self.events().into_iter());
        let title = escaped(&self.title());
        let neighbours = self.neighbours(&up);
        include_str!("../../docs/page.html")
            .replace("{title}", &title)
            .replace("{version}", env!("CARGO_PKG_VERSION"))
            .replace("{up}", &up)
            .replace("{neighbours}", &neighbours)
            .replace("{body}", &body)
    }

    /// Links to the pages before and after this one.
    fn neighbours(&self, up: &str) -> String {
        let all: Vec<Page> = pages().collect();
        let Some(place) = all.iter().position(|page| page.path == self.path) else { return String::new() };
        let link = |page: Option<&Page>, word: &str| {
            page.map(|page| format!(" · {word} <a href=\"{up}{}\">{}</a>", page.file(), escaped(&page.title())))
        };
        let before = place.checked_sub(1).and_then(|place| all.get(place));
        [link(before, "before:"), link(all.get(place + 1), "next:")].into_iter().flatten().collect()
    }

    /// The Markdown, with links to what is in the documentation, the others as plain text, wide tables that scroll, and without
    /// the marks by which figures are written (`tools/figures.py`).
    fn events(&self) -> Vec<Event<'static>> {
        let mut events = Vec::new();
        // Links and pictures that are open now, and whether they stay.
        let mut kept = Vec::new();
        for event in Parser::new_ext(self.text, Options::ENABLE_TABLES) {
            match event {
                Event::Start(Tag::Link { link_type, dest_url, title, id }) => {
                    let target = self.target(&dest_url);
                    kept.push(target.is_some());
                    events.extend(
                        target.map(|dest_url| Event::Start(Tag::Link { link_type, dest_url, title, id }.into_static())),
                    );
                }
                Event::Start(Tag::Image { link_type, dest_url, title, id }) => {
                    let shown = PICTURES.iter().any(|(path, _)| *path == resolved(self.path, &dest_url));
                    kept.push(shown);
                    let picture = Tag::Image { link_type, dest_url, title, id }.into_static();
                    events.extend(shown.then_some(Event::Start(picture)));
                }
                Event::End(end @ (TagEnd::Link | TagEnd::Image)) => {
                    events.extend(kept.pop().unwrap_or_default().then_some(Event::End(end)));
                }
                Event::Start(Tag::Table(alignments)) => {
                    events.push(Event::Html("<div class=\"wide\">\n".into()));
                    events.push(Event::Start(Tag::Table(alignments)));
                }
                Event::End(TagEnd::Table) => {
                    events.push(Event::End(TagEnd::Table));
                    events.push(Event::Html("</div>\n".into()));
                }
                Event::InlineHtml(mark) if mark.starts_with("<!--") => (),
                event => events.push(event.into_static()),
            }
        }
        events
    }

    /// Where a link leads in the documentation, or elsewhere; `None` for what is in neither.
    fn target(&self, link: &CowStr) -> Option<CowStr<'static>> {
        let known = PAGES.iter().any(|(path, _)| *path == resolved(self.path, link));
        let elsewhere = link.contains("://");
        (known || elsewhere).then(|| if elsewhere { link.to_string() } else { html_path(link) }.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn page(text: &'static str) -> String {
        let mut body = String::new();
        html::push_html(&mut body, Page { path: "theory/made-up.md", text }.events().into_iter());
        body
    }

    #[test]
    fn links_lead_to_pages_of_the_documentation_and_others_become_text() {
        let link = |target: &str| page(Box::leak(format!("[here]({target})").into_boxed_str()));
        assert_eq!(link("heat.md"), "<p><a href=\"heat.html\">here</a></p>\n");
        assert_eq!(link("heat.md#3-time"), "<p><a href=\"heat.html#3-time\">here</a></p>\n");
        assert_eq!(link("README.md"), "<p><a href=\"index.html\">here</a></p>\n");
        assert_eq!(link("../validation.md"), "<p><a href=\"../validation.html\">here</a></p>\n");
        assert_eq!(link("https://a.b/c.md"), "<p><a href=\"https://a.b/c.md\">here</a></p>\n");
        for elsewhere in ["../train.md", "../../README.md", "../../src/lib.rs", "nowhere.md"] {
            assert_eq!(link(elsewhere), "<p>here</p>\n", "{elsewhere}");
        }
        assert_eq!(page("![a flat](../flat.png)"), "<p><img src=\"../flat.png\" alt=\"a flat\" /></p>\n");
        assert_eq!(page("![a train](../train.png)"), "<p>a train</p>\n");
    }

    #[test]
    fn mathematics_stays_character_for_character_and_is_escaped() {
        let html = page("`|λ_t| ≤ μ λ_n`, *x* < 1\n\n```text\n∂_x u < −V²  [m]\n```\n");
        assert!(html.contains("<code>|λ_t| ≤ μ λ_n</code>") && html.contains("<em>x</em> &lt; 1"), "{html}");
        assert!(html.contains(">∂_x u &lt; −V²  [m]\n</code></pre>"), "{html}");
    }

    #[test]
    fn marks_of_figures_are_not_in_the_page() {
        let html = page("| a |\n|---|\n| within 0.1, 0.2 %<!--a.*:-.1%--> |\n\nit is\n3<!--b_c:.0f--> of them\n");
        assert!(html.contains("<td>within 0.1, 0.2 %</td>") && html.contains("<p>it is\n3 of them</p>"), "{html}");
    }

    #[test]
    fn tables_are_tables_that_scroll() {
        let html = page("| a | b |\n|---|---|\n| `1` | 2 |\n");
        assert!(html.contains("<div class=\"wide\">\n<table>") && html.contains("<td><code>1</code></td>"), "{html}");
    }
}
