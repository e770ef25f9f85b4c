//! `documentation/index.html` of the FMU: conventions with a figure, use, the table of variables, and links to all
//! [`pages`](super::pages).

use super::pages::{Page, escaped, pages};
use std::fmt::Write;
use wheelrail::config::retired::{RETIRED, Retired};
use wheelrail::fmi::interface::Interface;
use wheelrail::fmi::presets;
use wheelrail::fmi::reference::{self, Cells, RETIREMENT, SECTIONS};
use wheelrail::fmi::table::enumerations;
use wheelrail::fmi::variable::Variable;

/// Text before the tables.
const INTRODUCTION: &str = include_str!("../../docs/fmu.html");

/// Figure of the sign conventions; README links it, too.
const SIGNS: &str = include_str!("../../docs/signs.svg");

/// The page as it stands in the FMU.
pub fn index_html(interface: Interface) -> String {
    let mut html = INTRODUCTION
        .replace("{version}", env!("CARGO_PKG_VERSION"))
        .replace("{fmi}", interface.version())
        .replace("{identity}", &identity(interface))
        .replace("{signs}", SIGNS)
        .replace("{preset}", presets::DEFAULT)
        .replace("{theory}", &links(Page::is_theory))
        .replace("{guides}", &links(|page| !page.is_theory()))
        .replace("{mit}", &escaped(include_str!("../../LICENSE-MIT")))
        .replace("{apache}", &escaped(include_str!("../../LICENSE-APACHE")));
    for section in &SECTIONS {
        heading(&mut html, section.title, section.about, &["name", "reference", "unit", "range", "default", "meaning"]);
        section.rows().for_each(|variable| row(&mut html, variable));
        html.push_str("</table></div>\n");
    }
    heading(&mut html, "Enumerations", "", &["type", "value", "item", "meaning"]);
    for list in enumerations() {
        for (value, (item, text)) in (1..).zip(list.items) {
            let value: i32 = value;
            let _ = writeln!(html, "<tr><td>{}</td><td>{value}</td><td>{item}</td><td>{text}</td></tr>", list.name);
        }
    }
    html.push_str("</table></div>\n");
    heading(&mut html, "Retired parameters", RETIREMENT, &["name", "reference", "last in", "instead"]);
    for Retired { name, number, last, instead, .. } in RETIRED {
        let _ = writeln!(
            html,
            "<tr><td><code>{name}</code></td><td>{number}</td><td>{last}</td><td>{}</td></tr>",
            escaped(instead)
        );
    }
    html.push_str("</table></div>\n</body>\n</html>\n");
    html
}

/// Name and value of the identity of the description.
fn identity(interface: Interface) -> String {
    let name = match interface {
        Interface::Two(_) => "GUID",
        Interface::Three => "instantiation token",
    };
    format!("{name} <code>{}</code>", interface.identity())
}

/// Title of a table, a sentence about it, and its head.
fn heading(html: &mut String, title: &str, about: &str, columns: &[&str]) {
    let about = if about.is_empty() { String::new() } else { format!("<p>{about}</p>\n") };
    let columns: String = columns.iter().map(|column| format!("<th>{column}</th>")).collect();
    let _ = writeln!(html, "<h3>{title}</h3>\n{about}<div class=\"wide\"><table>\n<tr>{columns}</tr>");
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
