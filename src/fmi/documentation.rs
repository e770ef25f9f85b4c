//! `documentation/index.html` of the FMU: conventions with a figure, use, the table of variables, and links to all
//! [`pages`](super::pages).

use super::pages::{Page, escaped, pages};
use super::presets;
use super::reference::{self, Cells};
use super::table::{enumerations, table};
use super::v2::description;
use super::variable::{Causality, Variable};
use std::fmt::Write;

/// Text before the tables.
const INTRODUCTION: &str = include_str!("../../docs/fmu.html");

/// Figure of the sign conventions; README links it, too.
const SIGNS: &str = include_str!("../../docs/signs.svg");

/// The page as it stands in the FMU.
pub fn index_html() -> String {
    let mut html = INTRODUCTION
        .replace("{version}", env!("CARGO_PKG_VERSION"))
        .replace("{guid}", &description::guid())
        .replace("{signs}", SIGNS)
        .replace("{preset}", presets::DEFAULT)
        .replace("{theory}", &links(Page::is_theory))
        .replace("{guides}", &links(|page| !page.is_theory()))
        .replace("{mit}", &escaped(include_str!("../../LICENSE-MIT")))
        .replace("{apache}", &escaped(include_str!("../../LICENSE-APACHE")));
    for (title, causality) in
        [("Inputs", Causality::Input), ("Outputs", Causality::Output), ("Parameters", Causality::Parameter)]
    {
        let _ = write!(
            html,
            "<h3>{title}</h3>\n<div class=\"wide\"><table>\n<tr><th>name</th><th>reference</th><th>unit</th>"
        );
        let _ = writeln!(html, "<th>range</th><th>default</th><th>meaning</th></tr>");
        table().iter().filter(|v| v.causality() == causality).for_each(|variable| row(&mut html, variable));
        html.push_str("</table></div>\n");
    }
    html.push_str(
        "<h3>Enumerations</h3>\n<table>\n<tr><th>type</th><th>value</th><th>item</th><th>meaning</th></tr>\n",
    );
    for list in enumerations() {
        for (value, (item, text)) in (1..).zip(list.items) {
            let value: i32 = value;
            let _ = writeln!(html, "<tr><td>{}</td><td>{value}</td><td>{item}</td><td>{text}</td></tr>", list.name);
        }
    }
    html.push_str("</table>\n</body>\n</html>\n");
    html
}

fn row(html: &mut String, variable: &Variable) {
    let Cells { name, reference, unit, range, start, text, .. } = reference::cells(variable);
    let text = escaped(&text);
    let _ = writeln!(
        html,
        "<tr><td><code>{name}</code></td><td>{reference}</td><td>{unit}</td><td>{range}</td><td>{start}</td><td>{text}</td></tr>"
    );
}

/// A list of links to some of the pages.
fn links(wanted: impl Fn(&Page) -> bool) -> String {
    let item = |page: Page| format!("<li><a href=\"{}\">{}</a></li>\n", page.file(), escaped(&page.title()));
    format!("<ul>\n{}</ul>", pages().filter(wanted).map(item).collect::<String>())
}
