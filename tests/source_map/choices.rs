//! Code that answers for some items of a choice and lets the others pass unseen: comparisons, `matches!`, `if let`, and
//! arms for all the rest.

use super::text::{closing, is_word, without_comments, without_strings, without_tests};

/// Paths `Name::Item` of all items of the choices that a file defines with `choice!`.
pub fn items(text: &str) -> Vec<String> {
    let code = without_tests(&without_comments(text));
    let mut found = Vec::new();
    for (at, _) in code.match_indices("choice! {") {
        let block = &code[at..closing(&code, at + "choice! ".len())];
        let Some((_, rest)) = block.split_once("pub enum ") else { continue };
        let name: String = rest.chars().take_while(|c| is_word(*c)).collect();
        let is_item = |word: &&str| !word.is_empty() && word.chars().all(is_word);
        let rows = rest.lines().filter_map(|line| line.split_once(" = ")).map(|(word, _)| word.trim());
        found.extend(rows.filter(is_item).map(|item| format!("{name}::{item}")));
    }
    found
}

/// Use of the items in code instead of a complete match: one text for each place.
pub fn shortcuts(text: &str, items: &[String]) -> Vec<String> {
    let code = without_tests(&without_strings(&without_comments(text)));
    let mut found = Vec::new();
    for item in items {
        for (at, _) in code.match_indices(item.as_str()) {
            let (before, after) = (&code[..at], &code[at + item.len()..]);
            if before.chars().next_back().is_some_and(is_word) || after.starts_with(is_word) {
                continue;
            }
            let before = before.trim_end_matches(|c: char| is_word(c) || c == ':' || c == '*' || c == '&').trim_end();
            let after = after.trim_start();
            if [before.ends_with("=="), before.ends_with("!=")].contains(&true)
                || after.starts_with("==")
                || after.starts_with("!=")
            {
                found.push(format!("compares with {item}"));
            }
            let line = before.rsplit([';', '{', '}']).next().unwrap_or_default();
            if line.contains("matches!(") || line.trim_start().starts_with("if let") || line.contains(" if let ") {
                found.push(format!("asks for {item} alone"));
            }
        }
    }
    for (at, _) in code.match_indices("match ").filter(|(at, _)| !code[..*at].ends_with(is_word)) {
        let Some(open) = code[at..].find('{') else { continue };
        let body = &code[at + open + 1..closing(&code, at + open) - 1];
        let patterns = patterns(body);
        let named = patterns.iter().find_map(|pattern| items.iter().find(|item| names(pattern, item)));
        let rest = |pattern: &String| pattern == "_" || pattern.chars().all(|c| is_word(c) && !c.is_uppercase());
        if let (Some(item), Some(rest)) = (named, patterns.iter().find(|pattern| rest(pattern))) {
            found.push(format!("matches {item} and all others as {rest}"));
        }
    }
    found
}

/// A pattern names an item, possibly behind the path of its module.
fn names(pattern: &str, item: &str) -> bool {
    let words = pattern.split(|c: char| !is_word(c) && c != ':');
    words.into_iter().any(|word| word == item || word.ends_with(&format!("::{item}")))
}

/// Patterns of the arms in the body of a match.
fn patterns(body: &str) -> Vec<String> {
    let (mut found, mut rest) = (Vec::new(), body);
    while let Some((pattern, arm)) = rest.split_once("=>") {
        found.push(pattern.trim().trim_start_matches(',').trim().to_owned());
        let arm = arm.trim_start();
        if arm.starts_with('{') {
            rest = &arm[closing(arm, 0)..];
            continue;
        }
        // An expression ends at a comma outside brackets.
        let mut depth = 0;
        let end = arm.char_indices().find(|(_, c)| {
            depth += i32::from("([{".contains(*c)) - i32::from(")]}".contains(*c));
            depth == 0 && *c == ','
        });
        rest = end.map_or("", |(at, _)| &arm[at + 1..]);
    }
    found
}
