//! The text of a source file: comments, strings, unit tests, imports, paths, functions.

use std::collections::BTreeSet;

/// One imported name with the path it stands for; without a name: everything at that path.
pub struct Import {
    pub name: Option<String>,
    pub path: Vec<String>,
}

pub fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Blanks out everything that `end` finds the length of; line breaks stay.
fn blank(text: &str, length: impl Fn(&str, Option<char>) -> usize) -> String {
    let (mut out, mut rest, mut before) = (String::with_capacity(text.len()), text, None);
    while let Some(c) = rest.chars().next() {
        let skip = length(rest, before);
        if skip == 0 {
            out.push(c);
            (rest, before) = (&rest[c.len_utf8()..], Some(c));
        } else {
            out.extend(rest[..skip].chars().map(|c| if c == '\n' { c } else { ' ' }));
            (rest, before) = (&rest[skip..], Some(' '));
        }
    }
    out
}

/// Length of the string or character literal at the beginning of a text, 0 if there is none.
fn literal(text: &str, before: Option<char>) -> usize {
    let raw = text.strip_prefix('r').filter(|_| !before.is_some_and(is_word));
    if let Some(hashes) = raw.map(|t| t.chars().take_while(|c| *c == '#').count())
        && text[1 + hashes..].starts_with('"')
    {
        let end = format!("\"{}", "#".repeat(hashes));
        let start = 2 + hashes;
        return text[start..].find(&end).map_or(text.len(), |at| start + at + end.len());
    }
    let quoted = |quote: char| {
        let mut escaped = false;
        let end = text[1..].char_indices().find(|(_, c)| {
            let ends = *c == quote && !escaped;
            escaped = *c == '\\' && !escaped;
            ends
        });
        end.map_or(text.len(), |(at, _)| at + 2)
    };
    match text.chars().next() {
        Some('"') => quoted('"'),
        // A quote that is no character begins a lifetime.
        Some('\'') if text[1..].starts_with('\\') || text.chars().nth(2) == Some('\'') => quoted('\''),
        _ => 0,
    }
}

/// Length of the comment at the beginning of a text, 0 if there is none.
fn comment(text: &str) -> usize {
    if text.starts_with("//") {
        text.find('\n').unwrap_or(text.len())
    } else if text.starts_with("/*") {
        text.find("*/").map_or(text.len(), |at| at + 2)
    } else {
        0
    }
}

/// Code with its comments blanked out; line breaks stay.
pub fn without_comments(text: &str) -> String {
    let (mut out, mut rest, mut before) = (String::with_capacity(text.len()), text, None);
    while let Some(c) = rest.chars().next() {
        let (skip, keep) = (comment(rest), literal(rest, before));
        let length = if skip > 0 { skip } else { keep.max(c.len_utf8()) };
        if skip == 0 {
            out.push_str(&rest[..length]);
        }
        before = rest[..length].chars().next_back();
        rest = &rest[length..];
    }
    out
}

/// Code without comments with its strings and characters blanked out; line breaks stay.
pub fn without_strings(code: &str) -> String {
    blank(code, literal)
}

/// Position behind the brace that closes the one at `open`.
pub fn closing(code: &str, open: usize) -> usize {
    let mut depth = 0;
    let end = code[open..].char_indices().find(|(_, c)| {
        depth += i32::from(*c == '{') - i32::from(*c == '}');
        depth == 0
    });
    end.map_or(code.len(), |(at, _)| open + at + 1)
}

/// Length of the item at the beginning of code without strings that is only compiled for tests, 0 if there is none.
fn test_item(code: &str) -> usize {
    if code.starts_with("#[cfg(test)]") { item(code) } else { 0 }
}

/// Length of an item up to the end of its body or its semicolon.
fn item(code: &str) -> usize {
    match code.find(['{', ';']) {
        Some(at) if code[at..].starts_with('{') => closing(code, at),
        Some(at) => at + 1,
        None => code.len(),
    }
}

/// Code without strings, with items that are only compiled for tests blanked out.
pub fn without_tests(code: &str) -> String {
    blank(code, |rest, _| test_item(rest))
}

/// Number of lines of the items that are only compiled for tests.
pub fn lines_of_tests(code: &str) -> usize {
    let (mut lines, mut rest) = (0, code);
    while let Some(at) = rest.find("#[cfg(test)]") {
        rest = &rest[at..];
        let length = test_item(rest);
        lines += rest[..length].lines().count();
        rest = &rest[length..];
    }
    lines
}

/// Names of the types that code without strings and comments defines, those within traits and implementations left out.
pub fn types(code: &str) -> Vec<String> {
    let (mut found, mut rest, mut before) = (Vec::new(), code, ";");
    let first_word = |text: &str| text.chars().take_while(|c| is_word(*c)).collect::<String>();
    while let Some(c) = rest.chars().next() {
        let word = first_word(rest);
        let named = matches!(word.as_str(), "struct" | "enum" | "union" | "trait" | "type");
        let name = first_word(rest[word.len()..].trim_start());
        let implementation = word == "impl" && ["{", "}", ";", "]", "unsafe"].contains(&before);
        let length = match word.as_str() {
            "" => c.len_utf8(),
            "trait" => item(rest),
            _ if implementation => item(rest),
            _ => word.len(),
        };
        if named && !name.is_empty() {
            found.push(name);
        }
        before = match c {
            _ if length > word.len().max(c.len_utf8()) => "}",
            _ if c.is_whitespace() => before,
            _ => &rest[..length],
        };
        rest = &rest[length..];
    }
    found
}

/// Statements that begin with a keyword, from behind it to the semicolon.
fn statements<'a>(code: &'a str, keyword: &str) -> Vec<(usize, &'a str)> {
    let starts = code.match_indices(keyword).filter(|(at, _)| !code[..*at].chars().next_back().is_some_and(is_word));
    let body = |at: usize| code[at + keyword.len()..].split(';').next().map(|text| (at, text));
    starts.filter_map(|(at, _)| body(at)).collect()
}

/// Names of the modules in files of their own that a module declares.
pub fn modules(code: &str) -> BTreeSet<String> {
    let named = |text: &&str| text.chars().all(is_word);
    statements(code, "mod ").into_iter().map(|(_, text)| text).filter(named).map(str::to_owned).collect()
}

/// Names that `use` binds in a module.
pub fn imports(code: &str) -> Vec<Import> {
    let mut found = Vec::new();
    statements(code, "use ").iter().for_each(|(_, tree)| expand(&[], tree.trim(), &mut found));
    found
}

/// Takes the tree of a `use` apart.
fn expand(prefix: &[String], tree: &str, found: &mut Vec<Import>) {
    let words =
        |text: &str| text.split("::").map(|w| w.trim().to_owned()).filter(|w| !w.is_empty()).collect::<Vec<_>>();
    if let Some(open) = tree.find('{') {
        let prefix = [prefix, &words(&tree[..open])].concat();
        let inner = &tree[open + 1..closing(tree, open) - 1];
        let mut depth = 0;
        let parts = inner.split(|c| {
            depth += i32::from(c == '{') - i32::from(c == '}');
            c == ',' && depth == 0
        });
        parts.map(str::trim).filter(|part| !part.is_empty()).for_each(|part| expand(&prefix, part, found));
        return;
    }
    let (path, name) =
        tree.split_once(" as ").map_or((tree, None), |(path, name)| (path, Some(name.trim().to_owned())));
    let mut path = [prefix, &words(path)].concat();
    match path.last().map(String::as_str) {
        Some("*") => {
            path.pop();
            found.push(Import { name: None, path });
        }
        Some("self") => {
            path.pop();
            found.push(Import { name: name.or(path.last().cloned()), path });
        }
        _ => found.push(Import { name: name.or(path.last().cloned()), path }),
    }
}

/// Code with its `use` statements blanked out.
pub fn without_imports(code: &str) -> String {
    let mut out = code.to_owned();
    for (at, text) in statements(code, "use ") {
        let range = at..at + "use ".len() + text.len();
        out.replace_range(range.clone(), &" ".repeat(range.len()));
    }
    out
}

/// All paths of more than one name in code without strings and imports.
pub fn paths(code: &str) -> BTreeSet<Vec<String>> {
    let compact: String =
        code.split_whitespace().collect::<Vec<_>>().join(" ").replace(" ::", "::").replace(":: ", "::");
    let words = compact.split(|c| !is_word(c) && c != ':').map(|path| path.trim_matches(':'));
    let split = |path: &str| path.split("::").map(str::to_owned).collect::<Vec<_>>();
    words.filter(|path| path.contains("::")).map(split).collect()
}

/// Name and number of lines of every function with a body, in code without comments and strings.
pub fn functions(code: &str) -> Vec<(String, usize)> {
    let mut found = Vec::new();
    for (at, _) in code.match_indices("fn ").filter(|(at, _)| !code[..*at].chars().next_back().is_some_and(is_word)) {
        let name: String = code[at + 3..].chars().take_while(|c| is_word(*c)).collect();
        let mut depth = 0;
        // A semicolon outside brackets ends a function without a body.
        let end = code[at..].char_indices().find(|(_, c)| {
            depth += i32::from("([".contains(*c)) - i32::from(")]".contains(*c));
            depth == 0 && (*c == '{' || *c == ';')
        });
        let Some((open, '{')) = end else { continue };
        if !name.is_empty() {
            found.push((name, code[at..closing(code, at + open)].lines().count()));
        }
    }
    found
}
